"""Regular solid harmonics R_lm: as polynomials, as moments of a mass distribution, and under an exchange of axes.

    R_lm = r^l P_lm(cos theta) e^(i m phi)/(l + m)!
         = sum over k of (-1)^k (x + iy)^(m + k) (x - iy)^k z^(l - m - 2k)/(2^(m + 2k) (m + k)! k! (l - m - 2k)!)

without the Condon-Shortley sign, in the normalisation of C. A. White, M. Head-Gordon, J. Chem. Phys. 101 (1994) 6593:
all its coefficients are rational. Its real and imaginary parts, c_lm and s_lm, lie at l (l + 1)/2 + m of two arrays.
"""

from functools import lru_cache
from math import comb, factorial

import numpy as np
from numpy.typing import NDArray

from binaryast.kernels.moments import Floats, count, exponents, index


def factorials(n: NDArray[np.int64]) -> Floats:
    """Return n! of whole numbers."""
    return np.array([factorial(i) for i in n.tolist()], dtype=float)


def place(l: int, m: int) -> int:
    """Return where degree l and order m lie in the arrays of c and of s."""
    return l * (l + 1) // 2 + m


@lru_cache
def polynomials(degree: int) -> tuple[Floats, Floats]:
    """Return the coefficients of c_lm and s_lm over monomials (harmonics, monomials), each rounded once."""
    c, s = (np.zeros((place(degree + 1, 0), count(degree))) for _ in range(2))
    for l in range(degree + 1):
        divisor = 2**l * factorial(l)
        for m in range(l + 1):
            for (i, j, k), value in _terms(l, m).items():
                part = s if j % 2 else c  # i^j is real for even powers of y alone
                part[place(l, m), index(i, j, k)] = value / divisor
    return c, s


def _terms(l: int, m: int) -> dict[tuple[int, int, int], int]:
    """Return the terms of R_lm times 2^l l!, whole numbers, by the exponents of x, y and z."""
    terms: dict[tuple[int, int, int], int] = {}
    for k in range((l - m) // 2 + 1):
        rest = l - m - 2 * k
        ways = factorial(l) // (factorial(m + k) * factorial(k) * factorial(rest))  # a multinomial coefficient
        for a in range(k + 1):  # (x^2 + y^2)^k
            for b in range(m + 1):  # (x + iy)^m
                key = (2 * (k - a) + m - b, 2 * a + b, rest)
                sign = (-1) ** k * (1, 1, -1, -1)[b % 4]
                terms[key] = terms.get(key, 0) + sign * 2**rest * ways * comb(k, a) * comb(m, b)
    return terms


def harmonic_moments(moments: Floats, degree: int) -> tuple[Floats, Floats]:
    """Return the integrals of c_lm and s_lm over the mass from its monomial moments."""
    c, s = polynomials(degree)
    return c @ moments, s @ moments


def monomial_moments(c: Floats, s: Floats, degree: int) -> Floats:
    """Return the monomial moments that have these harmonics, and are zero for r^2 times any polynomial.

    In the product <p, q> = p(d/dx, d/dy, d/dz) q of polynomials of one degree, monomials are orthogonal with the norm
    i! j! k!, and harmonics are orthogonal to each other and to r^2 times anything. So the harmonic part of a monomial
    is its projection on them.
    """
    norms = np.prod([factorials(powers) for powers in exponents(degree).T], axis=0)
    total = np.zeros(count(degree))
    for values, harmonics in zip((c, s), polynomials(degree), strict=True):
        squares = harmonics**2 @ norms
        weights = np.divide(values, squares, out=np.zeros_like(squares), where=squares > 0)
        total += norms * (weights @ harmonics)
    return total


@lru_cache
def exchange(l: int) -> tuple[Floats, Floats]:
    """Return the matrices (l + 1, l + 1) that take c_l and s_l to their values at (-z, y, x), all elements exact.

    R_lk(-z, y, x) = 2^-l sum over m = -l .. l of R_lm(x, y, z) times the coefficient of t^(l + k) in
    (1 + t)^(l + m) (1 - t)^(l - m), because sum over m of t^m R_lm is ((x + iy) t/2 + z - (x - iy)/(2t))^l/l!, in which
    the exchange takes t to (1 + t)/(1 - t). Orders m and -m are joined by R_l,-m = (-1)^m conj(R_lm).
    """
    c, s = np.zeros((l + 1, l + 1)), np.zeros((l + 1, l + 1))
    for m in range(l + 1):
        plus, minus = (np.array(_product(l + order, l - order)[l:]) / 2**l for order in (m, -m))
        c[:, m] = plus + (-1) ** m * minus if m else plus
        s[1:, m] = plus[1:] - (-1) ** m * minus[1:]
    return c, s


def _product(plus: int, minus: int) -> list[int]:
    """Return the coefficients of (1 + t)^plus (1 - t)^minus."""
    coefficients = [1]
    for sign in [1] * plus + [-1] * minus:
        coefficients = [a + sign * b for a, b in zip([*coefficients, 0], [0, *coefficients], strict=True)]
    return coefficients
