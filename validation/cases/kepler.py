"""Two point masses or spheres on Kepler orbits of eccentricity 0, 0.3 and 0.9, beside REBOUND's integrators.

Spheres attract like points, whichever gravity they are given, and turn freely. Each difference is the largest in
position, velocity, attitude and spin of both bodies, in both frames, with every gravity. The barycentre moves.
"""

from collections.abc import Callable, Sequence
from itertools import product
from typing import NamedTuple

import astropy.units as u
import numpy as np
from matplotlib.axes import Axes

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import Difference, difference
from validation.methods import Method
from validation.oracles import nbody

ECCENTRICITIES = (0.0, 0.3, 0.9)
SEMI_MAJOR_AXIS = 1e4  # m
MASSES = (7.6e11, 1.5e11)  # kg
RADII = (450.0, 260.0)  # m
SPINS = np.array([[1.0, -2.0, 3.0], [0.3, 0.5, -1.0]])  # in mean motions: slow, so that long steps turn little
ORBITS = 2.3
MEAN_MOTION = float(np.sqrt(ba.constants.G * sum(MASSES) / SEMI_MAJOR_AXIS**3))  # rad/s
TIME = ORBITS * 2 * np.pi / MEAN_MOTION  # s
MAPS = (methods.RELATIVE, methods.INERTIAL)
GRAVITIES = {
    "spheres": (ba.SecondDegree(), ba.PointMass(), ba.PointPairs()),
    "points": (ba.PointMass(), ba.PointPairs()),
}
COARSEST = {0.0: 500, 0.3: 500, 0.9: 8000}  # steps in all from which the error is a series in h^2
HALVINGS = 5
SAME_STEPS = 4000


class Tolerances(NamedTuple):
    """What the errors of one eccentricity may be."""

    limit_of_spheres: float
    limit_of_points: float
    same_map: float
    extended: float
    ias15: float
    whfast: float
    order: float


TOLERANCES = {
    0.0: Tolerances(2e-13, 1e-14, 6e-13, 4e-15, 2e-15, 1e-13, 6e-4),
    0.3: Tolerances(3e-13, 3e-14, 3e-13, 2e-14, 8e-15, 3e-14, 6e-4),
    0.9: Tolerances(1.2e-13, 7e-14, 1.2e-12, 1.2e-13, 3e-14, 5e-13, 1.5e-4),
}

Pair = tuple[ba.System, ba.State]


def orbit(kind: str, e: float, gravity: ba.SecondDegree | ba.PointMass | ba.PointPairs) -> Pair:
    """Return two spheres or two points on an inclined orbit, their barycentre moving."""
    shapes = [ba.Sphere(r * u.m) if kind == "spheres" else ba.Point() for r in RADII]
    bodies = [ba.RigidBody(name, shape, mass=m * u.kg) for name, shape, m in zip("AB", shapes, MASSES, strict=True)]
    system = ba.System(bodies, gravity=gravity)
    state = ba.State.from_elements(
        system,
        semi_major_axis=SEMI_MAJOR_AXIS * u.m,
        eccentricity=e,
        inclination=30 * u.deg,
        longitude_of_ascending_node=10 * u.deg,
        argument_of_periapsis=40 * u.deg,
        mean_anomaly=50 * u.deg,
        spins=[None, None] if kind == "points" else list(SPINS * MEAN_MOTION * u.rad / u.s),
    )
    moving = state.velocity + [1e-3, -2e-3, 5e-4] * u.m / u.s
    return system, ba.State(state.position, moving, state.attitude, state.spin)


def worst(kind: str, e: float, one: Callable[[Method, Pair], Snapshot], two: Callable[[Pair], Snapshot]) -> float:
    """Return the largest difference of two ways to the end, over both frames and all gravities."""
    pairs = [orbit(kind, e, gravity) for gravity in GRAVITIES[kind]]
    return max(difference(one(method, pair), two(pair)).largest for method, pair in product(MAPS, pairs))


def of_limits(e: float) -> list[Check]:
    """Compare the limit of the step to zero with IAS15."""
    counts = [COARSEST[e] * 2**k for k in range(HALVINGS)]
    why = {
        "spheres": "rounding of the attitude of A, 1e-15 of the 54 rad that it turns: the same in every step, for the "
        "spin of a sphere stays where it is in the sphere's frame. The rest is as for points",
        "points": "rounding, most in the velocity; IAS15 itself is as far from Kepler's equation",
    }
    return [
        Check(
            f"e = {e:g}, {kind}: limit of the step to zero minus IAS15",
            worst(
                kind, e, lambda m, pair: methods.limit(m, *pair, TIME, counts), lambda pair: nbody.ias15(*pair, TIME)
            ),
            getattr(TOLERANCES[e], f"limit_of_{kind}"),
            why[kind],
            headline=(kind, e) == ("spheres", 0.9),
            roundoff=True,
        )
        for kind in GRAVITIES
    ]


