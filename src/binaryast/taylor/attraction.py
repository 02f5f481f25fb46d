"""The gravity of a pair as a formula, made of the parameters that its compiled potential has.

Lengths are over a unit of length, and what is exerted over G m1 m2.
"""

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from math import factorial, sqrt
from typing import TypeAlias

import numpy as np

from binaryast.errors import InputError
from binaryast.gravity import Multipole, PointMass, PointPairs, SecondDegree
from binaryast.kernels.harmonics import harmonic_moments, monomial_moments, place
from binaryast.kernels.moments import moved
from binaryast.kernels.mutual.multipole_parameters import C_1, C_2, S_1, S_2
from binaryast.system import Pair, System
from binaryast.taylor import multipole, points
from binaryast.taylor.multipole import Attraction, Table
from binaryast.taylor.vectors import Number, Numbers
from binaryast.units import Floats

Constant: TypeAlias = Callable[[float], Number]  # what stands for a constant in a formula
MOST_POINT_PAIRS = 4096  # beyond, a formula takes longer to compile than it is worth


class Formula(ABC):
    """The gravity of a pair.

    Attributes
    ----------
    strength : float
        G m1 m2 [m3 kg/s2].
    """

    strength: float

    @abstractmethod
    def carried(self, r: Floats) -> list[float]:
        """Return what the relative spin carries round, at an attitude R (3, 3)."""

    @abstractmethod
    def rates(self, carried: Numbers, spin: Numbers) -> list[Number]:
        """Return the rates of that, from the relative spin R Omega1 - Omega2, in the primary's axes."""

    @abstractmethod
    def attraction(self, x: Numbers, r: Numbers, carried: Numbers, constant: Constant) -> Attraction:
        """Return what the pair exerts, from X (3), R (9) and what is carried."""


class OfMoments(Formula):
    """Moments of both bodies up to a total degree; of degree 0 two points.

    The secondary's moments are variables, so they are over units of their own, one for each degree: such that the same
    error of any variable turns the body as far.
    """

    def __init__(self, strength: float, secondary: Table, primary: Table, units: Sequence[float]) -> None:
        self.strength, self.secondary, self.primary, self.units = strength, secondary, primary, units
        self.degree = len(secondary) - 1

    def carried(self, r: Floats) -> list[float]:
        """Return the secondary's moments in the primary's axes, degree by degree."""
        size = place(self.degree + 1, 0)
        c: Floats = np.zeros(size)
        s: Floats = np.zeros(size)
        for l, numbers in enumerate(self.secondary):
            for m, moment in enumerate(numbers or ()):
                c[place(l, m)], s[place(l, m)] = moment
        monomials = monomial_moments(c, s, self.degree)
        c, s = harmonic_moments(moved(monomials, self.degree, np.zeros(3), r.T), self.degree)
        table = table_of(c, s, self.degree)
        kept = [
            old and [(re / unit, im / unit) for re, im in new or ()]
            for new, old, unit in zip(table, self.secondary, self.units, strict=True)
        ]
        return [float(value) for value in multipole.independent(kept)]

    def rates(self, carried: Numbers, spin: Numbers) -> list[Number]:
        """Return the rates of these moments."""
        return multipole.rates(multipole.of_independent(self.secondary, carried), spin)

    def attraction(self, x: Numbers, r: Numbers, carried: Numbers, constant: Constant) -> Attraction:
        """Return what the pair exerts."""
        secondary = []
        for numbers, unit in zip(multipole.of_independent(self.secondary, carried), self.units, strict=True):
            scale = constant(unit) if numbers and unit != 1.0 else 1.0
            secondary.append(numbers and [(scale * re, scale * im) for re, im in numbers])
        primary = [numbers and [(constant(c), constant(s)) for c, s in numbers] for numbers in self.primary]
        return multipole.attraction(secondary, primary, self.degree, x)


class OfPoints(Formula):
    """Every point of one body and every point of the other."""

    def __init__(self, strength: float, secondary: points.Points, primary: points.Points) -> None:
        self.strength, self.secondary, self.primary = strength, secondary, primary

    def carried(self, r: Floats) -> list[float]:
        """Return nothing: points are turned by the attitude itself."""
        return []

    def rates(self, carried: Numbers, spin: Numbers) -> list[Number]:
        """Return nothing."""
        return []

    def attraction(self, x: Numbers, r: Numbers, carried: Numbers, constant: Constant) -> Attraction:
        """Return what the pair exerts."""
        secondary, primary = (
            [(constant(fraction), [constant(value) for value in rho]) for fraction, rho in body]
            for body in (self.secondary, self.primary)
        )
        return points.attraction(secondary, primary, x, r)


