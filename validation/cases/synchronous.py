"""The doubly synchronous equilibrium: two triaxial bodies that keep their faces to each other on a circular orbit.

With gravity of second degree n^2 = G (m1 + m2)/r^3 [1 + 3/(2 r^2) sum (B + C - 2 A)/m], the longest axes in line.
"""

from collections.abc import Sequence
from functools import cache

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import difference
from validation.methods import Method

AXES = ((300.0, 240.0, 200.0), (200.0, 170.0, 130.0))  # m, the primary first
MASSES = (2.0e11, 6.0e10)  # kg
SEPARATION = 1200.0  # m
NAMES = ("separation", "primary's face", "secondary's face")
STAY = 20  # turns over which a run is watched
PER_TURN = (128, 256, 512, 1024)  # steps
TURNS = 2  # after which a run is where the formula says
COUNTS = (256, 512, 1024, 2048, 4096)  # steps in all turns
LIMITS = (5e-14, 5e-14, 7e-13, 6e-13)  # what round-off leaves of each method's error


def rate(separation: float, axes: Sequence[Sequence[float]] = AXES) -> float:
    """Return the rate of the equilibrium [rad/s] with the x axes in line, by the formula."""
    squares = np.square(axes)
    A, B, C = (squares.sum(axis=1, keepdims=True) - squares).T / 5  # over the mass [m2]
    return float(
        np.sqrt(ba.constants.G * sum(MASSES) / separation**3 * (1 + 1.5 * np.sum(B + C - 2 * A) / separation**2))
    )


def system(axes: Sequence[Sequence[float]] = AXES) -> ba.System:
    """Return the pair."""
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(*(semi_axes * u.m)), mass=mass * u.kg)
        for name, semi_axes, mass in zip(("one", "two"), axes, MASSES, strict=True)
    ]
    return ba.System(bodies, gravity=ba.SecondDegree())


def start() -> ba.State:
    """Return the equilibrium, as the package finds it."""
    return ba.State.circular_orbit(system(), separation=SEPARATION * u.m, spins=["synchronous", "synchronous"])


def exact(time: float) -> Snapshot:
    """Return the steady turn by the formula's rate."""
    n = rate(SEPARATION)
    turn = Rotation.from_rotvec([0, 0, n * time]).as_matrix()
    shares = np.array([[-MASSES[1]], [MASSES[0]]]) / sum(MASSES)
    x = shares * SEPARATION * turn[:, 0]
    return Snapshot(v=np.cross([0, 0, n], x), Omega=np.array([[0, 0, n]] * 2), x=x, R=np.array([turn, turn]))


def rate_errors() -> list[float]:
    """Return how far rates and separations found by the package are from the formula, relative.

    At several distances, also with other axes than the longest ones in line, which is an equilibrium too.
    """
    both = "synchronous", "synchronous"
    found = []
    for axes in (AXES, (AXES[0][::-1], AXES[1]), (AXES[0], np.roll(AXES[1], 1)), AXES[::-1]):
        for separation in (600.0, 1200.0, 5000.0):
            n = rate(separation, axes)
            one = ba.State.circular_orbit(system(axes), separation=separation * u.m, spins=both)
            two = ba.State.circular_orbit(system(axes), period=2 * np.pi / n * u.s, spins=both)
            speed = np.linalg.norm(one.si.velocity[1] - one.si.velocity[0]) / separation
            found += [one.si.spin[0, 2] / n - 1, speed / n - 1, two.separation.value / separation - 1]
    return found


