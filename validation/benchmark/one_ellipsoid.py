"""The attraction of one homogeneous ellipsoid on a point, to a degree: polynomials in the coordinates in its axes.

The mean over it of the inverse distance is sum c_k D^k (1/r), with D = sum a_i^2 d_i^2.
"""

from math import comb

import numpy as np

from validation.benchmark.expressions import Constant, InversePowers, Number, Powers, mean_factor, total

Polynomial = dict[tuple[int, int, int], Number]  # exponents of x, y, z


def derivative(p: Polynomial, n: int, axis: int) -> Polynomial:
    """Return the numerator of the derivative of p/r^n, over r^(n + 2)."""
    result: Polynomial = {}

    def add(exponents: list[int], factor: Number) -> None:
        key = (exponents[0], exponents[1], exponents[2])
        result[key] = result.get(key, 0) + factor

    for exponents, factor in p.items():
        if exponents[axis]:
            lowered = list(exponents)
            lowered[axis] -= 1
            for other in range(3):
                raised = list(lowered)
                raised[other] += 2
                add(raised, factor * exponents[axis])
        raised = list(exponents)
        raised[axis] += 1
        add(raised, -n * factor)
    return result


def pure_gradient(
    squares: list[Number], highest: int, x: np.ndarray, x2: list[Number], r: InversePowers, constant: Constant
) -> np.ndarray:
    """Return the gradient (3,) of sum over 1 <= k <= N/2 of c_k D^k (1/r), in the body's axes.

    Over x, y and z it is r^-3 times a polynomial in r^-2, u = x^2/r^4 and v = y^2/r^4.
    """
    u, v = Powers(x2[0] * r[4]), Powers(x2[1] * r[4])
    second = [squares[0] - squares[2], squares[1] - squares[2]]  # 1/r is harmonic
    terms: list[list[Number]] = [[], [], []]
    p: Polynomial = {(0, 0, 0): constant(1)}
    for k in range(1, highest // 2 + 1):
        n = 4 * k - 3
        p = added(*(scaled(twice(p, n, axis), second[axis]) for axis in (0, 1)))
        factor = constant(mean_factor(k))
        for axis in range(3):
            slope = scaled(derivative(p, n + 4, axis), factor)
            in_u_v = of_two_squares(slope, axis).items()
            terms[axis] += [c * (r[2 * (k - i - j) + 3] * (u[i] * v[j])) for (i, j), c in in_u_v if str(c) != "0"]
    return np.array([x[axis] * total(terms[axis]) for axis in range(3)])


def twice(p: Polynomial, n: int, axis: int) -> Polynomial:
    """Return the numerator of the second derivative of p/r^n, over r^(n + 4)."""
    return derivative(derivative(p, n, axis), n + 2, axis)


def scaled(p: Polynomial, factor: Number) -> Polynomial:
    """Return a polynomial times a constant."""
    return {key: factor * value for key, value in p.items()}


def added(one: Polynomial, two: Polynomial) -> Polynomial:
    """Return the sum of two polynomials."""
    return {key: one.get(key, 0) + two.get(key, 0) for key in one | two}


def of_two_squares(p: Polynomial, axis: int) -> dict[tuple[int, int], Number]:
    """Return p over the coordinate of an axis, on the unit sphere, as a polynomial in x^2 and y^2."""
    result: dict[tuple[int, int], Number] = {}
    for exponents, factor in p.items():
        i, j, k = ((e - (a == axis)) // 2 for a, e in enumerate(exponents))
        for a in range(k + 1):  # z^2k = (1 - x^2 - y^2)^k
            for b in range(k - a + 1):
                times = (-1) ** (a + b) * comb(k, a) * comb(k - a, b)
                result[i + a, j + b] = result.get((i + a, j + b), 0) + times * factor
    return result
