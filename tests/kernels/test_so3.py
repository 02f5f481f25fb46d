"""Rotations: the printed formulas and the quaternions against SciPy, and against each other by hypothesis."""

import math
from fractions import Fraction

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from scipy.linalg import expm
from scipy.spatial.transform import Rotation

from binaryast.kernels import so3

component = st.floats(-3, 3, allow_nan=False)
vectors = st.tuples(component, component, component)
small = st.floats(1e-12, 1e-1)


@given(vectors, vectors)
def test_hat_is_the_cross_product(x: tuple, y: tuple) -> None:
    np.testing.assert_allclose(so3.hat(np.array(x)) @ y, np.cross(x, y), atol=1e-14)
    np.testing.assert_array_equal(so3.vee(so3.hat(np.array(x))), x)


@given(vectors)
def test_exp_is_the_rotation_by_its_vector(f: tuple) -> None:
    matrix = so3.exp(np.array(f))
    np.testing.assert_allclose(matrix, expm(so3.hat(np.array(f))), atol=2e-15 * max(1, np.linalg.norm(f)))
    np.testing.assert_allclose(matrix.T @ matrix, np.eye(3), atol=3e-15)
    np.testing.assert_allclose(Rotation.from_rotvec(f).as_matrix(), matrix, atol=2e-15 * max(1, np.linalg.norm(f)))


@given(small)
def test_series_meet_the_closed_forms(angle: float) -> None:
    first, second, third, fourth = so3.rodrigues_coefficients(angle)
    s = angle * angle  # Taylor series, three terms more than the code has
    series = [
        sum((-s) ** k / math.factorial(2 * k + 1) for k in range(9)),
        sum((-s) ** k / math.factorial(2 * k + 2) for k in range(9)),
        sum((-1) ** (k + 1) * s**k * (2 * k + 2) / math.factorial(2 * k + 3) for k in range(9)),
        sum((-1) ** (k + 1) * s**k * (2 * k + 2) / math.factorial(2 * k + 4) for k in range(9)),
    ]
    np.testing.assert_allclose([first, second], series[:2], rtol=1e-15)
    np.testing.assert_allclose([third, fourth], series[2:], rtol=3e-11)  # closed forms cancel from 0.05 rad upwards
    assert so3.SMALL_ANGLE < 0.1


@given(vectors)
def test_cayley_is_twice_the_arc_tangent(c: tuple) -> None:
    size = np.linalg.norm(c)
    expected = Rotation.from_rotvec(np.array(c) * (2 * np.arctan(size) / size if size else 2.0)).as_matrix()
    matrix = np.array(so3.quaternion_to_matrix(so3.cayley(c))).reshape(3, 3)
    np.testing.assert_allclose(matrix, expected, atol=3e-15)


@given(vectors, vectors, vectors)
def test_rotate_back_undoes_rotate(f: tuple, g: tuple, v: tuple) -> None:
    r2 = so3.quaternion_to_matrix(tuple(Rotation.from_rotvec(f).as_quat()))
    r1 = so3.quaternion_to_matrix(tuple(Rotation.from_rotvec(g).as_quat()))
    np.testing.assert_allclose(so3.rotate_back(r2, so3.rotate(r2, v)), v, atol=1e-14)
    relative = np.array(so3.relative_attitude(r2, r1)).reshape(3, 3)
    np.testing.assert_allclose(relative, np.array(r2).reshape(3, 3).T @ np.array(r1).reshape(3, 3), atol=1e-15)


def test_rotation_error_is_the_frobenius_norm() -> None:
    for scale in (1 + 1e-3, 1 - 1e-6, 1 + 1e-9):
        q = scale * Rotation.random(random_state=5).as_quat()
        matrix = np.array(so3.quaternion_to_matrix(tuple(q))).reshape(3, 3)
        expected = np.linalg.norm(np.eye(3) - matrix.T @ matrix)
        assert math.isclose(so3.rotation_error(tuple(q)), expected, rel_tol=1e-5)


def test_the_length_of_a_quaternion_is_seen_to_the_last_digit() -> None:
    for q in Rotation.random(100, random_state=6).as_quat():
        exact = 1 - sum(Fraction(float(component)) ** 2 for component in q)
        assert abs(so3.length_defect(tuple(q)) - exact) < 1e-30


def test_nearest_rotation() -> None:
    r = Rotation.random(random_state=7).as_matrix()
    off = r + 1e-8 * np.random.default_rng(1).normal(size=(3, 3))
    left, _, right = np.linalg.svd(off)
    np.testing.assert_allclose(so3.nearest_rotation(off), left @ right, atol=1e-15)


def test_linear_equations() -> None:
    random = np.random.default_rng(2)
    matrix, x = random.normal(size=(3, 3)), random.normal(size=3)
    np.testing.assert_allclose(so3.solve_linear(matrix, matrix @ x), x, rtol=1e-12)
