"""Two ellipsoids exactly up to contact, what a series leaves out there, and two models that are joined by distance.

The package takes the mean of one ellipsoid's field over the focal disc of the other, in two dimensions; the oracle
takes it over the body, in three.
"""

from dataclasses import dataclass
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import Gravity
from binaryast.units import Floats
from validation import drawing, truncation
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import potentials
from validation.oracles.potentials import Attraction

TURN = Rotation.from_euler("ZXZ", [30, 20, 10], degrees=True).as_matrix()


class Pair(NamedTuple):
    """Semi-axes [m] of two ellipsoids, the attitude of the second, and its direction from the first."""

    name: str
    one: np.ndarray
    two: np.ndarray
    attitude: np.ndarray
    towards: np.ndarray

    def computed(self, gravity: Gravity, x: np.ndarray) -> Attraction:
        """Return what the package says, for G m1 m2 = 1."""
        found = truncation.system(self.one, self.two, gravity).mutual_gravity(x * u.m, self.attitude)
        return Attraction(found.energy.value, found.gradient.value, found.moment.value)

    def contact(self) -> float:
        """Return the distance of the centres at which the surfaces touch."""
        s = np.linspace(0, 1, 100_001)[1:-1]
        first, second = np.diag(self.one**2), self.attitude @ np.diag(self.two**2) @ self.attitude.T
        n = self.towards / np.linalg.norm(self.towards)
        matrices = (1 - s)[:, None, None] * first + s[:, None, None] * second
        return float(1 / np.sqrt((s * (1 - s) * (np.linalg.inv(matrices) @ n @ n)).max()))

    def at(self, distance: float) -> np.ndarray:
        """Return X at a distance."""
        return self.towards / np.linalg.norm(self.towards) * distance


ALIKE = Pair("alike", np.array([400.0, 395, 340]), np.array([85.0, 73, 63]), np.eye(3), np.array([1195.0, 0, 0]))
LONG = Pair("long", np.array([1, 0.5, 0.3]), np.array([0.7, 0.4, 0.25]), TURN, np.array([6.0, 2, 1]))
TIP = Pair("tip to tip", LONG.one, LONG.two, np.eye(3), np.array([1.0, 0, 0]))
BESIDE = Pair("side by side", LONG.one, LONG.two, np.eye(3), np.array([0, 0, 1.0]))
KNOWN = (  # distance, value, and half of its last digit
    (ALIKE, 1195.0, -8.39992172639902e-4, 6e-16),
    (LONG, float(np.sqrt(41)), -1.56938569657589e-1, 3.2e-15),
)
NEAR = 1.05  # of the distance at contact
NODES = 64  # of each of the oracle's three rules: at 48 they leave 3e-12 of dU/dX, here less than round-off
DEGREES = (2, 4, 6, 8)  # of ellipsoids: an odd one is the same as the even one before it
GAPS = np.geomspace(1e-3, 10, 17)  # separation over that of contact, less one
ACCURACY, STEP = 1e-4, 60 * u.s  # of the runs
FEW = 40  # orbits, over which runs at two steps are alike; later chaos parts them


def known_checks() -> list[Check]:
    """Return the checks of the known values."""
    values = [
        (pair, value, half, pair.computed(ba.EllipsoidPair(), pair.at(r)).energy) for pair, r, value, half in KNOWN
    ]
    return [
        Check(
            f"U/(G m1 m2) [1/m], {pair.one} m and {pair.two} m, as it is known",
            found / value - 1,
            half,
            "half of the last of the 15 digits known",
            shown=f"{found:.15g}",
            headline=pair is LONG,
            printed=True,
        )
        for pair, value, half, found in values
    ]