@cache
def wandering(frame: str, per_turn: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the turns of a run in so many steps each, and how far it is off the equilibrium then (time, 3).

    Of the separation, relative, and of each body's long axis from the line of centres [rad].
    """
    period = 2 * np.pi / rate(SEPARATION)
    step = period / per_turn * u.s
    integrator = ba.LGVI(step * (1 + 1e-12), frame=frame)
    run = ba.propagate(system(), start(), duration=STAY * period * u.s, integrator=integrator, save_every=step)
    x = run.si.position[:, 1] - run.si.position[:, 0]
    r = np.linalg.norm(x, axis=1, keepdims=True)
    faces = np.cross(run.si.attitude[..., 0], (x / r)[:, None])[..., 2]
    return run.si.time / period, np.hstack([r / SEPARATION - 1, faces])


def wandering_checks(frame: str) -> list[Check]:
    """Return the checks that a run stays in the equilibrium but for the square of its step."""
    largest = np.array([np.abs(wandering(frame, count)[1]).max(axis=0) for count in PER_TURN])
    orders = [methods.slope(1 / np.array(PER_TURN), column) for column in largest.T]
    return [
        Check(
            f"{frame} frame: {name}, furthest from the equilibrium over {STAY} turns: order in the step",
            order - 2,
            tolerance,
            "the next power of h^2",
            shown=f"{order:.5f}",
        )
        for name, order, tolerance in zip(NAMES, orders, (1.5e-3, 2e-4, 6e-4), strict=True)
    ]


def end_checks(method: Method, tolerance: float) -> list[Check]:
    """Return the checks of where a method ends: positions, velocities, attitudes and spins of both bodies."""
    time = TURNS * 2 * np.pi / rate(SEPARATION)
    ends = [method.end(system(), start(), time, count) for count in COUNTS]
    errors = [difference(end, exact(time)).largest for end in ends]
    order = methods.slope(1 / np.array(COUNTS), errors)
    limit = methods.limit(method, system(), start(), time, COUNTS)
    return [
        Check(
            f"{method.name}: after {TURNS} turns: order in the step",
            order - 2,
            6e-4,
            "the next power of h^2",
            shown=f"{order:.5f}",
        ),
        Check(
            f"{method.name}: after {TURNS} turns, step -> 0: position, velocity, attitude, spin",
            difference(limit, exact(time)).largest,
            tolerance,
            "rounding; as printed, of products of matrices, which leave SO(3)",
            headline=method is methods.RELATIVE,
            roundoff=True,
        ),
    ]


def run(effort: Effort) -> Findings:
    """Find the equilibrium, and follow it."""
    checks = [
        Check(
            "rate and separation of the equilibrium, by the package and by the formula, the worst of 36",
            np.abs(rate_errors()).max(),
            3e-15,
            "rounding, and the bracket of the root that gives a separation",
            headline=True,
            roundoff=True,
        )
    ]
    for frame in ("relative", "inertial"):
        checks += wandering_checks(frame)
    for method, tolerance in zip(methods.OF_PAIRS, LIMITS, strict=True):
        checks += end_checks(method, tolerance)
    return Findings(checks, [picture()])


def picture() -> Picture:
    """Draw how far runs are off the equilibrium, in time and against the step."""
    figure, (left, right) = drawing.axes(2)
    left.set(xlabel="turns", ylabel="off the equilibrium [1e-4 of r, 1e-4 rad]", title=f"{PER_TURN[2]} steps a turn")
    turns, off = wandering("relative", PER_TURN[2])
    for k, name in enumerate(NAMES):
        left.plot(turns, off[:, k] * 1e4, color=drawing.COLOURS[k], lw=1, label=name)
    left.margins(y=0.15)
    drawing.legend(left, ncols=3, loc="upper center")
    right.set(xlabel="n h [rad]", ylabel="furthest from it [of r, rad]")
    angles = 2 * np.pi / np.array(PER_TURN)
    for k, name in enumerate(NAMES):
        found = [np.abs(wandering("relative", count)[1][:, k]).max() for count in PER_TURN]
        drawing.curve(right, angles, found, name, k)
        drawing.slope_line(right, angles, (angles[-1], found[-1]), 2, "_" if k else "slope 2")
    drawing.ticks(right, angles)
    drawing.legend(right)
    caption = (
        "Started in the equilibrium of the formula, a run librates about that of its map, which is off by the square "
        f"of the step: left in time, right the largest over {STAY} turns."
    )
    return Picture("synchronous", figure, caption)


CASE = Case(
    "synchronous",
    "Is the doubly synchronous equilibrium where the formula says, and does a run stay in it?",
    "closed form: n^2 = G (m1 + m2)/r^3 [1 + 3/(2 r^2) sum (B + C - 2 A)/m], a steady turn",
    run,
)
