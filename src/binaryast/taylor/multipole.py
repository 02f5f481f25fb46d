"""The mutual potential of two bodies by their moments, in a form whose derivatives by time are cheap.

    U = -G m1 m2 sum over l, m of Re conj(c_lm) G_lm,  G_lm = sum over k, n of conj(d_kn) S_(l + k)(m + n),  l + k <= N,

over orders of both signs. Here d are the primary's specific moments of the harmonics of ``kernels/harmonics.py``, c the
secondary's times (-1)^l *in the primary's axes*, and S_LM = (L - M)! P_LM e^(i M phi)/r^(L + 1) the harmonics of X that
vanish far away. In these axes d are constants, so that a G is a sum without products of variables. And c are not made
of the attitude: they are variables of the motion, carried round by the relative spin, at the cost of three products
each, like any figure of a rigid body. What is left is a product for each moment of the secondary and each component of
force and torque. Nothing is singular in any direction, as it would be in axes along X.

A moment is a pair of numbers, its real and imaginary part; those of order -m are (-1)^m conj of those of m. Of a body,
degree by degree, they lie in a table, with None for a degree that vanishes.
"""

from collections.abc import Sequence
from typing import NamedTuple, TypeAlias

from binaryast.taylor.vectors import Number, Numbers, dot

Complex: TypeAlias = tuple[Number, Number]
Table: TypeAlias = Sequence[Sequence[Complex] | None]


class Attraction(NamedTuple):
    """U, dU/dX (3) and M (3) of a pair, over G m1 m2."""

    energy: Number
    gradient: Numbers
    moment: Numbers


def of_order(numbers: Sequence[Complex], m: int) -> Complex:
    """Return what a degree has at an order of either sign, zero beyond the degree."""
    if abs(m) >= len(numbers):
        return 0.0, 0.0
    re, im = numbers[abs(m)]
    if m >= 0:
        return re, im
    return (re, -im) if m % 2 == 0 else (-re, im)


class Irregular:
    """The harmonics S_LM of X, each made when it is first asked for.

    S_MM = (2M - 1) (x + iy)/r^2 S_(M-1)(M-1) and S_(L+1)M = ((2L + 1) z S_LM - (L^2 - M^2) S_(L-1)M)/r^2.
    """

    def __init__(self, x: Numbers) -> None:
        inverse = (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]) ** -0.5
        self.inverse_square = inverse * inverse
        self.x, self.y, self.z = (component * self.inverse_square for component in x)
        self.degrees: list[list[Complex]] = [[(inverse, 0.0)]]

    def at(self, l: int, m: int) -> Complex:
        """Return S_lm for an order of either sign."""
        while len(self.degrees) <= l:
            self._add()
        return of_order(self.degrees[l], m)

    def _add(self) -> None:
        """Make the next degree from the two before."""
        l = len(self.degrees)
        last = self.degrees[-1]
        before = self.degrees[-2] if l > 1 else []
        new: list[Complex] = []
        for m, (re, im) in enumerate(last):
            up, down = 2.0 * l - 1.0, float((l - 1) ** 2 - m * m)
            a, b = of_order(before, m)
            real = up * (self.z * re) - down * (self.inverse_square * a)
            new.append((real, up * (self.z * im) - down * (self.inverse_square * b) if m else 0.0))
        re, im = last[-1]
        factor = 2.0 * l - 1.0
        new.append((factor * (self.x * re - self.y * im), factor * (self.x * im + self.y * re)))
        self.degrees.append(new)


def field(s: Irregular, l: int, m: int, primary: Table, degree: int) -> Complex:
    """Return the sum over k <= degree and n of conj(d_kn) S_(l + k)(m + n)."""
    re, im = 0.0, 0.0
    for k, moments in enumerate(primary[: degree + 1]):
        for n in range(-k, k + 1) if moments else ():
            a, b = of_order(moments or (), n)
            p, q = s.at(l + k, m + n)
            re, im = re + (a * p + b * q), im + (a * q - b * p)
    return re, im


def turned(numbers: Sequence[Complex], m: int) -> tuple[Complex, Complex, Complex]:
    """Return how c_lm of a body changes as it is turned about x, y and z: the integrals of (rho x d/drho) R_lm.

    About z it is i m c_lm, about x + iy and x - iy it is -i (l + m + 1) c_l(m+1) and -i (l - m + 1) c_l(m-1).
    """
    l = len(numbers) - 1
    up, down = 0.5 * (l + m + 1), 0.5 * (l - m + 1)
    (a, b), (c, d), (re, im) = of_order(numbers, m + 1), of_order(numbers, m - 1), numbers[m]
    if m == 0:
        return (2.0 * up * b, 0.0), (-2.0 * up * a, 0.0), (0.0, 0.0)
    return (
        (up * b + down * d, -up * a - down * c),
        (down * c - up * a, down * d - up * b),
        (-float(m) * im, float(m) * re),
    )


def rates(secondary: Table, spin: Numbers) -> list[Number]:
    """Return the rates of the secondary's moments in the primary's axes, given its spin relative to these, in them.

    They are in the order of `independent`.
    """
    result: list[Number] = []
    for numbers in secondary[1:]:
        for m in range(len(numbers or ())):
            x, y, z = turned(numbers or (), m)
            result += [dot(spin, (x[part], y[part], z[part])) for part in range(2 if m else 1)]
    return result


def independent(table: Table) -> list[Number]:
    """Return the numbers of a table that can change: all but the mass and the imaginary parts of order 0."""
    return [
        part
        for numbers in table[1:]
        for m, moment in enumerate(numbers or ())
        for part in (moment if m else moment[:1])
    ]


def of_independent(pattern: Table, values: Numbers) -> Table:
    """Return the table of numbers in the order of `independent`, with the degrees that a pattern has."""
    left = iter(values)
    return [
        numbers if not numbers or l == 0 else [(next(left), next(left) if m else 0.0) for m in range(l + 1)]
        for l, numbers in enumerate(pattern)
    ]


def attraction(secondary: Table, primary: Table, degree: int, x: Numbers) -> Attraction:
    """Return what moments exert up to a total degree, from X and both tables in the primary's axes.

    dS_LM/dz = -S_(L+1)M, and S_LM by x + iy and x - iy is -S_(L+1)(M+1) and S_(L+1)(M-1).
    """
    s = Irregular(x)
    energy: Number = 0.0
    gradient: Numbers = [0.0, 0.0, 0.0]
    moment: Numbers = [0.0, 0.0, 0.0]
    for l, numbers in enumerate(secondary):
        for m in range(l + 1) if numbers else ():
            weight = 2.0 if m else 1.0
            at = field(s, l, m, primary, degree - l)
            low, middle, high = (field(s, l + 1, m + step, primary, degree - l) for step in (-1, 0, 1))
            slopes = (
                (0.5 * (low[0] - high[0]), 0.5 * (low[1] - high[1])),
                (-0.5 * (low[1] + high[1]), 0.5 * (low[0] + high[0])),
                (-middle[0], -middle[1]),
            )
            here = (numbers or ())[m]
            energy = energy - weight * along(here, at)
            gradient = [g - weight * along(here, slope) for g, slope in zip(gradient, slopes, strict=True)]
            turns = turned(numbers or (), m)
            moment = [t - weight * along(turn, at) for t, turn in zip(moment, turns, strict=True)]
    return Attraction(energy, gradient, moment)


def along(a: Complex, b: Complex) -> Number:
    """Return Re conj(a) b."""
    return a[0] * b[0] + a[1] * b[1]
