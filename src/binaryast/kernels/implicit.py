"""The implicit equation of the rotation, F J_d - J_d F^T = S(g): (128)-(130).

`solve` is the paper's: exponential coordinates, any inertia matrix. `solve_cayley` and `solve_both` are the same
equation in the body's principal axes and Cayley coordinates, for one body and two; the production steps use them. About
a principal axis both say sin(theta) = h Omega, theta being the turn in one step: there is no solution for h Omega >= 1.
About other axes the branch of small turns ends somewhat later; both refuse g from h Omega = |J^-1 g| = 1 on for every
axis, for beyond it another branch may lie nearer.
"""

from functools import partial
from math import asin, sqrt
from typing import Any, TypeAlias

import numpy as np
from numba import types
from numba.extending import intrinsic

from binaryast.kernels import cayley_equation
from binaryast.kernels.jit import Array, Vector, jit
from binaryast.kernels.so3 import hat, rodrigues_coefficients, solve_linear
from binaryast.kernels.symbols import written_out, written_out_twice

IMPROVED = types.UniTuple(types.float64, 5)
Improvement: TypeAlias = tuple[float, float, float, float, float]

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


@intrinsic  # type: ignore[untyped-decorator]
def begun(_: Any, a: Any, b: Any) -> Any:
    """Return a first guess of c (3), the square of what is left in it, and the Jacobian's determinant."""
    return IMPROVED(a, b), partial(written_out, cayley_equation.begun)


@intrinsic  # type: ignore[untyped-decorator]
def improved(_: Any, a: Any, b: Any, c: Any) -> Any:
    """Return the same of better Cayley coordinates."""
    return IMPROVED(a, b, c), partial(written_out, cayley_equation.improved)


@intrinsic  # type: ignore[untyped-decorator]
def both_begun(_: Any, a2: Any, a1: Any, b2: Any, b1: Any) -> Any:
    """Return first guesses of two bodies, side by side."""
    return types.UniTuple(IMPROVED, 2)(a2, a1, b2, b1), partial(written_out_twice, cayley_equation.begun)


@intrinsic  # type: ignore[untyped-decorator]
def both_improved(_: Any, a2: Any, a1: Any, b2: Any, b1: Any, c2: Any, c1: Any) -> Any:
    """Return the same of better Cayley coordinates of two bodies, side by side."""
    return types.UniTuple(IMPROVED, 2)(a2, a1, b2, b1, c2, c1), partial(written_out_twice, cayley_equation.improved)


@jit()
def half_turn(inverse_moments: Vector, g: Vector) -> tuple[Vector, bool]:
    """Return a = J^-1 g/2, and whether (128) has a solution: it must be a number and h Omega = 2 |a| below 1."""
    a = (0.5 * g[0] * inverse_moments[0], 0.5 * g[1] * inverse_moments[1], 0.5 * g[2] * inverse_moments[2])
    return a, 4.0 * (a[0] * a[0] + a[1] * a[1] + a[2] * a[2]) < 1.0


@jit()
def is_near(c: Improvement) -> bool:
    """Whether what is left is no more than rounding, or nothing better can come: divergence, or not a number."""
    square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2]
    return c[3] <= REMAINING * square or not square < 100.0


@jit()
def is_solved(c: Improvement) -> bool:
    """Whether what is left is no more than rounding, and the turn not beyond the largest that (128) can give."""
    return c[3] <= REMAINING * (c[0] * c[0] + c[1] * c[1] + c[2] * c[2]) and c[4] > 0.0


@jit()
def solve_cayley(inverse_moments: Vector, ratios: Vector, g: Vector) -> tuple[Vector, int]:
    """Solve (128) in principal axes for c: see ``cayley_equation.py``.

    Returns c and the number of iterations, -1 where there is no solution on the branch of small turns.
    """
    a, solvable = half_turn(inverse_moments, g)
    if not solvable:
        return (0.0, 0.0, 0.0), -1
    c = begun(a, ratios)
    iterations = 1
    while not is_near(c) and iterations < MOST_ITERATIONS:
        c = improved(a, ratios, (c[0], c[1], c[2]))
        iterations += 1
    return (c[0], c[1], c[2]), iterations if is_solved(c) else -1


@jit()
def solve_both(
    inverse_2: Vector, ratios_2: Vector, g2: Vector, inverse_1: Vector, ratios_1: Vector, g1: Vector
) -> tuple[Vector, Vector, bool, bool]:
    """Solve (123) and (124) side by side; whether they have solutions are the last values."""
    a2, solvable_2 = half_turn(inverse_2, g2)
    a1, solvable_1 = half_turn(inverse_1, g1)
    if not (solvable_2 and solvable_1):
        return (0.0, 0.0, 0.0), (0.0, 0.0, 0.0), solvable_2, solvable_1
    c2, c1 = both_begun(a2, a1, ratios_2, ratios_1)
    iterations = 1
    while not (is_near(c2) and is_near(c1)) and iterations < MOST_ITERATIONS:
        c2, c1 = both_improved(a2, a1, ratios_2, ratios_1, (c2[0], c2[1], c2[2]), (c1[0], c1[1], c1[2]))
        iterations += 1
    return (c2[0], c2[1], c2[2]), (c1[0], c1[1], c1[2]), is_solved(c2), is_solved(c1)
