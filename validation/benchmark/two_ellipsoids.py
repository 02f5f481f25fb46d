"""The terms of two homogeneous ellipsoids in which both have a part, to any even degree N.

They are sum over k1 and k2 from 1, 2 (k1 + k2) <= N, of c_k1 c_k2 D1^k1 D2^k2 (1/r). The operators act on a harmonic
function, so d_x^2 + d_y^2 + d_z^2 = 0, and with w = (d_x + i d_y)/d_z, for which (d_x - i d_y)/d_z = -1/w, each D is
d_z^2 times a polynomial in w and 1/w: D1^2 and D1^3 are its powers. What they act on are Z_LM = d_z^L w^M (1/r), closed
under differentiation. In the primary's axes those of D2 have constant factors, which cost a Taylor integrator little.

All are kept for orders m >= 0: of -m they are (-1)^m times the conjugate.
"""

from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

from validation.benchmark.expressions import (
    Constant,
    Exerted,
    Number,
    Place,
    Powers,
    cross,
    mean_factor,
    total,
)

ZERO = hy.expression(0.0)
ITSELF = 3  # in the place of an axis of differentiation


class Complex(NamedTuple):
    """Real and imaginary part."""

    re: Number
    im: Number


def conjugate(row: dict[int, Complex], m: int) -> Complex:
    """Return the element m of a row that is kept for m >= 0: of -m it is (-1)^m times the conjugate."""
    if m >= 0:
        return row[m]
    sign = (-1.0) ** m
    return Complex(sign * row[-m].re, -sign * row[-m].im)


def multiplied(one: dict[int, Complex], two: dict[int, Complex]) -> dict[int, Complex]:
    """Return the product of two polynomials in w and 1/w."""
    result = {}
    highest_1, highest_2 = max(one), max(two)
    for m in range(highest_1 + highest_2 + 1):
        re, im = [], []
        for i in range(max(-highest_1, m - highest_2), min(highest_1, m + highest_2) + 1):
            a, b = conjugate(one, i), conjugate(two, m - i)
            re += [a.re * b.re, -(a.im * b.im)]
            im += [a.re * b.im, a.im * b.re]
        result[m] = Complex(total(re), total(im) if m else ZERO)
    return result


def of_matrix(B: Any) -> dict[int, Complex]:
    """Return sum B_ij d_i d_j as a polynomial in w."""
    return {
        0: Complex(B[2][2] - 0.5 * (B[0][0] + B[1][1]), ZERO),
        1: Complex(B[0][2], -B[1][2]),
        2: Complex(0.25 * (B[0][0] - B[1][1]), -0.5 * B[0][1]),
    }


def legendre(l: int, m: int) -> dict[int, int]:
    """Return the polynomial p(z) with Z_LM = p(z) (x + i y)^M on the unit sphere, M >= 0.

    Z_LL is (-1)^L (2L - 1)!! (x + i y)^L, and r^2 Z_LM = -(2L - 1) z Z_(L-1)M - ((L - 1)^2 - M^2) Z_(L-2)M.
    """
    if l < m:
        return {}
    if l == m:
        return {0: int((-1) ** l * np.prod(range(1, 2 * l, 2), dtype=object))}
    result = {e + 1: -(2 * l - 1) * c for e, c in legendre(l - 1, m).items()}
    for e, c in legendre(l - 2, m).items():
        result[e] = result.get(e, 0) - ((l - 1) ** 2 - m**2) * c
    return result


def of_diagonal(beta: list[Number]) -> dict[int, Complex]:
    """Return b_1 d_x^2 + b_2 d_y^2 as a polynomial in w, with real constants."""
    return {
        0: Complex(-0.5 * (beta[0] + beta[1]), ZERO),
        1: Complex(ZERO, ZERO),
        2: Complex(0.25 * (beta[0] - beta[1]), ZERO),
    }


