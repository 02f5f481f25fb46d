"""What a series cut at a degree leaves out of the gravity of a pair of ellipsoids, held against closed forms."""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import astropy.units as u
import numpy as np

import binaryast as ba
from binaryast.gravity import Gravity
from validation import drawing, fitting, methods
from validation.case import Check, Picture
from validation.oracles import potentials
from validation.oracles.potentials import Attraction

QUANTITIES = ("U", "dU/dX", "M")


class Model(NamedTuple):
    """A model of gravity under test, exact up to a total degree."""

    name: str
    gravity: Gravity
    degree: int

    @property
    def powers(self) -> tuple[int, int, int]:
        """By which powers of size/r the relative errors of U, dU/dX and M fall: ellipsoids have even degrees only."""
        return (self.degree + 2, self.degree + 2, self.degree)


SECOND = Model("second degree", ba.SecondDegree(), 2)
MULTIPOLES = tuple(Model(f"degree {degree}", ba.Multipole(degree), degree) for degree in (4, 6, 8))
MODELS = (SECOND, MULTIPOLES[0])  # whose errors are well above round-off at all distances


class Pair(NamedTuple):
    """Two ellipsoids, the secondary with an attitude, and the line on which they are drawn apart.

    ``exact`` gives the closed form at X for G m1 m2 = 1; an ellipsoid without size stands for a sphere.
    """

    name: str
    primary: np.ndarray
    secondary: np.ndarray
    attitude: np.ndarray
    towards: np.ndarray
    distances: np.ndarray
    exact: Callable[[np.ndarray], Attraction]

    def at(self, distance: float) -> np.ndarray:
        """Return X at a distance."""
        return self.towards / np.linalg.norm(self.towards) * distance

    def fourth(self, x: np.ndarray) -> Attraction:
        """Return the terms of degree 4 in closed form."""
        return potentials.fourth_degree(self.primary, self.secondary, x, self.attitude)

    def computed(self, gravity: Gravity, x: np.ndarray) -> Attraction:
        """Return what the package says."""
        found = system(self.primary, self.secondary, gravity).mutual_gravity(x * u.m, self.attitude)
        return Attraction(found.energy.value, found.gradient.value, found.moment.value)


def system(primary: np.ndarray, secondary: np.ndarray, gravity: Gravity) -> ba.System:
    """Return two ellipsoids with G m1 m2 = 1 by their semi-axes [m], a sphere where these are zero."""
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(*(axes * u.m)) if np.any(axes) else ba.Sphere(1 * u.mm), **mass)
        for name, axes, mass in (("one", primary, {"gm": 1 * u.m**3 / u.s**2}), ("two", secondary, {"mass": 1 * u.kg}))
    ]
    return ba.System(bodies, gravity=gravity)


def apart(one: Attraction, two: Attraction) -> np.ndarray:
    """Return how far U, dU/dX and M are apart, relative to the second."""
    pairs = zip(one, two, strict=True)
    return np.array([np.linalg.norm(np.subtract(a, b)) / np.linalg.norm(b) for a, b in pairs])


def plus(one: Attraction, two: Attraction) -> Attraction:
    """Return the sum."""
    return Attraction(*(a + b for a, b in zip(one, two, strict=True)))


def errors(pair: Pair, model: Model) -> np.ndarray:
    """Return the relative errors of a model (distance, quantity)."""
    return np.array([apart(pair.computed(model.gravity, pair.at(r)), pair.exact(pair.at(r))) for r in pair.distances])


def shares(pair: Pair, x: np.ndarray) -> np.ndarray:
    """Return what second degree lacks in units of the terms of degree 4, to which it tends with distance."""
    triples = zip(pair.exact(x), pair.computed(SECOND.gravity, x), pair.fourth(x), strict=True)
    return np.array([np.dot(np.subtract(a, b), c) / np.dot(c, c) for a, b, c in triples])


def limit_checks(pair: Pair, tolerances: Sequence[float], why: str) -> list[Check]:
    """Return the checks that what second degree lacks is degree 4, extrapolated to an infinite distance."""
    limits = fitting.to_zero([shares(pair, pair.at(r)) for r in pair.distances])
    return [
        Check(
            f"second degree: what it lacks in {quantity}, over degree 4 in closed form, for r -> infinity",
            share - 1,
            tolerance,
            why,
            shown=f"1 {share - 1:+.1e}",
            roundoff=True,
        )
        for quantity, share, tolerance in zip(QUANTITIES, limits, tolerances, strict=True)
    ]


def slope_checks(pair: Pair, tolerance: float) -> list[Check]:
    """Return the checks of the powers by which the errors of each model fall, and fall once degree 4 is added."""
    checks = []
    for name, powers, found in series(pair, MODELS):
        slopes = np.array([-methods.slope(pair.distances, column) for column in found.T])
        checks.append(
            Check(
                f"{name}: relative errors of U, dU/dX and M fall with distance by the powers {powers}",
                float(np.abs(slopes - powers).max()),
                tolerance,
                "the next degree, two higher, adds its part, (size/r)^2 of it at the three largest distances",
                shown=", ".join(f"{slope:.4f}" for slope in slopes),
                headline=name == SECOND.name,
            )
        )
    return checks


def series(pair: Pair, models: Sequence[Model]) -> list[tuple[str, tuple[int, int, int], np.ndarray]]:
    """Return name, powers and errors of models, and of second degree with degree 4 in closed form added."""
    found = [(model.name, model.powers, errors(pair, model)) for model in models]
    sums = [plus(pair.computed(SECOND.gravity, x), pair.fourth(x)) for x in map(pair.at, pair.distances)]
    left = [apart(total, pair.exact(pair.at(r))) for total, r in zip(sums, pair.distances, strict=True)]
    return [*found, ("with degree 4 in closed form", (6, 6, 4), np.array(left))]


def picture(pair: Pair, caption: str) -> Picture:
    """Draw all these errors against distance."""
    figure, panels = drawing.axes(3, xlabel="distance r [m]")
    for k, (ax, quantity) in enumerate(zip(panels, QUANTITIES, strict=True)):
        ax.set(ylabel=f"relative error of {quantity}")
        for i, (name, powers, found) in enumerate(series(pair, (SECOND, *MULTIPOLES))[:-1]):
            drawing.curve(ax, pair.distances, found[:, k], name, i)
            above = np.flatnonzero(found[:, k] > 1e-11)[-1]  # round-off
            through = pair.distances[above], found[above, k]
            drawing.slope_line(ax, pair.distances, through, -powers[k], f"slope -{powers[k]}")
        ax.set_ylim(bottom=1e-17)
        ax.set_xticks(pair.distances, [f"{r:g}" for r in pair.distances])
        ax.set_xticks([], minor=True)
        drawing.legend(ax)
    return Picture(pair.name, figure, caption)
