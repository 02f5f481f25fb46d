"""Two thin rods as points at Gauss's nodes: point pairs converge to the closed forms exponentially, to round-off.

A rod of constant density is the integral along a line, and a Gauss rule of it is a set of point masses, so that the
gravity of point pairs is the product rule of the double integral.
"""

from collections.abc import Callable
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from validation import drawing
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import potentials
from validation.oracles.potentials import Attraction

ONE, TWO = 1.0, 0.7  # half-lengths [m]
NODES = np.arange(1, 33)
ROUNDING = 1e-13  # an error above it is that of the rule


class Place(NamedTuple):
    """A configuration of the rods, its closed form, and tolerances: of the round-off in the end, of the rate before."""

    name: str
    x: np.ndarray
    attitude: np.ndarray
    exact: Callable[[], Attraction]
    roundoff: float
    rate: float


SKEW = Rotation.from_euler("zyx", [0.5, 0.9, 0.3]).as_matrix()
AT = np.array([0.6, -0.9, 0.8])
PLACES = (
    Place(
        "in one line",
        np.array([2.2, 0.0, 0.0]),
        np.eye(3),
        lambda: potentials.collinear_rods(ONE, TWO, 2.2),
        1.5e-14,
        0.004,
    ),
    Place(
        "side by side",
        np.array([0.4, 0.8, 0.0]),
        np.eye(3),
        lambda: potentials.parallel_rods(ONE, TWO, 0.4, 0.8),
        5e-15,
        0.3,
    ),
    Place("skew", AT, SKEW, lambda: potentials.rod_and_rod(ONE, TWO, AT, SKEW[:, 0]), 4e-15, 0.1),
)


def rod(name: str, half: float, nodes: int, **mass: u.Quantity) -> ba.RigidBody:
    """Return a rod along x as points at Gauss's nodes.

    Points in a line have no moment of inertia about it. None of the moments matters here.
    """
    s, weights = np.polynomial.legendre.leggauss(nodes)
    points = np.outer(s, [half, 0, 0]) * u.m
    return ba.RigidBody(name, ba.PointCloud(points, weights), inertia=[0.1, 1, 1] * u.kg * u.m**2, **mass)


def computed(place: Place, nodes: int) -> Attraction:
    """Return what the package says, for G m1 m2 = 1."""
    one = rod("one", ONE, nodes, gm=1 * u.m**3 / u.s**2)
    two = rod("two", TWO, nodes, mass=1 * u.kg)
    found = ba.System([one, two], gravity=ba.PointPairs()).mutual_gravity(place.x * u.m, place.attitude)
    return Attraction(found.energy.value, found.gradient.value, found.moment.value)


def errors(place: Place) -> np.ndarray:
    """Return the errors (nodes, quantity) of U, dU/dX and M: of the first two relative, of M over U."""
    exact = place.exact()
    scales = np.array([abs(exact.energy), np.linalg.norm(exact.gradient), abs(exact.energy)])
    found = [computed(place, int(n)) for n in NODES]
    return (
        np.array([[np.linalg.norm(np.subtract(a, b)) for a, b in zip(f, exact, strict=True)] for f in found]) / scales
    )


def rate(place: Place) -> float:
    """Return the factor that one more node takes from the error: rho^2, by where the potential is singular.

    The integrand along one rod is singular where its line, made complex, meets a point of the other one: z = distance
    along it + i distance across, in half-lengths. A Gauss rule of n nodes errs by rho^(-2n), rho = |z + sqrt(z^2 - 1)|
    being that of the nearest such point's ellipse.
    """
    smallest = np.inf
    for half, other, x, axis in (
        (ONE, TWO, place.x, place.attitude[:, 0]),
        (TWO, ONE, -place.attitude.T @ place.x, place.attitude.T[:, 0]),
    ):
        points = x + np.linspace(-other, other, 2001)[:, None] * axis
        z = (points[:, 0] + 1j * np.hypot(points[:, 1], points[:, 2])) / half
        root = np.sqrt(z * z - 1)
        smallest = min(smallest, np.maximum(np.abs(z + root), np.abs(z - root)).min())
    return float(smallest**2)


def rate_found(found: np.ndarray) -> float:
    """Return the factor by which an error falls with a node, from the last six nodes before round-off."""
    last = np.flatnonzero(found > ROUNDING)[-6:]
    return float(np.exp(-np.polyfit(NODES[last], np.log(found[last]), 1)[0]))


def checks_of(place: Place, found: np.ndarray) -> list[Check]:
    """Return the checks of a configuration."""
    factor = rate_found(found[:, 1])
    return [
        Check(
            f"{place.name}: U, dU/dX and M from 24 nodes on: the largest error",
            found[NODES >= 24].max(),
            place.roundoff,
            "rounding, most of it of the nodes and weights of the rule",
            headline=place.name != "skew",
            roundoff=True,
        ),
        Check(
            f"{place.name}: the factor by which a node takes off the error of dU/dX, over rho^2",
            factor / rate(place) - 1,
            place.rate,
            "a power of the number of nodes beside rho^(-2 n): none where two ends are nearest, of a singularity that "
            "the other rod spreads where the rods pass each other",
            shown=f"{factor:.3f}, rho^2 {rate(place):.3f}",
        ),
    ]


def run(effort: Effort) -> Findings:
    """Refine the rules."""
    found = [errors(place) for place in PLACES]
    checks = [check for place, one in zip(PLACES, found, strict=True) for check in checks_of(place, one)]
    return Findings(checks, [picture(found)])


def picture(found: list[np.ndarray]) -> Picture:
    """Draw the errors against the number of nodes."""
    figure, panels = drawing.axes(len(PLACES), xlabel="nodes on each rod", yscale="log", ylim=(1e-17, 3))
    for ax, place, one in zip(panels, PLACES, found, strict=True):
        ax.set(title=place.name, ylabel="error over |U|, |dU/dX|, |U|")
        for k, name in enumerate(("U", "dU/dX", "M")):
            shown = one[:, k] > 0
            if shown.any():
                drawing.curve(ax, NODES[shown], one[shown, k], name, k, log=False)
        line = rate(place) ** -NODES.astype(float)
        kept = line > 1e-17
        ax.plot(NODES[kept], line[kept], "--", color="#333333", lw=0.9, label="rho^(-2n)")
        drawing.legend(ax)
    caption = (
        "Two rods as points at Gauss's nodes: errors of U, dU/dX and M against the number of nodes. They fall by rho² "
        "with each node, as the theory of Gauss's rules says from where the integrand is singular, down to round-off."
    )
    return Picture("two-rods", figure, caption)


CASE = Case(
    "two-rods",
    "Do point pairs at Gauss's nodes converge to the closed forms of two rods, at the rate that theory says?",
    "closed forms by logarithms; for skew rods a numerical integral of one rod's closed field",
    run,
    needs=("scipy",),
)
