"""Rotations: S(x) and exp as the paper writes them, and the quaternions that the production steps carry.

Quaternions are (x, y, z, w), scalar last; q and -q are the same attitude. Matrices here are nine
numbers, row by row, and vectors three: tuples stay in registers, where small arrays would cost two to three times more.
"""

from math import cos, sin, sqrt

import numpy as np

from binaryast.kernels.jit import Array, Matrix, Quaternion, Vector, jit

SMALL_ANGLE = 0.05  # rad; below it the series' next term is under 1e-17


@jit(allocates=True)
def hat(x: Array) -> Array:
    """Return S(x), the matrix of the cross product: S(x) y = x cross y (section 2.2)."""
    return np.array([[0.0, -x[2], x[1]], [x[2], 0.0, -x[0]], [-x[1], x[0], 0.0]])


@jit(allocates=True)
def vee(matrix: Array) -> Array:
    """Return the vector x of the skew part of a matrix, S(x) = (A - A^T)/2."""
    return 0.5 * np.array([matrix[2, 1] - matrix[1, 2], matrix[0, 2] - matrix[2, 0], matrix[1, 0] - matrix[0, 1]])


@jit(allocates=True)
def solve_linear(matrix: Array, b: Array) -> Array:
    """Return x of A x = b for a matrix (3, 3), by its cofactors."""
    r1, r2, r3 = matrix[0], matrix[1], matrix[2]
    c1, c2, c3 = np.cross(r2, r3), np.cross(r3, r1), np.cross(r1, r2)
    result: Array = (c1 * b[0] + c2 * b[1] + c3 * b[2]) / (r1 @ c1)
    return result


@jit(allocates=True)
def nearest_rotation(matrix: Array) -> Array:
    """Return the rotation nearest to a matrix that is one but for round-off: Newton's step for its polar factor."""
    result: Array = 0.5 * matrix @ (3.0 * np.eye(3) - matrix.T @ matrix)
    return result


@jit()
def rodrigues_coefficients(angle: float) -> tuple[float, float, float, float]:
    """Return sin(t)/t, (1 - cos t)/t^2 and their derivatives divided by t, by series where t is small.

    These are the four functions of (129) and of the gradient of G below (130).
    """
    if angle < SMALL_ANGLE:
        s = angle * angle
        return (
            1.0 - s / 6.0 * (1.0 - s / 20.0 * (1.0 - s / 42.0 * (1.0 - s / 72.0))),
            0.5 - s / 24.0 * (1.0 - s / 30.0 * (1.0 - s / 56.0 * (1.0 - s / 90.0))),
            -1.0 / 3.0 + s / 30.0 * (1.0 - s / 28.0 * (1.0 - s / 54.0)),
            -1.0 / 12.0 + s / 180.0 * (1.0 - s / 37.333333333333336 * (1.0 - s / 67.5)),
        )
    sine = sin(angle)
    one_minus_cosine = 2.0 * sin(0.5 * angle) ** 2
    square = angle * angle
    return (
        sine / angle,
        one_minus_cosine / square,
        (cos(angle) * angle - sine) / (square * angle),
        (sine * angle - 2.0 * one_minus_cosine) / (square * square),
    )


@jit(allocates=True)
def exp(f: Array) -> Array:
    """Return exp S(f) by Rodrigues' formula (129)."""
    first, second, _, _ = rodrigues_coefficients(sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]))
    skew = hat(f)
    result: Array = np.eye(3) + first * skew + second * (skew @ skew)
    return result


@jit()
def quaternion_to_matrix(q: Quaternion) -> Matrix:
    """Return the nine elements of the rotation matrix of a unit quaternion, row by row."""
    x, y, z, w = q
    xx, yy, zz = x * x, y * y, z * z
    xy, yz, zx = x * y, y * z, z * x
    wx, wy, wz = w * x, w * y, w * z
    return (
        1.0 - 2.0 * (yy + zz),
        2.0 * (xy - wz),
        2.0 * (zx + wy),
        2.0 * (xy + wz),
        1.0 - 2.0 * (zz + xx),
        2.0 * (yz - wx),
        2.0 * (zx - wy),
        2.0 * (yz + wx),
        1.0 - 2.0 * (xx + yy),
    )


@jit()
def cross(a: Vector, b: Vector) -> Vector:
    """Return a x b."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@jit()
def dot(a: Vector, b: Vector) -> float:
    """Return a.b."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@jit()
def weighted(a: Vector, scale: float, b: Vector) -> Vector:
    """Return a + scale b."""
    return a[0] + scale * b[0], a[1] + scale * b[1], a[2] + scale * b[2]


@jit()
def rotate(r: Matrix, v: Vector) -> Vector:
    """Return R v."""
    x, y, z = v
    return r[0] * x + r[1] * y + r[2] * z, r[3] * x + r[4] * y + r[5] * z, r[6] * x + r[7] * y + r[8] * z


@jit()
def rotate_back(r: Matrix, v: Vector) -> Vector:
    """Return R^T v."""
    x, y, z = v
    return r[0] * x + r[3] * y + r[6] * z, r[1] * x + r[4] * y + r[7] * z, r[2] * x + r[5] * y + r[8] * z


@jit()
def relative_attitude(r2: Matrix, r1: Matrix) -> Matrix:
    """Return R = R2^T R1 (35)."""
    a = rotate_back(r2, (r1[0], r1[3], r1[6]))
    b = rotate_back(r2, (r1[1], r1[4], r1[7]))
    c = rotate_back(r2, (r1[2], r1[5], r1[8]))
    return a[0], b[0], c[0], a[1], b[1], c[1], a[2], b[2], c[2]


@jit()
def cayley(c: Vector) -> Quaternion:
    """Return the unit quaternion of the rotation by 2 atan|c| about c."""
    w = 1.0 / sqrt(1.0 + dot(c, c))
    return w * c[0], w * c[1], w * c[2], w


@jit()
def without_square(s: float, error: float, a: float) -> tuple[float, float]:
    """Return s - a^2 and what rounding took from it so far, exactly: Dekker's product and the fast two-sum."""
    square = a * a
    c = 134217729.0 * a  # 2^27 + 1 splits a into halves whose products are exact
    high = c - (c - a)
    low = a - high
    rest = ((high * high - square) + 2.0 * high * low) + low * low
    t = s - square
    return t, error + (((s - t) - square) - rest)


@jit()
def length_defect(q: Quaternion) -> float:
    """Return 1 - |q|^2 of a quaternion that is one long but for round-off, without any of its own."""
    s, error = without_square(1.0, 0.0, q[3])
    s, error = without_square(s, error, q[0])
    s, error = without_square(s, error, q[1])
    s, error = without_square(s, error, q[2])
    return s + error


@jit()
def rotation_error(q: Quaternion) -> float:
    """Return the Frobenius norm ||I - R^T R|| of the matrix of a quaternion (v, w).

    R = I + 2 w S(v) + 2 S(v)^2 gives R^T R - I = 4 (1 - |q|^2) S(v)^2, whose norm is this.
    """
    return 4.0 * sqrt(2.0) * (q[0] * q[0] + q[1] * q[1] + q[2] * q[2]) * abs(length_defect(q))