def of_maps(e: float) -> list[Check]:
    """Compare with REBOUND's leapfrog at the same step, taken from its nodes to ours: the same map."""
    leap = max(
        worst(
            kind,
            e,
            lambda m, pair: m.end(*pair, TIME, SAME_STEPS),
            lambda pair: nbody.kick_drift_kick(*pair, TIME, SAME_STEPS),
        )
        for kind in GRAVITIES
    )
    points = orbit("points", e, ba.PointMass())
    extended = nbody.kick_drift_kick_extended(*points, TIME, SAME_STEPS)
    ours = max(difference(m.end(*points, TIME, SAME_STEPS), extended).largest for m in MAPS)
    return [
        Check(
            f"e = {e:g}, spheres and points, {SAME_STEPS} steps: LGVI minus REBOUND leapfrog, conjugate by half a step",
            leap,
            TOLERANCES[e].same_map,
            "rounding of the leapfrog, whose sums are not compensated: see the next row",
            headline=e == 0.9,
            roundoff=True,
        ),
        Check(
            f"e = {e:g}, points, {SAME_STEPS} steps: LGVI minus the same map {nbody.IN_EXTENDED}",
            ours,
            TOLERANCES[e].extended,
            "rounding of LGVI, whose sums are compensated",
            roundoff=True,
        ),
    ]


def of_oracles(e: float) -> list[Check]:
    """Compare the oracles with Kepler's equation."""
    points = orbit("points", e, ba.PointMass())
    exact = nbody.kepler(*points, TIME)
    ends = {"IAS15": nbody.ias15(*points, TIME), "WHFast, 500 steps": nbody.WHFAST.end(*points, TIME, 500)}
    return [
        Check(
            f"e = {e:g}, the oracle itself: {name} minus Kepler's equation {nbody.IN_EXTENDED}",
            difference(end, exact).largest,
            tolerance,
            "rounding" if name == "IAS15" else "rounding: for two bodies WHFast's map is the exact motion",
            roundoff=True,
        )
        for (name, end), tolerance in zip(ends.items(), (TOLERANCES[e].ias15, TOLERANCES[e].whfast), strict=True)
    ]


def errors(method: Method, kind: str, e: float, counts: Sequence[int]) -> list[Difference]:
    """Return the errors of a method in so many steps, against Kepler's equation."""
    pair = orbit(kind, e, GRAVITIES[kind][0])
    exact = nbody.kepler(*pair, TIME)
    return [difference(method.end(*pair, TIME, count), exact) for count in counts]


def of_orders(e: float) -> Check:
    """Check the order of position, velocity and attitude."""
    counts = [COARSEST[e] * 2**k for k in range(2, HALVINGS)]
    slopes = []
    for method in MAPS:
        of_map = errors(method, "spheres", e, counts)
        slopes += [
            methods.slope([1 / n for n in counts], [getattr(error, part) for error in of_map])
            for part in ("position", "velocity", "attitude")
        ]
    furthest = max(slopes, key=lambda slope: abs(slope - 2))
    return Check(
        f"e = {e:g}, spheres: order in the step of position, velocity and attitude",
        furthest - 2,
        TOLERANCES[e].order,
        "the next power of the step, h^4",
        shown=f"{furthest:.5f}",
    )


def draw(ax: Axes, e: float) -> None:
    """Draw the errors of the methods, and the difference of LGVI from the conjugate leapfrog, against the step."""
    counts = [COARSEST[e] // 8 * 4**k for k in range(5)]
    h = [ORBITS / count for count in counts]
    ours = errors(methods.RELATIVE, "spheres", e, counts)
    drawing.curve(ax, h, [error.position for error in ours], "LGVI", 0)
    for index, method in enumerate((nbody.LEAPFROG, nbody.WHFAST), start=2):
        drawing.curve(ax, h, [error.position for error in errors(method, "points", e, counts)], method.name, index)
    ax.lines[1].set(markerfacecolor="none", markersize=8)  # around those of LGVI
    pair = orbit("points", e, ba.PointMass())
    apart = [
        difference(methods.RELATIVE.end(*pair, TIME, n), nbody.kick_drift_kick(*pair, TIME, n)).position for n in counts
    ]
    drawing.curve(ax, h, apart, "LGVI minus conjugate leapfrog", 4)
    drawing.slope_line(ax, h, (h[-1], 0.1 * ours[-1].position), 2)
    ax.set_title(f"e = {e:g}, after {ORBITS} orbits", fontsize=10)
    ax.set_ylim(1e-16, 10)


def run(effort: Effort) -> Findings:
    """Run all orbits."""
    checks: list[Check] = []
    figure, panels = drawing.axes(3, xlabel="step [orbits]", ylabel="error in position / distance")
    for ax, e in zip(panels, ECCENTRICITIES, strict=True):
        checks += [*of_limits(e), *of_maps(e), *of_oracles(e), of_orders(e)]
        draw(ax, e)
    drawing.legend(panels[0], loc=(0.4, 0.25))
    caption = (
        "Errors against Kepler's equation for three eccentricities. LGVI and REBOUND's leapfrog have slope 2 and "
        "nearly the same constant. Taken from its own nodes to those of LGVI, the leapfrog is the same map: what is "
        "left is its round-off. For two bodies WHFast is exact and shows its round-off too."
    )
    note = (
        "For points and spheres a step of the variational integrator is a kick, a drift and a kick, and one of "
        "REBOUND's leapfrog a drift, a kick and a drift. The two are conjugate: begun half a kick and half a drift "
        "later, and taken back by as much at the end, the leapfrog is the same map, to round-off. WHFast follows two "
        "bodies exactly at any step, so that against it our error is that against Kepler's equation, whose order is "
        "checked; it is a method of the same order among several bodies (the case `triple`)."
    )
    return Findings(nbody.possible(checks), [Picture("kepler", figure, caption)], [note])


CASE = Case(
    "kepler",
    "Are points and spheres on Kepler orbits where REBOUND's IAS15 has them as the step goes to zero, and is each step "
    "the same map as one of its leapfrog?",
    "REBOUND: IAS15, WHFast and leapfrog, given our G; Kepler's equation",
    run,
    needs=("rebound",),
)
