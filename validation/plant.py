"""Mistakes planted in a copy of the sources, each with a cache folder of its own: some case must see each of them.

A validation that passes says something only where it would fail if the package were wrong.
"""

import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import NamedTuple

from binaryast.errors import InputError, did_you_mean

ROOT = Path(__file__).parents[1]
SOURCE = ROOT / "src" / "binaryast"


class Mistake(NamedTuple):
    """What is planted: in which file, what stands there, once, and what stands there instead."""

    what: str
    file: str
    right: str
    wrong: str

    def plant(self, package: Path) -> None:
        """Plant it into a copy of the package."""
        path = package / self.file
        text = path.read_text(encoding="utf-8")
        if text.count(self.right) != 1:
            found = f"{self.right!r} stands {text.count(self.right)} times in {self.file}, expected once"
            raise InputError(f"{self.what}: {found}: bring MISTAKES up to the sources")
        path.write_text(text.replace(self.right, self.wrong), encoding="utf-8")


PRINTED = "kernels/discrete.py"
POTENTIALS = "kernels/mutual"
MISTAKES = {
    "none": None,  # the copy as it is must pass, or what follows would mean nothing
    "sign-of-M": Mistake(
        "sign of M, second degree",
        f"{POTENTIALS}/second_degree.py",
        "*gradient, -q * mx, -q * my, -q * mz",
        "*gradient, q * mx, q * my, q * mz",
    ),
    "sign-of-M-points": Mistake(
        "sign of M, point pairs",
        f"{POTENTIALS}/points.py",
        "return energy, gx, gy, gz, mx, my, mz",
        "return energy, gx, gy, gz, -mx, -my, -mz",
    ),
    "torque-twice": Mistake(
        "factor 2 in the torque on the secondary, production steps",
        "kernels/attraction.py",
        "(-n1, -n2, -n3)",
        "(-2.0 * n1, -2.0 * n2, -2.0 * n3)",
    ),
    "torque-twice-printed": Mistake(
        "factor 2 in the torque on the primary, (121) as printed",
        PRINTED,
        "h / 2 * np.cross(next_X, next_dU) + h / 2 * next_M)  # (121)",
        "h * np.cross(next_X, next_dU) + h * next_M)  # (121)",
    ),
    "R-for-R2-125": Mistake("R for R2 in (125)", PRINTED, "(R2 @ dU)  # (125)", "(R @ dU)  # (125)"),
    "R-for-R2-126": Mistake(
        "R for R2 in (126)", PRINTED, "(R2 @ dU) + h / 2 * (next_R2 @ next_dU)", "(R @ dU) + h / 2 * (next_R @ next_dU)"
    ),
    "F2-transposed-118": Mistake(
        "transposed F2 in (118)", PRINTED, "next_X = F2.T @ (X + h * Gamma", "next_X = F2 @ (X + h * Gamma"
    ),
    "wrong-G": Mistake("an older G", "constants.py", "G = 6.67430e-11", "G = 6.67408e-11"),
    "F-transposed": Mistake(
        "transposed F in the momenta's turn, production steps",
        "kernels/free_rotation.py",
        "2.0 * (d[0] - w * c[0]), 2.0 * (d[1] - w * c[1]), 2.0 * (d[2] - w * c[2])",
        "2.0 * (d[0] + w * c[0]), 2.0 * (d[1] + w * c[1]), 2.0 * (d[2] + w * c[2])",
    ),
    "J-exchanged": Mistake(
        "moments of the two bodies exchanged, second degree",
        "gravity.py",
        "two.gm * one.moments, one.gm * two.moments",
        "two.gm * two.moments, one.gm * one.moments",
    ),
    "mass-exchanged": Mistake(
        "masses of the two bodies exchanged in (93)",
        PRINTED,
        "x[i] = x[i] + h / m[i] * gamma[i] - h**2 / (2 * m[i]) * dU[i]  # (93)",
        "x[i] = x[i] + h / m[i] * gamma[i] - h**2 / (2 * m[-1 - i]) * dU[i]  # (93)",
    ),
    "inertia-of-ellipsoid": Mistake(
        "4 for 5 in an ellipsoid's inertia",
        "shapes.py",
        "(squares.sum() - squares) / 5",
        "(squares.sum() - squares) / 4",
    ),
    "multipole-sign": Mistake(
        "a sign in the force across X, multipoles",
        f"{POTENTIALS}/multipole.py",
        "slope * (second(sums.ty) - first(sums.ty))",
        "slope * (second(sums.ty) + first(sums.ty))",
    ),
    "moments-of-ellipsoid": Mistake(
        "4 for 3 in an ellipsoid's moments from degree 4 on",
        "kernels/moments.py",
        "ways = 3 * prod(",
        "ways = 4 * prod(",
    ),
    "digits-of-scheme": Mistake(
        "two digits exchanged in a kick of rkn6a", "schemes.py", "0.328567693746804", "0.328576693746804"
    ),
    "elliptic-series": Mistake(
        "a coefficient in the series of the elliptic sine, exact rotor",
        "kernels/rotor.py",
        "(p2 + 12.0 * m) * (1 / 120)",
        "(p2 + 14.0 * m) * (1 / 120)",
    ),
    "points-twice": Mistake(
        "the attraction of points kept in the kicks of Kepler splittings",
        "kernels/pair/kepler_splitting.py",
        "return gradient[0] - k * x[0], gradient[1] - k * x[1], gradient[2] - k * x[2]",
        "return gradient[0], gradient[1], gradient[2] - 0.0 * k",
    ),
    "tide-of-sun": Mistake(
        "a next term in Battin's f(q), the tide of a distant mass",
        "kernels/external/third_body.py",
        "f = less * (w * w + w + 1.0)",
        "f = less * (w * w + w + 1.0 + less)",
    ),
    "torque-of-sun": Mistake(
        "sign of the torque of a distant mass",
        "kernels/external/third_body.py",
        "jd, n = rotate(r, jb), cross(b, jb)",
        "jd, n = rotate(r, jb), cross(jb, b)",
    ),
    "lag-in-time": Mistake(
        "factor 2 in what a lag in time does along the line of centres",
        "kernels/external/tides.py",
        "along = 2.0 * dot(r, v) / square",
        "along = dot(r, v) / square",
    ),
    "work-at-the-middle": Mistake(
        "half of a third of how the power of a force changes in a kick",
        "kernels/pair/disturbed.py",
        "power -= sign * power_of_all(external) / 3.0",
        "power -= sign * power_of_all(external) / 6.0",
    ),
}  # fmt: skip


