"""The exact free rotation: against series in extended precision, closed forms, and itself in two halves."""

import numba
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from binaryast.kernels import free_rotation
from binaryast.kernels.jit import jit

EXTENDED = np.finfo(np.longdouble).eps < 1e-18
ZERO = ((0.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))


@numba.njit(error_model="numpy")
def turned(p, inverse, h):
    """Return quaternion and momentum after a free turn from the attitude of the inertial axes."""
    a = ((0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0), p, (0.0, 0.0, 0.0))
    a, solved = free_rotation.turn_exactly(a, (inverse, inverse), h)
    return a[0], a[2], solved


@jit()
def attitude(p):
    """Return the attitude of the inertial axes with a momentum."""
    return (0.0, 0.0, 0.0, 1.0), (0.0, 0.0, 0.0, 0.0), p, (0.0, 0.0, 0.0)


@numba.njit(error_model="numpy")
def both_turned(p2, inverse_2, p1, inverse_1, h):
    """Return the same of two bodies."""
    a2, a1, solved_2, solved_1 = free_rotation.turn_both_exactly(
        attitude(p2), (inverse_2, inverse_2), attitude(p1), (inverse_1, inverse_1), h
    )
    return a2[0], a2[2], a1[0], a1[2], solved_2, solved_1


def bodies(count: int, seed: int) -> np.ndarray:
    """Return principal moments (count, 3) that masses can have, flat and needle-like ones among them."""
    second = np.random.default_rng(seed).uniform(1e-2, 1, (count, 3)) ** 2
    return second.sum(axis=1, keepdims=True) - second


def momenta(moments: np.ndarray, turn: float, seed: int) -> np.ndarray:
    """Return angular momenta of spins in any direction with h Omega = turn for h = 1."""
    n = np.random.default_rng(seed).normal(size=moments.shape)
    return moments * n / np.linalg.norm(n, axis=1, keepdims=True) * turn


