"""A light body about an oblate one: the secular motion of its node and of its apse by J2."""

from functools import cache

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import drawing, fitting, methods
from validation.case import Case, Check, Effort, Findings, Picture

RADIUS = 400.0  # m: equatorial
MASS, LIGHT = 5e11, 1.0  # kg
AXIS, ECCENTRICITY = 1200.0, 0.1  # m: of the orbit
RATE = np.sqrt(ba.constants.G * MASS / AXIS**3)  # rad/s
J2 = (8e-4, 4e-4, 2e-4, 1e-4)  # extrapolated to a sphere
PER_TURN = (256, 512, 1024, 2048)  # steps, extrapolated to a step of zero
TURNS = 60
ROWS = 32  # in a turn
INCLINATIONS = (5.0, 30.0, 50.0, 63.4349, 75.0, 90.0, 110.0, 130.0, 150.0, 175.0)  # deg
WHY = "what is left by the extrapolations of J2, from 8e-4 to 1e-4, and of the step"


def start(j2: float, inclination: float) -> tuple[ba.System, ba.State]:
    """Return the system, and a start with the osculating elements."""
    c = np.sqrt(1 - 5 * j2) * RADIUS  # of a homogeneous ellipsoid: J2 = (a^2 - c^2)/(5 a^2)
    oblate = ba.RigidBody("oblate", ba.Ellipsoid(RADIUS * u.m, RADIUS * u.m, c * u.m), mass=MASS * u.kg)
    light = ba.RigidBody("light", ba.Point(), mass=LIGHT * u.kg)
    system = ba.System([oblate, light], gravity=ba.SecondDegree())
    orbit = ba.Orbit(
        AXIS * u.m,
        ECCENTRICITY,
        inclination * u.deg,
        longitude_of_ascending_node=40 * u.deg,
        argument_of_periapsis=70 * u.deg,
        true_anomaly=20 * u.deg,
    )
    return system, ba.State.from_orbits(system, [orbit], spins=[5 * u.h, None], poles={"oblate": [0, 0, 1]})


def node_and_apse(run: ba.Trajectory) -> tuple[np.ndarray, np.ndarray]:
    """Return the node's longitude and the apse's angle from it [rad], osculating, continuous in time."""
    x, v = (array[:, 1] - array[:, 0] for array in (run.si.position, run.si.velocity))
    h = np.cross(x, v)
    apse = np.cross(v, h) / (ba.constants.G * (MASS + LIGHT)) - x / np.linalg.norm(x, axis=1, keepdims=True)
    node = np.cross([0, 0, 1], h)
    across = np.cross(h, node) / np.linalg.norm(h, axis=1, keepdims=True)
    longitude = np.arctan2(node[:, 1], node[:, 0])
    argument = np.arctan2(np.sum(apse * across, axis=1), np.sum(apse * node, axis=1))
    return np.unwrap(longitude), np.unwrap(argument)


def rates(j2: float, inclination: float, per_turn: int, frame: str = "relative") -> np.ndarray:
    """Return the mean rates of node and apse over n J2 (R/p)^2."""
    period = 2 * np.pi / RATE * u.s
    integrator = ba.LGVI(period / per_turn * (1 + 1e-12), frame=frame)
    run = ba.propagate(
        *start(j2, inclination), duration=TURNS * period, integrator=integrator, save_every=period / ROWS
    )
    unit = RATE * j2 * (RADIUS / (AXIS * (1 - ECCENTRICITY**2))) ** 2
    return np.array([fitting.mean_rate(run.si.time, angle) for angle in node_and_apse(run)]) / unit


def first_order(inclination: float) -> np.ndarray:
    """Return the secular rates of node and apse over n J2 (R/p)^2: -3/2 cos i and 3/4 (5 cos^2 i - 1)."""
    cosine = np.cos(np.radians(inclination))
    return np.array([-1.5 * cosine, 0.75 * (5 * cosine**2 - 1)])


@cache
def by_j2(inclination: float, frame: str = "relative") -> np.ndarray:
    """Return the rates for each J2, extrapolated to a step of zero (J2, node and apse)."""
    return np.array([fitting.to_zero([rates(j2, inclination, count, frame) for count in PER_TURN]) for j2 in J2])


def limit(inclination: float, frame: str = "relative") -> np.ndarray:
    """Return the rates in the limit of a small J2, from which they differ by a series in J2."""
    return fitting.to_zero(list(by_j2(inclination, frame)), power=1, then=1)


