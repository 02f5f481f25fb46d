"""The implicit equation of the rotation, F J_d - J_d F^T = S(g): (128)-(130).

`solve` is the paper's: exponential coordinates, any inertia matrix. `solve_cayley` is the same equation in the body's
principal axes and Cayley coordinates, where it is a polynomial; the production steps use it. About a principal axis
both say sin(theta) = h Omega, theta being the turn in one step: there is no solution for h Omega >= 1. About other
axes the branch of small turns ends somewhat later; both refuse g from h Omega = |J^-1 g| = 1 on for every axis, for
beyond it another branch may lie nearer.
"""

from math import asin, sqrt

import numpy as np

from binaryast.kernels.jit import Array, Vector, jit
from binaryast.kernels.so3 import hat, rodrigues_coefficients, solve_linear

MOST_ITERATIONS = 20
REMAINING = 1e-34  # square of the error left in Cayley coordinates, relative
CONVERGED = 1e-8  # the last correction over the unknown: Newton's next one would be about the square of it


@jit(allocates=True)
def residual_function(inertia: Array, f: Array) -> Array:
    """Return G(f), below (129)."""
    first, second, _, _ = rodrigues_coefficients(sqrt(f @ f))
    momentum = inertia @ f
    result: Array = first * momentum + second * np.cross(f, momentum)
    return result


@jit(allocates=True)
def gradient(inertia: Array, f: Array) -> Array:
    """Return the gradient of G at f, below (130)."""
    first, second, third, fourth = rodrigues_coefficients(sqrt(f @ f))
    momentum = inertia @ f
    result: Array = (
        np.expand_dims(third * momentum + fourth * np.cross(f, momentum), 1) * f
        + first * inertia
        + second * (hat(f) @ inertia - hat(momentum))
    )
    return result


@jit(allocates=True)
def solve(inertia: Array, g: Array) -> tuple[Array, int]:
    """Solve g = G(f) by Newton's iteration (130).

    Returns f and the number of iterations, -1 where there is no solution on the branch of small turns.
    """
    if not abs(g[0]) + abs(g[1]) + abs(g[2]) < 1e150:
        return np.zeros(3), -1
    f: Array = solve_linear(inertia, g)
    sine = sqrt(f @ f)
    if sine == 0.0:
        return f, 0
    if not sine < 1.0:
        return f, -1
    f = f * (asin(min(sine, 0.95)) / sine)  # exact for a spin about a principal axis, held back near the fold
    first, second, _, _ = rodrigues_coefficients(sqrt(f @ f))
    f = solve_linear(inertia, g - second * np.cross(f, inertia @ f)) / first  # one pass with the gyroscopic term
    for iteration in range(1, MOST_ITERATIONS + 1):
        matrix = gradient(inertia, f)
        correction: Array = solve_linear(matrix, g - residual_function(inertia, f))
        f = f + correction  # (130)
        size = sqrt(correction @ correction)
        if not size < 10.0:  # divergence, or not a number
            break
        if size <= CONVERGED * sqrt(f @ f):
            if matrix[0] @ np.cross(matrix[1], matrix[2]) <= 0.0:  # beyond the largest turn that (128) can give
                break
            return f, iteration
    return f, -1


@jit()
def solve_cayley(inverse_moments: Vector, ratios: Vector, g: Vector) -> tuple[Vector, int]:
    """Solve (128) in principal axes for c, F being the rotation by 2 atan|c| about c.

    With F = cay(c), (128) is 2 (J c + c x J c) = (1 + c.c) g, three quadratic equations. Each iteration corrects twice
    with one Jacobian (Potra and Ptak's third-order form of Newton's method); what remains after the first correction d
    is exactly |d|^2 a + b d d, so it is formed without cancellation. Returns c and the number of iterations, -1 where
    there is no solution on the branch of small turns.
    """
    i1, i2, i3 = inverse_moments
    a1, a2, a3 = 0.5 * g[0] * i1, 0.5 * g[1] * i2, 0.5 * g[2] * i3
    b1, b2, b3 = ratios
    square = a1 * a1 + a2 * a2 + a3 * a3
    if square == 0.0:
        return (0.0, 0.0, 0.0), 0
    if not 4.0 * square < 1.0:  # h Omega >= 1, or not a number
        return (0.0, 0.0, 0.0), -1
    # exact for a spin about a principal axis; held back near the fold, where it would lead to the other branch
    scale = 2.0 / (1.0 + sqrt(max(0.1, 1.0 - 4.0 * square)))
    c1, c2, c3 = scale * a1, scale * a2, scale * a3
    n = 1.0 + scale * scale * square
    c1 = n * a1 + b1 * c2 * c3  # one pass of Gauss and Seidel
    c2 = n * a2 + b2 * c3 * c1
    c3 = n * a3 + b3 * c1 * c2
    for iteration in range(1, MOST_ITERATIONS + 1):
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
        c1, c2, c3 = c1 + (d1 + e1), c2 + (d2 + e2), c3 + (d3 + e3)
        second = e1 * e1 + e2 * e2 + e3 * e3
        if not first < 100.0:  # divergence, or not a number
            break
        if first * second <= REMAINING * (c1 * c1 + c2 * c2 + c3 * c3):  # the next correction is about 2 |d| |e|
            if determinant <= 0.0:  # beyond the largest turn that (128) can give
                break
            return (c1, c2, c3), iteration
    return (c1, c2, c3), -1
