"""The problems: a system, its start, how long it is followed, and which methods try it."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import astropy.units as u
import numpy as np

import binaryast as ba
from validation.cases.triple import sn263_and_craft
from validation.systems import wobbling_pair

DAY, HOUR = 86400.0, 3600.0
POINTS = "points"  # the problem without attitudes

Make = Callable[[], tuple[ba.System, ba.State]]


@dataclass(frozen=True)
class Sweep:
    """A method of ours with the steps [s] it is tried at."""

    method: str
    make: Callable[[Any], Any]
    steps: Sequence[float]


@dataclass(frozen=True)
class Problem:
    """One problem.

    Attributes
    ----------
    name, title : str
        What the command line calls it, and what it is.
    make : callable
        Returns system and start.
    duration : float
        How long it is followed [s].
    sweeps : sequence of Sweep
        Our methods.
    tolerances : dict
        heyoka's, for its default and its compact mode.
    asked : dict
        Ratios that are asked for, heyoka's CPU time over ours, by kind of error and then by the error.
    """

    name: str
    title: str
    make: Make
    duration: float
    sweeps: Sequence[Sweep]
    tolerances: dict[str, Sequence[float]]
    asked: dict[str, dict[float, float]]

    @property
    def has_attitudes(self) -> bool:
        """Whether the bodies turn."""
        return self.name != POINTS


def steps(longest: float, shortest: float, count: int) -> tuple[float, ...]:
    """Return steps [s] in geometric progression."""
    return tuple(float(step) for step in np.geomspace(longest, shortest, count))


def lgvi(order: int) -> Callable[[Any], Any]:
    """Return the maker of the variational integrator of an order."""
    return lambda step: ba.LGVI(step, order=order)


def splitting(scheme: str) -> Callable[[Any], Any]:
    """Return the maker of a splitting."""
    return lambda step: ba.Splitting(step, scheme=scheme)


def kepler(scheme: str, corrector: bool = False) -> Callable[[Any], Any]:
    """Return the maker of a Kepler splitting."""
    return lambda step: ba.KeplerSplitting(step, scheme=scheme, corrector=corrector)


def of_pairs(unit: float = HOUR, *, bound: bool = True, finer: float = 1.0) -> tuple[Sweep, ...]:
    """Return our methods for pairs with the orbit's twelfth, about an hour for Didymos, as the unit of their steps.

    The shortest steps are ``finer`` for uneven bodies, whose spin they have to resolve.
    """
    short = unit / finer
    orbit = (
        Sweep("Kepler splitting ABA(10,4)", kepler("aba104"), steps(3.5 * unit, 0.1 * short, 13)),
        Sweep("the same, corrected", kepler("aba104", True), steps(3.5 * unit, 0.1 * short, 13)),
        Sweep("Kepler splitting ABA(8,6,4)", kepler("aba864"), steps(2.5 * unit, 0.1 * short, 12)),
        Sweep("Kepler splitting ABA(10,6,4)", kepler("aba1064"), steps(3.5 * unit, 0.12 * short, 12)),
    )
    return (
        *(orbit if bound else ()),
        Sweep("splitting RKN6a", splitting("rkn6a"), steps(3 * short, 0.2 * short, 10)),
        Sweep("splitting SS10", splitting("ss10"), steps(5 * short, 0.35 * short, 12)),
        Sweep("splitting RKN4", splitting("rkn4"), steps(0.7 * unit, 0.1 * unit, 5)),
        Sweep("LGVI, order 2", lgvi(2), steps(0.08 * unit, 0.01 * unit, 3)),
        Sweep("LGVI, order 8", lgvi(8), steps(0.4 * unit, 0.08 * unit, 6)),
        Sweep("LGVI, order 10", lgvi(10), steps(0.7 * unit, 0.15 * short, 7)),
    )


def ellipsoids(degree: int) -> Make:
    """Return the maker of Didymos and Dimorphos, wobbling and librating, at a degree of gravity."""

    def make() -> tuple[ba.System, ba.State]:
        system, state = wobbling_pair()
        return ba.System(system.bodies, gravity=ba.Multipole(degree)), state

    return make


def cloud(axes: Sequence[float], count: int) -> ba.PointCloud:
    """Return equal points in a spiral over an ellipsoid that has about the inertia of a homogeneous one."""
    k = np.arange(count) + 0.5
    height, angle = 1 - 2 * k / count, np.pi * (1 + np.sqrt(5)) * k
    across = np.sqrt(1 - height**2)
    sphere = np.stack([across * np.cos(angle), across * np.sin(angle), height], axis=1)
    return ba.PointCloud(np.sqrt(3 / 5) * sphere * axes * u.m)


def as_clouds(pair: ba.System, count: int) -> list[ba.RigidBody]:
    """Return the bodies of a pair of ellipsoids as clouds of so many points, with the inertia of the ellipsoids."""
    return [
        ba.RigidBody(
            body.name,
            cloud([axis.value for axis in (body.shape.a, body.shape.b, body.shape.c)], count),
            mass=body.mass,
            inertia=body.inertia,
        )
        for body in pair.bodies
    ]


def clouds(count: int) -> Make:
    """Return the maker of the same pair as two clouds of so many points each."""

    def make() -> tuple[ba.System, ba.State]:
        pair, state = wobbling_pair()
        return ba.System(as_clouds(pair, count), gravity=ba.PointPairs()), state

    return make


def eccentric() -> tuple[ba.System, ba.State]:
    """Return the ellipsoids on a wide orbit of e = 0.3, degree 4; the secondary spins fast, or it would be chaotic."""
    pair, _ = wobbling_pair()
    system = ba.System(pair.bodies, gravity=ba.Multipole(4))
    rate = 2 * np.pi / (2.26 * HOUR)
    spins = [[0.06 * rate, 0.06 * rate, rate], [3e-5, -2e-5, 5e-4]] * u.rad / u.s
    state = ba.State.from_elements(
        system, semi_major_axis=1600 * u.m, eccentricity=0.3, inclination=5 * u.deg, spins=list(spins)
    )
    return system, state


def dumbbells() -> tuple[ba.System, ba.State]:
    """Return the paper's dumbbells."""
    system, state = ba.catalogue.load("dumbbells")
    return system, state


