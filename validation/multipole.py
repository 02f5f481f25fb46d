"""What the multipole potential costs at each degree: ``python -m validation.multipole``.

One core, warm, each beside a plain vectorised sum over 256 point pairs in the same rounds; the medians of time and of
the ratio. Then what compiling a degree costs on a machine that never saw it, and loading it again.
"""

import os
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable

import astropy.units as u
import numpy as np
from numba import types
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import Gravity
from binaryast.kernels.jit import ARRAY, PAIR_POINTER, Array, PairPotential, jit
from validation.costs import plain_sum, steps_of

ROUNDS = 15
DEGREES = (2, 3, 4, 6, 8, 12, 16)
X = np.array([900.0, 700.0, -400.0])
COLD = """
import sys, time
from binaryast.kernels import jit
began = time.perf_counter()
from binaryast.kernels.mutual.multipole_kernels import potential_of
potential_of(int(sys.argv[1]), even=sys.argv[2] == "even")
print(time.perf_counter() - began)
"""


@jit(types.float64(PAIR_POINTER, ARRAY, ARRAY, types.int64))
def repeat(potential: PairPotential, p: Array, v: Array, count: int) -> float:
    """Evaluate a potential so many times at X and R (12 numbers), a little further on each time."""
    result = 0.0
    for k in range(count):
        a, b, c, d, e, f, g = potential(
            p, v[0] + 1e-9 * k, v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], v[9], v[10], v[11]
        )
        result += a + b + c + d + e + f + g
    return result


def bodies(kind: str) -> list[ba.RigidBody]:
    """Return two ellipsoids, or two bodies none of whose moments vanish."""
    sizes = {"A": (420, 400, 330), "B": (100, 80, 60)}
    if kind == "ellipsoids":
        return [ba.RigidBody(n, ba.Ellipsoid(*(np.array(s) * u.m)), mass=1e11 * u.kg) for n, s in sizes.items()]
    random = np.random.default_rng(0)
    return [
        ba.RigidBody(n, ba.PointCloud(random.normal(size=(20, 3)) * s / 2 * u.m), mass=1e11 * u.kg)
        for n, s in sizes.items()
    ]


def jobs_of(kind: str) -> dict[tuple[str, str], tuple[Callable[[int], object], int]]:
    """Return what is measured: evaluations and steps at each degree."""
    gravities: list[Gravity] = [ba.SecondDegree(), *(ba.Multipole(degree) for degree in DEGREES)]
    if kind == "ellipsoids":
        gravities += [ba.EllipsoidPair(), ba.Adaptive(accuracy=1e-6)]
    v = np.concatenate([X, Rotation.from_rotvec([0.5, -0.3, 0.9]).as_matrix().ravel()])
    jobs: dict[tuple[str, str], tuple[Callable[[int], object], int]] = {}
    for gravity in gravities:
        system = ba.System(bodies(kind), gravity)
        p, potential = system.parameters, system.pairs[0].potential
        jobs[repr(gravity), "evaluation"] = (lambda n, f=potential, p=p: repeat(f, p, v, n), 20_000)  # type: ignore[misc]
        state = ba.State.circular_orbit(system, separation=1300 * u.m, spins=[3 * u.h, "synchronous"])
        jobs[repr(gravity), "LGVI step"] = (steps_of(system, state, 10.0), 10_000)
    return jobs


def compiling() -> None:
    """Print what a degree costs at first and in a later process, without the import of numba."""
    print(f"\n{'compiling, s':28} {'first':>8} {'again':>8}")
    for degree, kind in ((4, "even"), (4, "general"), (8, "even"), (8, "general"), (16, "general")):
        with tempfile.TemporaryDirectory() as folder:
            arguments = [sys.executable, "-c", COLD, str(degree), kind]
            environment = os.environ | {"BINARYAST_CACHE_DIR": folder}
            times = [
                float(subprocess.run(arguments, env=environment, capture_output=True, text=True, check=True).stdout)
                for _ in range(2)
            ]
        print(f"{f'degree {degree}, {kind} moments':28} {times[0]:8.2f} {times[1]:8.2f}")


def main() -> None:
    """Measure and print."""
    random = np.random.default_rng(0)
    clouds = [
        np.vstack([random.normal(size=(3, 16)) + np.array([[offset], [0], [0]]), np.ones(16)]) for offset in (0.0, 10.0)
    ]
    for kind in ("ellipsoids", "any bodies"):
        jobs = jobs_of(kind)
        times: dict[object, list[float]] = {name: [] for name in (*jobs, "sum")}
        for round_ in range(ROUNDS + 1):  # the first one only warms up
            for name, (job, count) in (*jobs.items(), ("sum", (lambda n: plain_sum(*clouds, n), 20_000))):
                began = time.perf_counter()
                job(count)
                if round_:
                    times[name].append((time.perf_counter() - began) / count * 1e6)
        print(f"\n{kind}; the sum over 256 point pairs: {statistics.median(times['sum']):.3f} us")
        print(f"{'':22} {'evaluation, us':>15} {'over the sum':>13} {'LGVI step, us':>15} {'over the sum':>13}")
        for gravity in dict.fromkeys(name for name, _ in jobs):
            columns = []
            for what in ("evaluation", "LGVI step"):
                ratio = statistics.median(a / b for a, b in zip(times[gravity, what], times["sum"], strict=True))
                columns.append(f"{statistics.median(times[gravity, what]):15.3f} {ratio:13.2f}")
            print(f"{gravity:22} {' '.join(columns)}")
    compiling()


if __name__ == "__main__":
    main()