def contact_checks() -> list[Check]:
    """Return the checks at 1.05 times the distance of contact."""
    checks = []
    for pair, tolerance in ((ALIKE, 2e-14), (LONG, 2e-14), (TIP, 6e-15)):
        x = pair.at(NEAR * pair.contact())
        found = pair.computed(ba.EllipsoidPair(), x)
        exact = potentials.two_ellipsoids(pair.one, pair.two, x, pair.attitude, NODES)
        force = np.linalg.norm(exact.gradient)
        errors = (
            abs(found.energy / exact.energy - 1),
            np.linalg.norm(found.gradient - exact.gradient) / force,
            np.linalg.norm(found.moment - exact.moment) / (force * pair.two.max()),
        )
        checks.append(
            Check(
                f"{pair.name}: U, dU/dX and M over force times semi-axis, at {NEAR} times contact: the largest error",
                float(max(errors)),
                tolerance,
                f"rounding of the oracle's sum over {NODES}^3 nodes; 48^3 leave up to 3e-12",
                shown=", ".join(f"{error:.1e}" for error in errors),
                headline=pair is LONG,
                roundoff=True,
            )
        )
    return checks


def series_errors(pair: Pair, distances: np.ndarray) -> np.ndarray:
    """Return the relative errors (degree, distance, 2) in U and dU/dX of the series cut at each degree."""
    exact = [pair.computed(ba.EllipsoidPair(), pair.at(r)) for r in distances]
    found = [[pair.computed(ba.Multipole(n), pair.at(r)) for r in distances] for n in DEGREES]
    return np.array([[truncation.apart(a, b)[:2] for a, b in zip(row, exact, strict=True)] for row in found])


def series_checks(errors: np.ndarray) -> list[Check]:
    """Return the checks of the powers by which what the series leaves out falls far away, and of its size near."""
    far = np.log(errors[:, -2, 0] / errors[:, -1, 0]) / np.log((1 + GAPS[-1]) / (1 + GAPS[-2]))
    return [
        Check(
            f"tip to tip, far away: errors of U at degrees {DEGREES} fall with distance by the powers (4, 6, 8, 10)",
            float(np.abs(far - np.array(DEGREES) - 2).max()),
            0.05,
            "degrees beyond the next add (size/r)^2 of its part; at degree 8 rounding, 1e-2 of what is left",
            shown=", ".join(f"{power:.3f}" for power in far),
        )
    ]


@dataclass(frozen=True, eq=False, kw_only=True)
class HardSwitch(ba.Adaptive):
    """The same two models, changed at one distance from one to the other: what is not done."""

    def _interval(self, secondary: ba.RigidBody, primary: ba.RigidBody) -> Floats:
        return np.full(2, super()._interval(secondary, primary).mean())


def run_of(gravity: Gravity, orbits: int, step: u.Quantity = STEP) -> tuple[np.ndarray, np.ndarray]:
    """Return time in orbits and the error of energy over |U0| of an eccentric pair under a model of gravity."""
    density = 2000 * u.kg / u.m**3
    bodies = [
        ba.RigidBody("A", ba.Ellipsoid(500 * u.m, 450 * u.m, 400 * u.m), density=density),
        ba.RigidBody("B", ba.Ellipsoid(100 * u.m, 80 * u.m, 70 * u.m), density=density),
    ]
    system = ba.System(bodies, gravity)
    start = ba.State.from_elements(
        system, semi_major_axis=1800 * u.m, eccentricity=0.35, spins=[5 * u.h, 7 * u.h], true_anomaly=180 * u.deg
    )
    period = 2 * np.pi * np.sqrt(1800.0**3 / sum(body.si.gm for body in bodies))
    run = ba.propagate(
        system, start, duration=orbits * period * u.s, save_every=period / 40 * u.s, integrator=ba.LGVI(step)
    )
    energy = run.energy.value
    unit = abs(system.attraction(*_configuration(start))[0])
    return run.time.to_value("s") / period, (energy - energy[0]) / unit


def _configuration(state: ba.State) -> tuple[np.ndarray, np.ndarray]:
    """Return X and R."""
    relative = state.relative()
    return relative.X.value, np.asarray(relative.R)