def run(effort: Effort) -> Findings:
    """Measure the rates over the inclinations."""
    checks = [*near_equator(), *all_inclinations(), linear_in_j2()]
    if effort > Effort.QUICK:
        checks.append(inertial())
    return Findings(checks, [picture()])


def near_equator() -> list[Check]:
    """Return the checks of a prograde orbit near the equator, where the node goes back and the apse forward."""
    found, theory = limit(5.0), first_order(5.0)
    return [
        Check(
            f"inclination 5 deg: rate of the {name} over n J2 (R/p)^2, which is {formula}, J2 -> 0",
            value - exact,
            tolerance,
            WHY,
            shown=f"{value:+.9f}, the {name} {way}",
            headline=True,
        )
        for name, formula, way, value, exact, tolerance in zip(
            ("node", "apse"),
            ("-3/2 cos i", "3/4 (5 cos^2 i - 1)"),
            ("regresses", "advances"),
            found,
            theory,
            (1.5e-11, 2e-10),
            strict=True,
        )
    ]


def all_inclinations() -> list[Check]:
    """Return the checks over all inclinations."""
    errors = np.array([np.abs(limit(i) - first_order(i)) for i in INCLINATIONS]).max(axis=0)
    return [
        Check(f"rate of the {name}, J2 -> 0, the worst of {len(INCLINATIONS)} inclinations", error, tolerance, WHY)
        for name, error, tolerance in zip(("node", "apse"), errors, (2e-11, 2e-10), strict=True)
    ]


def linear_in_j2() -> Check:
    """Return the check that first-order theory errs by a part that is linear in J2."""
    errors = np.abs(by_j2(5.0) - first_order(5.0)).max(axis=1)
    order = methods.slope(J2, errors)
    return Check(
        "inclination 5 deg: the error of first-order theory over the rates: power of J2",
        order - 1,
        4e-4,
        "the next power of J2",
        shown=f"{order:.5f}",
    )


def inertial() -> Check:
    """Return the check of the other frame."""
    apart = np.abs(limit(50.0, "inertial") - limit(50.0)).max()
    return Check(
        "inclination 50 deg: the rates by the inertial map less those by the relative one",
        apart,
        2e-12,
        "rounding, over J2",
        roundoff=True,
    )


def picture() -> Picture:
    """Draw the rates against inclination, and the error of first-order theory against J2."""
    figure, (left, right) = drawing.axes(2)
    left.set(xlabel="inclination [deg]", ylabel="rate over n J2 (R/p)²")
    fine = np.linspace(0, 180, 181)
    curves = np.array([first_order(i) for i in fine])
    points = np.array([limit(i) for i in INCLINATIONS])
    names = ("node: -3/2 cos i", "apse from the node: 3/4 (5 cos² i - 1)")
    for k, name in enumerate(names):
        colour = drawing.COLOURS[k]
        left.plot(fine, curves[:, k], color=colour, lw=1, label=name)
        left.plot(INCLINATIONS, points[:, k], drawing.MARKERS[k], color=colour, ms=4, label="measured, J2 -> 0")
    left.axhline(0, color="#333333", lw=0.6)
    left.set(xticks=range(0, 181, 30), ylim=(-2, 5))
    drawing.legend(left, ncols=2, loc="upper center")
    right.set(xlabel="J2", ylabel="error of first-order theory over n J2 (R/p)²")
    for k, (inclination, which) in enumerate(((5.0, 0), (5.0, 1), (150.0, 0), (150.0, 1))):
        errors = np.abs(by_j2(inclination) - first_order(inclination))[:, which]
        drawing.curve(right, J2, errors, f"{('node', 'apse')[which]}, {inclination:.0f} deg", k)
        drawing.slope_line(right, J2, (J2[-1], errors[-1]), 1, "_" if k else "slope 1")
    drawing.ticks(right, J2)
    drawing.legend(right)
    caption = (
        "Left: secular rates of node and apse by J2, first-order theory and runs extrapolated to a small J2: a "
        "prograde orbit's node regresses, and near the equator its apse advances. Right: at a finite J2 the rates "
        "differ from that theory by a part linear in J2, which is of second order."
    )
    return Picture("oblateness", figure, caption)


CASE = Case(
    "oblateness",
    "Do node and apse of a light body about an oblate one move by J2 as first-order theory says, signs included?",
    "closed form: -3/2 n J2 (R/p)^2 cos i and 3/4 n J2 (R/p)^2 (5 cos^2 i - 1)",
    run,
)