def exact(P: np.ndarray, J: np.ndarray, pieces: int = 8, order: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Return quaternions and momenta after a time 1 by Taylor series of Euler's equations in extended precision."""
    P, J, h = P.astype(np.longdouble), J.astype(np.longdouble), np.longdouble(1) / pieces
    q = np.zeros((len(P), 4), np.longdouble)
    q[:, 3] = 1
    for _ in range(pieces):
        p_series, q_series = [P], [q]
        for k in range(order):
            dp, dq = np.zeros_like(P), np.zeros_like(q)
            for j in range(k + 1):
                omega = p_series[k - j] / J
                v, w = q_series[j][:, :3], q_series[j][:, 3:]
                dp += np.cross(p_series[j], omega)
                dq += (
                    np.concatenate([w * omega + np.cross(v, omega), -np.sum(v * omega, axis=1, keepdims=True)], axis=1)
                    / 2
                )
            p_series.append(dp / (k + 1))
            q_series.append(dq / (k + 1))
        P, q = (sum(c * h**k for k, c in enumerate(series)) for series in (p_series, q_series))
    return q, P


def check(J: np.ndarray, P: np.ndarray, bound: float) -> None:
    """Compare quaternions, and momenta over their size."""
    expected_q, expected_P = exact(P, J)
    for k in range(len(J)):
        q, p, solved = turned(tuple(P[k]), tuple(1 / J[k]), 1.0)
        assert solved
        sign = np.sign(float(np.dot(q, expected_q[k])))
        assert np.abs(sign * np.array(q) - expected_q[k]).max() < bound
        assert np.linalg.norm(np.array(p) - expected_P[k]) < 2 * bound * np.linalg.norm(P[k])


extended = pytest.mark.skipif(not EXTENDED, reason="this machine has nothing longer than a double")


@extended
@pytest.mark.parametrize("turn", [1e-6, 1e-2, 0.2, 0.7, 1.0])
def test_any_body(turn: float) -> None:
    J = bodies(300, 1)
    check(J, momenta(J, turn, 2), 2.5e-15)


@extended
@pytest.mark.parametrize("difference", [1e-3, 1e-9, 1e-14, 0.0])
def test_nearly_symmetric_bodies(difference: float) -> None:
    for unequal in (
        [1, 1 + difference, 1.6],
        [1.6, 1, 1 - difference],
        [1, 0.7, 1 + difference],
        [1, 1, 1 - difference],
    ):
        J = np.tile(unequal, (20, 1))
        check(J, momenta(J, 0.8, 3), 2.5e-15)


@extended
@pytest.mark.parametrize("off", [1e-2, 1e-6, 1e-12, 0.0])
@pytest.mark.parametrize("axis", [0, 1, 2])
def test_near_each_principal_axis(axis: int, off: float) -> None:
    """The middle one is where the separatrices meet."""
    J = np.tile([1.0, 1.5, 2.2], (20, 1))
    P = momenta(J, off, 4)
    P[:, axis] += J[:, axis] * np.where(np.arange(20) % 2, 0.9, -0.9)
    check(J, P, 2.5e-15)


def test_a_symmetric_top_in_closed_form() -> None:
    """Any number of turns in one drift: it is cut into parts."""
    J, omega = np.array([1.0, 1.0, 1.7]), np.array([0.4, 0.1, 1.3])
    P = J * omega
    for h in (0.3, 7.0, 50.0, -7.0):
        precession = Rotation.from_rotvec(h * P / J[0])
        about_itself = Rotation.from_rotvec([0, 0, h * (1 / J[2] - 1 / J[0]) * P[2]])
        q, p, solved = turned(tuple(P), tuple(1 / J), h)
        assert solved
        np.testing.assert_allclose(
            Rotation.from_quat(q).as_matrix(), (precession * about_itself).as_matrix(), atol=3e-15 * (1 + abs(h))
        )
        np.testing.assert_allclose(p, about_itself.inv().apply(P), atol=3e-15 * (1 + abs(h)))


def test_two_halves_are_the_whole_and_back_again() -> None:
    J = bodies(200, 5)
    P = momenta(J, 0.9, 6)
    for k in range(len(J)):
        inverse = tuple(1 / J[k])
        whole, end, _ = turned(tuple(P[k]), inverse, 1.0)
        half, middle, _ = turned(tuple(P[k]), inverse, 0.5)
        other, also, _ = turned(middle, inverse, 0.5)
        np.testing.assert_allclose(also, end, atol=5e-15)
        product = (Rotation.from_quat(half) * Rotation.from_quat(other)).as_matrix()
        np.testing.assert_allclose(product, Rotation.from_quat(whole).as_matrix(), atol=5e-15)
        back, start, _ = turned(end, inverse, -1.0)
        np.testing.assert_allclose(start, P[k], atol=3e-15)
        np.testing.assert_allclose((Rotation.from_quat(whole) * Rotation.from_quat(back)).magnitude(), 0, atol=3e-14)


def test_side_by_side_as_one_by_one() -> None:
    J = bodies(200, 7)
    P = momenta(J, 0.4, 8)
    P[::17] = 0
    for k in range(0, len(J), 2):
        one, other = ((tuple(P[i]), tuple(1 / J[i])) for i in (k, k + 1))
        q2, p2, q1, p1, _, _ = both_turned(*one, *other, 1.0)
        for found, expected in ((q2, p2), turned(*one, 1.0)[:2]), ((q1, p1), turned(*other, 1.0)[:2]):
            np.testing.assert_allclose(found[0], expected[0], atol=5e-16)
            np.testing.assert_allclose(found[1], expected[1], atol=5e-16)


def test_what_does_not_spin_does_not_turn() -> None:
    for inverse in ((1.0, 0.5, 0.4), (0.0, 0.0, 0.0)):
        q, p, solved = turned((0.0, 0.0, 0.0), inverse, 10.0)
        assert solved
        np.testing.assert_array_equal(q, (0, 0, 0, 1))
        np.testing.assert_array_equal(p, (0, 0, 0))


@pytest.mark.parametrize("spin", [1e9, np.inf, np.nan])
def test_beyond_all_reason(spin: float) -> None:
    assert not turned((0.0, 0.1, spin), (1.0, 0.5, 0.4), 1.0)[2]