def energy_checks(runs: dict[str, tuple[np.ndarray, np.ndarray]]) -> list[Check]:
    """Return the checks that the error of energy is the integrator's, and nothing is added where models are joined."""
    rows = len(runs["half"][1])
    swing = {name: float(np.abs(energy[:rows]).max()) for name, (_, energy) in runs.items()}
    return [
        Check(
            f"joined at an accuracy of {ACCURACY:g}: error of energy over |U0|, over that of the exact model, minus 1",
            swing["joined"] / swing["exact"] - 1,
            0.01,
            "another potential where the series is taken: the integrator's own error, not that of a jump",
            shown=f"{swing['joined']:.2e}, exact {swing['exact']:.2e}, switched {swing['switched']:.2e}",
        ),
        Check(
            "joined: error of energy at a step, over four times that at half the step, minus 1: it is of second order",
            swing["joined"] / swing["half"] / 4 - 1,
            0.1,
            "the error of fourth order, and rows that do not fall on its maximum",
            shown=f"{swing['joined']:.3e}, at half the step {swing['half']:.3e}",
        ),
    ]


def run(effort: Effort) -> Findings:
    """Compare values, the series, and runs."""
    errors = series_errors(TIP, TIP.contact() * (1 + GAPS))
    models = {
        "exact": ba.EllipsoidPair(),
        "joined": ba.Adaptive(accuracy=ACCURACY, far=ba.SecondDegree()),
        "switched": HardSwitch(accuracy=ACCURACY, far=ba.SecondDegree()),
    }
    orbits = FEW if effort == Effort.QUICK else 200
    runs = {name: run_of(model, orbits) for name, model in models.items()}
    runs["half"] = run_of(models["joined"], FEW, STEP / 2)
    checks = known_checks() + contact_checks() + series_checks(errors) + energy_checks(runs)
    return Findings(checks, [picture_of_series(errors), picture_of_energy(runs)])


def picture_of_series(errors: np.ndarray) -> Picture:
    """Draw what the series leaves out against the gap between the surfaces."""
    figure, panels = drawing.axes(
        2, xlabel="separation over that at contact, minus 1", ylabel="relative error of dU/dX"
    )
    beside = series_errors(BESIDE, BESIDE.contact() * (1 + GAPS))
    for ax, pair, found in zip(panels, (TIP, BESIDE), (errors, beside), strict=True):
        ax.set_title(pair.name)
        for i, n in enumerate(DEGREES):
            drawing.curve(ax, GAPS, found[i, :, 1], f"Multipole({n})", i)
        drawing.legend(ax)
    caption = (
        "Ellipsoids of 1, 0.5, 0.3 m and 0.7, 0.4, 0.25 m: what a series cut at a degree leaves out of the attraction, "
        "against the exact model, from a gap of a thousandth on. Side by side, where the centres are nearer than the "
        f"series converges, it is wrong by {beside[-1, 0, 1]:.0f} times the attraction at degree {DEGREES[-1]}, and "
        "each degree makes it worse."
    )
    return Picture("exact-ellipsoids", figure, caption)


def picture_of_energy(runs: dict[str, tuple[np.ndarray, np.ndarray]]) -> Picture:
    """Draw the error of energy over the orbits."""
    figure, (ax,) = drawing.axes(1, xlabel="orbits", ylabel="error of energy over |U0|", yscale="log")
    for i, name in ((2, "exact"), (0, "joined"), (1, "switched")):
        orbits, energy = runs[name]
        rows = max(1, len(orbits) // 800)
        shown = np.abs(energy[1:][::rows])
        ax.plot(orbits[1:][::rows], shown, ".", ms=2, color=drawing.COLOURS[i], label=name)
    drawing.legend(ax, markerscale=4)
    caption = (
        "An eccentric pair that crosses twice in each orbit from the exact model to second degree and back: errors of "
        "energy. Where the models are joined smoothly it only swings, as under the exact model alone; where they are "
        "switched at one distance, it drifts."
    )
    return Picture("joined-gravity", figure, caption)


CASE = Case(
    "exact-ellipsoids",
    "Is the gravity of two ellipsoids exact up to contact, and energy kept where it is joined to a series?",
    "the mean over one body, by a product rule in three dimensions, of the other's closed potential; known values",
    run,
    needs=("scipy",),
)