TOLERANCES = {"default": (1e-7, 1e-8, 1e-9, 1e-11, 1e-13, 1e-15), "compact": (1e-7, 1e-9, 1e-12, 1e-15)}
OF_CLOUDS = {"default": (1e-7, 1e-8, 1e-9, 1e-11, 1e-14), "compact": (1e-7, 1e-8, 1e-9, 1e-11, 1e-13, 1e-15)}
OF_POINTS = {"default": (1e-4, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13), "compact": (1e-5, 1e-9, 1e-13)}
OF_DEGREE_8 = {"default": (1e-7, 1e-8, 1e-9, 1e-11, 1e-13), "compact": (1e-7, 1e-9, 1e-12, 1e-15)}
EVERYTHING, POSITION = "everything", "position"

PROBLEMS = (
    Problem(
        "degree-2", "Didymos and Dimorphos, ellipsoids, degree 2, 100 d",
        ellipsoids(2), 100 * DAY, of_pairs(), TOLERANCES, {EVERYTHING: {1e-4: 1.8, 1e-6: 0.8}},
    ),
    Problem(
        "degree-4", "Didymos and Dimorphos, ellipsoids, degree 4, 100 d",
        ellipsoids(4), 100 * DAY, of_pairs(), TOLERANCES, {EVERYTHING: {1e-4: 1.8, 1e-6: 1.1}},
    ),
    Problem(
        "degree-8", "Didymos and Dimorphos, ellipsoids, degree 8, 100 d",
        ellipsoids(8), 100 * DAY, of_pairs(), OF_DEGREE_8,
        {EVERYTHING: {1e-4: 4.9, 1e-6: 2.6}, POSITION: {1e-4: 6.0, 1e-6: 4.0}},
    ),
    Problem(
        "pairs-64", "8 x 8 points like Didymos and Dimorphos, 100 d",
        clouds(8), 100 * DAY, of_pairs(finer=2.5), OF_CLOUDS, {},
    ),
    Problem(
        "pairs-256", "16 x 16 points like Didymos and Dimorphos, 100 d",
        clouds(16), 100 * DAY, of_pairs(finer=2.5), OF_CLOUDS,
        {POSITION: {1e-4: 60.0, 1e-6: 40.0, 1e-8: 25.0, 1e-10: 15.0}},
    ),
    Problem(
        "eccentric", "the ellipsoids on a wide orbit of e = 0.3, degree 4, 100 d",
        eccentric, 100 * DAY, of_pairs(), TOLERANCES, {},
    ),
    Problem(
        "dumbbells", "the paper's dumbbells, to t = 15",
        dumbbells, 15.0, of_pairs(0.05, bound=False), TOLERANCES, {},
    ),
    Problem(
        POINTS, "2001 SN263 and a spacecraft as points, 10 d", sn263_and_craft, 10 * DAY,
        (
            Sweep("splitting leapfrog", splitting("leapfrog"), steps(400.0, 10.0, 6)),
            Sweep("splitting RKN4", splitting("rkn4"), steps(4000.0, 200.0, 7)),
            Sweep("splitting RKN6a", splitting("rkn6a"), steps(15000.0, 800.0, 9)),
            Sweep("splitting SS10", splitting("ss10"), steps(30000.0, 2500.0, 9)),
        ),
        OF_POINTS, {},
    ),
)  # fmt: skip
BY_NAME = {problem.name: problem for problem in PROBLEMS}
