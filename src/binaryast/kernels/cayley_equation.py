"""The implicit equation of the rotation in principal axes and Cayley coordinates, where it is a polynomial.

With F = cay(c), the rotation by 2 atan|c| about c, (128) is 2 (J c + c x J c) = (1 + c.c) g, three quadratic equations:
c = (1 + c.c) a + (b1 c2 c3, b2 c3 c1, b3 c1 c2) with a = J^-1 g/2 and b1 = (I2 - I3)/I1 and so on, cyclic.

All this is plain Python on numbers of any kind: on symbols it writes out the compiled code (``implicit.py``), for one
body or for two side by side.
"""

from typing import NamedTuple, TypeAlias

from binaryast.kernels.lanes import Lanes, Number

Three: TypeAlias = tuple[Number, Number, Number]


class Improved(NamedTuple):
    """Better Cayley coordinates, the square of what is left in them, and the Jacobian's determinant."""

    c: Three
    left: Number
    determinant: Number


def first_guess(lanes: Lanes, a: Three, b: Three) -> Three:
    """Return Cayley coordinates that are exact for a spin about a principal axis, then one pass of Gauss and Seidel.

    They are held back near the fold, where they would lead to the other branch.
    """
    square = a[0] * a[0] + a[1] * a[1] + a[2] * a[2]
    rest = 1.0 - 4.0 * square
    scale = 2.0 / (1.0 + lanes.sqrt(lanes.where_larger(rest, 0.1, rest, 0.1)))
    n = 1.0 + scale * scale * square
    c1 = n * a[0] + b[0] * (scale * a[1]) * (scale * a[2])
    c2 = n * a[1] + b[1] * (scale * a[2]) * c1
    return c1, c2, n * a[2] + b[2] * c1 * c2


def improved(lanes: Lanes, a: Three, b: Three, c: Three) -> Improved:
    """Correct twice with one Jacobian (Potra and Ptak's third-order form of Newton's method).

    What remains after the first correction d is exactly |d|^2 a + b d d, so it is formed without cancellation; after
    the second, e, about 2 |d| |e| is left.
    """
    (a1, a2, a3), (b1, b2, b3), (c1, c2, c3) = a, b, c
    n = 1.0 + c1 * c1 + c2 * c2 + c3 * c3
    r1 = n * a1 + b1 * c2 * c3 - c1
    r2 = n * a2 + b2 * c3 * c1 - c2
    r3 = n * a3 + b3 * c1 * c2 - c3
    m11, m12, m13 = 1.0 - 2.0 * a1 * c1, -2.0 * a1 * c2 - b1 * c3, -2.0 * a1 * c3 - b1 * c2
    m21, m22, m23 = -2.0 * a2 * c1 - b2 * c3, 1.0 - 2.0 * a2 * c2, -2.0 * a2 * c3 - b2 * c1
    m31, m32, m33 = -2.0 * a3 * c1 - b3 * c2, -2.0 * a3 * c2 - b3 * c1, 1.0 - 2.0 * a3 * c3
    k11, k12, k13 = m22 * m33 - m23 * m32, m13 * m32 - m12 * m33, m12 * m23 - m13 * m22  # cofactors
    k21, k22, k23 = m23 * m31 - m21 * m33, m11 * m33 - m13 * m31, m13 * m21 - m11 * m23
    k31, k32, k33 = m21 * m32 - m22 * m31, m12 * m31 - m11 * m32, m11 * m22 - m12 * m21
    determinant = m11 * k11 + m12 * k21 + m13 * k31
    inverse = 1.0 / determinant
    d1 = (k11 * r1 + k12 * r2 + k13 * r3) * inverse
    d2 = (k21 * r1 + k22 * r2 + k23 * r3) * inverse
    d3 = (k31 * r1 + k32 * r2 + k33 * r3) * inverse
    first = d1 * d1 + d2 * d2 + d3 * d3
    r1, r2, r3 = first * a1 + b1 * d2 * d3, first * a2 + b2 * d3 * d1, first * a3 + b3 * d1 * d2
    e1 = (k11 * r1 + k12 * r2 + k13 * r3) * inverse
    e2 = (k21 * r1 + k22 * r2 + k23 * r3) * inverse
    e3 = (k31 * r1 + k32 * r2 + k33 * r3) * inverse
    second = e1 * e1 + e2 * e2 + e3 * e3
    return Improved((c1 + (d1 + e1), c2 + (d2 + e2), c3 + (d3 + e3)), first * second, determinant)


def begun(lanes: Lanes, a: Three, b: Three) -> Improved:
    """Return the first guess, improved once."""
    return improved(lanes, a, b, first_guess(lanes, a, b))