def formula_of(system: System, pair: Pair, length: float) -> Formula:
    """Return the gravity of a pair, in a unit of length [m].

    Raises
    ------
    InputError
        For a gravity that is not one of those that can be written as a formula, or is too long as such.
    """
    kinds: dict[type, Callable[[System, Pair, float], Formula]] = {
        PointMass: _point_mass,
        SecondDegree: _second_degree,
        Multipole: _multipole,
        PointPairs: _point_pairs,
    }
    kind = kinds.get(type(pair.gravity))
    if kind is None:
        raise InputError(
            f"Taylor: {type(pair.gravity).__name__} between {system.names[pair.primary]} and "
            f"{system.names[pair.secondary]} cannot be written as a formula: expected ba.PointMass, ba.PointPairs, "
            "ba.SecondDegree or ba.Multipole; for any gravity there is ba.RungeKutta"
        )
    return kind(system, pair, length)


def _units(system: System, pair: Pair, length: float, degree: int) -> list[float]:
    """Return the units of the secondary's moments: I a^(l - 2)/l!, where a is the distance at which both may touch.

    At a distance a, a torque of degree l is of order l!/a^(l + 1) times moments, and turns the body the more the less
    its moment of inertia I is. A body without a surface is taken to have the size that its I says.
    """
    one, two = system.bodies[pair.secondary], system.bodies[pair.primary]
    inertia = float(np.mean(one.si.moments)) / one.si.mass / length**2
    if inertia == 0:  # a point
        return [1.0] * (degree + 1)
    reach = max((one.bounding_radius + two.bounding_radius) / length, sqrt(inertia))
    return [1.0, 1.0, *(power_of_two(inertia * reach ** (l - 2) / factorial(l)) for l in range(2, degree + 1))]


def power_of_two(value: float) -> float:
    """Return the power of two nearest to a number: as a unit, it rounds nothing."""
    return float(2.0 ** np.round(np.log2(value)))


def _point_mass(_: System, pair: Pair, __: float) -> Formula:
    return OfMoments(float(pair.parameters[0]), [[(1.0, 0.0)]], [[(1.0, 0.0)]], [1.0])


def _second_degree(system: System, pair: Pair, length: float) -> Formula:
    """Return that of moments of inertia: c_20 = (A + B - 2C)/(4 m), c_22 = (B - A)/(8 m)."""
    strength = float(pair.parameters[0])
    tables = []
    for a, b, c in pair.parameters[1:].reshape(2, 3) / strength / length**2:
        numbers = [(float(a + b - 2 * c) / 4, 0.0), (0.0, 0.0), (float(b - a) / 8, 0.0)]
        tables.append([[(1.0, 0.0)], None, numbers if a != b or a != c else None])
    return OfMoments(strength, tables[0], tables[1], _units(system, pair, length, 2))


def _multipole(system: System, pair: Pair, length: float) -> Formula:
    degree = pair.gravity.cut_at or 0
    places = pair.parameters[1:].reshape(-1, 4)
    unit = np.repeat([float(length) ** l for l in range(2, degree + 1)], np.arange(3, degree + 2))
    first = np.array([1.0, 0.0, 0.0])  # degrees 0 and 1
    none = np.zeros(3)
    tables = [
        table_of(np.concatenate([first, places[:, c] / unit]), np.concatenate([none, places[:, s] / unit]), degree)
        for c, s in ((C_1, S_1), (C_2, S_2))
    ]
    return OfMoments(float(pair.parameters[0]), tables[0], tables[1], _units(system, pair, length, degree))


def table_of(c: Floats, s: Floats, degree: int) -> Table:
    """Return the table of moments from their real and imaginary parts, degree by degree."""
    result: list[list[tuple[float, float]] | None] = []
    for l in range(degree + 1):
        part = slice(place(l, 0), place(l + 1, 0))
        vanishes = not np.any(c[part]) and not np.any(s[part])
        result.append(None if vanishes else list(zip(c[part].tolist(), s[part].tolist(), strict=True)))
    return result


def _point_pairs(_: System, pair: Pair, length: float) -> Formula:
    n1, n2 = (int(count) for count in pair.parameters[:2])
    if n1 * n2 > MOST_POINT_PAIRS:
        raise InputError(
            f"Taylor: PointPairs of {n1} x {n2} points: expected at most {MOST_POINT_PAIRS} pairs of points, which are "
            "long enough a formula: take fewer points, ba.Multipole, or ba.LGVI"
        )
    one, two = np.split(pair.parameters[2:], [4 * n1])
    return OfPoints(one[3 * n1 :].sum() * two[3 * n2 :].sum(), _points(one, length), _points(two, length))


def _points(flat: Floats, length: float) -> points.Points:
    """Return fractions of the mass and places, from x, y, z and masses, each contiguous."""
    *places, masses = flat.reshape(4, -1)
    rows = np.array(places).T / length
    return list(zip((masses / masses.sum()).tolist(), rows.tolist(), strict=True))
