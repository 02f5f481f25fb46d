"""Shapes of which only the mass moments are known: inertia integrals, or the coefficients of a gravity field."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.kernels.harmonics import factorials, monomial_moments
from binaryast.kernels.moments import count, exponents, moved, second_degree, specific_inertia
from binaryast.shapes import Shape
from binaryast.units import Floats, brief, numbers, quantity, to_si

AGREEMENT = 1e-6  # how far inertia= may be, over its trace, from what the coefficients of degree 2 say


class GivenMoments(Shape):
    """What shapes of given moments have in common: no surface, no volume, and an end of what is known.

    Attributes
    ----------
    degree : int
        Up to which degree the moments are given.
    """

    degree: int
    _values: Floats

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids: none."""
        return []

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`; InputError beyond what is given."""
        if degree > self.degree:
            raise InputError(
                f"{type(self).__name__}: moments of degree {degree} are asked for, and given up to {self.degree}: "
                "give gravity a lower degree, or more moments, zeros if they are to be left out"
            )
        return moved(self._values[: count(degree)], degree, origin, turn)

    def __repr__(self) -> str:
        return f"{type(self).__name__}(degree {self.degree})"


@dataclass(frozen=True, eq=False, repr=False)
class InertiaIntegrals(GivenMoments):
    """A body of which the inertia integrals T_ijk are given: those of x^i y^j z^k dm over its mass.

    Their size does not matter, for the mass is the body's: T_000 is it, in the units of the table. A body of this shape
    has no surface: it never touches anything.

    Parameters
    ----------
    table : array-like
        T_ijk up to a degree N >= 2, as T[i, j, k] of shape (N + 1, N + 1, N + 1), or with those of each k below each
        other, ((N + 1)^2, N + 1): row k (N + 1) + i, column j, as GUBAS writes them. Elements above degree N must be
        finite, and are otherwise ignored.
    length : Quantity
        The unit of length of the table, such as ``1 * u.km``.

    Raises
    ------
    InputError
        For another shape, values that are not finite, or a mass that is not positive.

    References
    ----------
    A. B. Davis, D. J. Scheeres, Icarus 341 (2020) 113439, for the integrals.

    Examples
    --------
    >>> import astropy.units as u
    >>> import numpy as np
    >>> import binaryast as ba
    >>> table = np.zeros((3, 3, 3))
    >>> table[0, 0, 0], table[2, 0, 0], table[0, 2, 0], table[0, 0, 2] = 10, 50, 32, 18
    >>> print(ba.RigidBody("A", ba.InertiaIntegrals(table, 1 * u.m), mass=10 * u.kg).inertia.value)  # kg m2
    [50. 68. 82.]
    """

    table: Any
    length: Quantity

    def __post_init__(self) -> None:
        name = "InertiaIntegrals"
        length = float(to_si(self.length, "m", f"{name}: length", sign="positive"))
        try:
            shape = np.shape(self.table)
        except ValueError:  # rows of different lengths
            shape = ()
        size = shape[-1] if shape else 0
        if size < 3 or shape not in ((size, size, size), (size * size, size)):
            raise InputError(
                f"{name}: table: expected shape (N + 1, N + 1, N + 1) or ((N + 1)^2, N + 1) with N >= 2, got {shape}"
            )
        table = numbers(self.table, f"{name}: table", shape)
        slices = table if len(shape) == 3 else table.reshape(size, size, size).transpose(1, 2, 0)
        if slices[0, 0, 0] <= 0:
            raise InputError(f"{name}: table: T_000 is the mass: expected a positive value, got {slices[0, 0, 0]:g}")
        i, j, k = exponents(size - 1).T
        values = slices[i, j, k] / slices[0, 0, 0] * length ** (i + j + k)
        self._set(
            table=table,
            length=quantity(length, "m"),
            degree=size - 1,
            centre=values[1:4].copy(),
            specific_inertia=specific_inertia(second_degree(moved(values[:10], 2, values[1:4], np.eye(3)))),
            _values=values,
        )


@dataclass(frozen=True, eq=False, repr=False)
class StokesCoefficients(GivenMoments):
    """A body whose gravity field is given by its Stokes coefficients.

    The field is V = (G m/r) sum (a/r)^l P_lm(sin latitude) (C_lm cos(m longitude) + S_lm sin(m longitude)), in the
    shape's frame. It does not fix the trace of the inertia, for homogeneous spheres of all sizes have one field: a
    `RigidBody` of this shape needs ``inertia=``, of which the trace is taken; the rest has to agree with the
    coefficients of degree 2. A body of this shape has no surface: it never touches anything.

    Parameters
    ----------
    C, S : array-like
        C_lm and S_lm at [l][m], both (N + 1, N + 1) with N >= 2; what lies beyond m = l must be finite, and is
        otherwise ignored. C_00 is 1.
    reference_radius : Quantity
        a (length).
    normalised : bool
        Whether they belong to fully normalised functions (4 pi, as in geodesy): the plain coefficient is the normalised
        one times sqrt((2 - delta_m0) (2l + 1) (l - m)!/(l + m)!).
    condon_shortley : bool
        Whether P_lm has the sign (-1)^m of Condon and Shortley; in geodesy it has not.

    Raises
    ------
    InputError
        For other shapes, values that are not finite, or C_00 other than 1.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> C, S = [[1, 0, 0], [0, 0, 0], [-0.05, 0, 0.01]], [[0, 0, 0]] * 3
    >>> field = ba.StokesCoefficients(C, S, 100 * u.m, normalised=False)
    >>> body = ba.RigidBody("A", field, mass=1 * u.kg, inertia=[3800, 4200, 4500] * u.kg * u.m**2)
    >>> print(body.inertia.value)  # kg m2
    [3800. 4200. 4500.]
    """

    C: Any
    S: Any
    reference_radius: Quantity
    normalised: bool
    condon_shortley: bool = False

    def __post_init__(self) -> None:
        name = "StokesCoefficients"
        radius = float(to_si(self.reference_radius, "m", f"{name}: reference_radius", sign="positive"))
        size = len(self.C) if isinstance(self.C, (list, tuple, np.ndarray)) else 0
        if size < 3:
            raise InputError(f"{name}: C: expected an array of shape (N + 1, N + 1) with N >= 2, got {brief(self.C)}")
        c, s = (numbers(part, f"{name}: {key}", (size, size)) for key, part in (("C", self.C), ("S", self.S)))
        for key, flag in (("normalised", self.normalised), ("condon_shortley", self.condon_shortley)):
            if not isinstance(flag, (bool, np.bool_)):
                raise InputError(f"{name}: {key}: expected True or False, got {brief(flag)}")
        if c[0, 0] != 1:
            raise InputError(f"{name}: C[0][0]: the mass is the body's: expected 1, got {c[0, 0]:g}")
        degree = size - 1
        factors = self._factors(degree, radius)
        l, m = np.tril_indices(size)
        values = monomial_moments(factors * c[l, m], factors * s[l, m], degree)
        self._set(
            C=c,
            S=s,
            reference_radius=quantity(radius, "m"),
            normalised=bool(self.normalised),
            condon_shortley=bool(self.condon_shortley),
            degree=degree,
            centre=values[1:4].copy(),
            trace_is_known=False,
            _values=values,
        )

        inertia = specific_inertia(second_degree(self.moments(2, self.centre, np.eye(3))))
        self._set(specific_inertia=inertia - np.trace(inertia) / 3 * np.eye(3))

    def _factors(self, degree: int, radius: float) -> Floats:
        """Return what makes the moments of the harmonics R_lm = r^l P_lm e^(i m phi)/(l + m)! of coefficients.

        The plain coefficient is (2 - delta_m0) (l - m)! a^-l times the moment.
        """
        l, m = np.tril_indices(degree + 1)
        ways = np.where(m > 0, 2.0, 1.0)
        factors = radius**l / (ways * factorials(l - m))
        if self.normalised:
            factors = factors * np.sqrt(ways * (2 * l + 1) * factorials(l - m) / factorials(l + m))
        return np.asarray(factors * (-1.0) ** m if self.condon_shortley else factors)

    def completed_inertia(self, given: Floats, mass: float, where: str) -> Floats:
        """Return the inertia matrix (3, 3) [kg m2] of the given one's trace and the coefficients of degree 2."""
        trace = float(np.trace(given))
        result = (trace / 3) * np.eye(3) + mass * self.specific_inertia
        if np.abs(result - given).max() > AGREEMENT * trace:
            turned = (
                not np.any(given - np.diag(np.diag(given))) and np.abs(np.triu(result, 1)).max() > AGREEMENT * trace
            )
            raise InputError(
                f"{where}: it does not agree with the coefficients of degree 2, which with this trace make "
                f"{_elements(result)} kg m2, got {_elements(given)}"
                + ("; three moments are about the shape's axes: give the matrix" if turned else "")
            )
        return np.asarray(result)


def _elements(matrix: Floats) -> str:
    """Return the six elements of a symmetric matrix (3, 3) as text."""
    names = ("xx", "xy", "xz", "yy", "yz", "zz")
    values = matrix[np.triu_indices(3)].tolist()
    return ", ".join(f"{name} {value:.9g}" for name, value in zip(names, values, strict=True))