class Sight(NamedTuple):
    """What came of a mistake: the cases that failed, and what was printed."""

    name: str
    seen_by: list[str]
    output: str
    passed: bool


def attempt(name: str, cases: Sequence[str]) -> Sight:
    """Plant a mistake in a copy of the sources and run the cases on it, in a process of its own."""
    mistake = MISTAKES[name]
    with tempfile.TemporaryDirectory(prefix="planted-") as folder:
        package = Path(folder) / "src" / "binaryast"
        shutil.copytree(SOURCE, package, ignore=shutil.ignore_patterns("__pycache__"))
        if mistake is not None:
            mistake.plant(package)
        environment = os.environ | {
            "PYTHONPATH": os.pathsep.join([str(package.parent), str(ROOT)]),
            "BINARYAST_CACHE_DIR": str(Path(folder) / "cache"),
        }
        where = [sys.executable, "-c", "import binaryast; print(binaryast.__file__)"]
        found = subprocess.run(where, cwd=folder, env=environment, capture_output=True, text=True, check=True)
        if Path(found.stdout.strip()).parent.resolve() != package.resolve():
            raise InputError(f"the copy in {package} is not what runs, but {found.stdout.strip()}")
        command = [sys.executable, "-m", "validation", "--quick", "-o", str(Path(folder) / "report"), *cases]
        result = subprocess.run(command, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    failed = [line.split()[1] for line in result.stdout.splitlines() if line.startswith(("FAIL", "ERROR"))]
    return Sight(name, failed, result.stdout + result.stderr, result.returncode == 0)


def main(names: Sequence[str], cases: Sequence[str]) -> int:
    """Plant mistakes, all or those named, and print which cases saw each; return 1 where one was not seen."""
    unknown = [name for name in names if name not in MISTAKES]
    if unknown:
        near = did_you_mean(unknown[0], MISTAKES)
        raise InputError(f"{unknown[0]!r} is no mistake{near} (there are {', '.join(MISTAKES)})")
    chosen = list(dict.fromkeys(["none", *(names or MISTAKES)]))
    missed = 0
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        for sight in pool.map(lambda name: attempt(name, cases), chosen):
            mistake = MISTAKES[sight.name]
            if mistake is None:
                good, text = sight.passed, "every case passes" if sight.passed else f"FAIL without any: {sight.output}"
            else:
                good = bool(sight.seen_by)
                text = f"seen by {', '.join(sight.seen_by)}" if good else f"NOT SEEN: {sight.output}"
            missed += not good
            print(f"{sight.name:22} {mistake.what if mistake else 'nothing planted'}: {text}", flush=True)
    return 1 if missed else 0