def irregular(x: Any, inverse_r: Number, degrees: range, constant: Constant) -> dict[int, dict[int, Complex]]:
    """Return Z_LM of degrees, for M >= 0."""
    xi, eta, zeta = (part * inverse_r for part in x)
    r_powers, z_powers = Powers(inverse_r), Powers(zeta)
    turns = [Complex(hy.expression(1.0), ZERO), Complex(xi, eta)]
    for m in range(2, degrees[-1] + 1):
        a, b = turns[m // 2], turns[m - m // 2]
        turns.append(Complex(a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re))
    result: dict[int, dict[int, Complex]] = {}
    for l in degrees:
        result[l] = {}
        for m in range(l + 1):
            p = [constant(c) * z_powers[e] for e, c in legendre(l, m).items() if c]
            size = r_powers[l + 1] * total(p)
            result[l][m] = Complex(size * turns[m].re, size * turns[m].im)
    return result


def terms_of(Z: dict[int, dict[int, Complex]], l: int, m: int, axis: int) -> tuple[list[Number], list[Number]]:
    """Return the terms of the derivative of Z_lm, real and imaginary, or of Z_lm itself."""
    if axis == ITSELF:
        z = conjugate(Z[l], m)
        return [z.re], [z.im]
    if axis == 2:
        z = conjugate(Z[l + 1], m)
        return [z.re], [z.im]
    a, b = conjugate(Z[l + 1], m + 1), conjugate(Z[l + 1], m - 1)
    if axis == 0:
        return [0.5 * a.re, -0.5 * b.re], [0.5 * a.im, -0.5 * b.im]
    return [0.5 * a.im, 0.5 * b.im], [-0.5 * a.re, -0.5 * b.re]


def turned(A: dict[int, Complex], axis: int) -> dict[int, Complex]:
    """Return what a turn of the body about an axis does to a polynomial of d_z^l, l its highest power of w."""
    l = max(A)
    result = {}
    for m in range(l + 1):
        if axis == 2:
            result[m] = Complex(float(m) * A[m].im, -float(m) * A[m].re)
            continue
        below, above = conjugate(A, m - 1), (A[m + 1] if m < l else Complex(ZERO, ZERO))
        a, b = 0.5 * (l - m + 1), 0.5 * (l + m + 1)
        if axis == 0:
            result[m] = Complex(-(a * below.im + b * above.im), a * below.re + b * above.re)
        else:
            result[m] = Complex(a * below.re - b * above.re, a * below.im - b * above.im)
    return result


def inner(A: dict[int, Complex], T: dict[int, Complex]) -> list[Number]:
    """Return the terms of sum over all m of A_m T_m, which is real."""
    terms = [A[0].re * T[0].re]
    for m in range(1, max(A) + 1):
        terms += [2.0 * (A[m].re * T[m].re), -2.0 * (A[m].im * T[m].im)]
    return terms


def exerted(squares1: list[Number], squares2: list[Number], degree: int, at: Place, constant: Constant) -> Exerted:
    """Return what these terms exert, over G m1 m2; the squares are those of the semi-axes."""
    alpha, beta = ([squares[0] - squares[2], squares[1] - squares[2]] for squares in (squares1, squares2))
    R = at.R
    B1 = [[total([a * (R[i, n] * R[j, n]) for n, a in enumerate(alpha)]) for j in range(3)] for i in range(3)]
    Z = irregular(at.x, at.r[1], range(4, degree + 2), constant)
    A, B = {1: of_matrix(B1)}, {1: of_diagonal(beta)}
    for k in range(2, degree // 2):
        A[k], B[k] = multiplied(A[k - 1], A[1]), multiplied(B[k - 1], B[1])
    gradient: list[list[Number]] = [[], [], []]
    turn: list[list[Number]] = [[], [], []]
    for k, of_first in A.items():
        for axis in range(3):
            gradient[axis] += inner(of_first, coupled(Z, B, k, degree, axis, constant))
        T = coupled(Z, B, k, degree, ITSELF, constant)
        for axis in range(3):
            turn[axis] += inner(turned(of_first, axis), T)
    force, by_turn = (np.array([total(part) for part in parts]) for parts in (gradient, turn))
    return Exerted(0.0, force, np.zeros(3), -cross(at.x, force) - by_turn, R.T @ by_turn)


def coupled(
    Z: dict[int, dict[int, Complex]],
    B: dict[int, dict[int, Complex]],
    k1: int,
    degree: int,
    axis: int,
    constant: Constant,
) -> dict[int, Complex]:
    """Return sum over k2 and m' of c_k1 c_k2 (D2^k2)_m' times Z or its derivative, for each m of D1^k1."""
    result = {}
    for m in range(2 * k1 + 1):
        re, im = [], []
        for k2 in range(1, degree // 2 - k1 + 1):
            factor = constant(mean_factor(k1) * mean_factor(k2))
            for other in range(-2 * k2, 2 * k2 + 1, 2):
                b = factor * conjugate(B[k2], other).re
                terms = terms_of(Z, 2 * (k1 + k2), m + other, axis)
                re += [b * term for term in terms[0]]
                im += [b * term for term in terms[1]]
        result[m] = Complex(total(re), total(im))
    return result
