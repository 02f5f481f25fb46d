"""The implicit equation (128): both solvers against it, against each other, and at the edge of solvability."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from binaryast.kernels import implicit, so3


def bodies(count: int, seed: int) -> np.ndarray:
    """Return principal moments (count, 3) that masses can have, flat and needle-like ones among them."""
    second = np.random.default_rng(seed).uniform(1e-3, 1, (count, 3)) ** 2
    return second.sum(axis=1, keepdims=True) - second


def directions(count: int, seed: int) -> np.ndarray:
    vectors = np.random.default_rng(seed).normal(size=(count, 3))
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def ratios(moments: np.ndarray) -> tuple:
    a, b, c = moments
    return (b - c) / a, (c - a) / b, (a - b) / c


def residual(moments: np.ndarray, g: np.ndarray, quaternion: tuple) -> float:
    """Return the error of F J_d - J_d F^T = S(g), relative to g."""
    f = np.array(so3.quaternion_to_matrix(quaternion)).reshape(3, 3)
    nonstandard = np.diag(moments.sum() / 2 - moments)  # J_d
    return float(np.linalg.norm(so3.vee(f @ nonstandard - nonstandard @ f.T) - g) / np.linalg.norm(g))


@pytest.mark.parametrize("turn", [1e-9, 1e-4, 0.03, 0.2, 0.6, 0.95, 0.999])
def test_both_solvers_solve_the_equation(turn: float) -> None:
    for moments, n in zip(bodies(2000, 1), directions(2000, 2), strict=True):
        g = moments * n * turn  # h times the momentum of a spin with h Omega = turn
        c, iterations = implicit.solve_cayley(tuple(1 / moments), ratios(moments), tuple(g))
        assert iterations > 0
        assert residual(moments, g, so3.cayley(c)) < 1e-15 / min(turn, 0.1) + 1e-14
        f, printed = implicit.solve(np.diag(moments), g)
        assert printed > 0
        turned = 2 * np.arctan(np.linalg.norm(c)) * np.array(c) / np.linalg.norm(c)
        np.testing.assert_allclose(f, turned, rtol=0, atol=2e-13 * np.linalg.norm(f) / (1.001 - turn))


def test_two_or_three_iterations_in_normal_use() -> None:
    most = {"printed": 0, "production": 0}
    for moments, n in zip(bodies(3000, 3), directions(3000, 4), strict=True):
        g = moments * n * 0.2
        most["production"] = max(
            most["production"], implicit.solve_cayley(tuple(1 / moments), ratios(moments), tuple(g))[1]
        )
        most["printed"] = max(most["printed"], implicit.solve(np.diag(moments), g)[1])
    assert most["production"] <= 2
    assert most["printed"] <= 3


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_about_a_principal_axis_the_sine_of_the_turn_is_h_omega(axis: int) -> None:
    moments = np.array([1.0, 1.7, 2.1])
    for turn in (1e-8, 1e-3, 0.3, 0.9, 0.999):
        g = np.zeros(3)
        g[axis] = moments[axis] * turn
        c, _ = implicit.solve_cayley(tuple(1 / moments), ratios(moments), tuple(g))
        assert np.sin(2 * np.arctan(c[axis])) == pytest.approx(turn, rel=1e-15)
        f, _ = implicit.solve(np.diag(moments), g)
        assert np.sin(f[axis]) == pytest.approx(turn, rel=1e-15)


@pytest.mark.parametrize("turn", [1 + 1e-12, 1.0001, 1.1, 1.5, 10.0, 1e6, 1e200, np.inf, np.nan])
def test_no_solution_is_said_so(turn: float) -> None:
    for moments, n in zip(bodies(300, 5), directions(300, 6), strict=True):
        g = moments * n * turn
        assert implicit.solve_cayley(tuple(1 / moments), ratios(moments), tuple(g))[1] == -1
        assert implicit.solve(np.diag(moments), g)[1] == -1


@settings(max_examples=200)
@given(st.tuples(*[st.floats(-1e-3, 1e-3)] * 3))
def test_no_turn_and_tiny_turns(g: tuple) -> None:
    moments = np.array([2.0, 3.0, 4.0])
    c, iterations = implicit.solve_cayley(tuple(1 / moments), ratios(moments), g)
    assert iterations >= 0
    np.testing.assert_allclose(np.array(c), np.array(g) / (2 * moments), rtol=0, atol=1e-6)
    assert np.all(np.isfinite(c))


def test_not_a_number_is_not_solved() -> None:
    assert implicit.solve_cayley((1.0, 1.0, 1.0), (0.0, 0.0, 0.0), (np.nan, 0.0, 0.0))[1] == -1


def test_a_general_inertia_matrix_is_solved_in_its_own_axes() -> None:
    turn = so3.exp(np.array([0.3, -0.8, 0.5]))
    moments = np.array([1.0, 1.7, 2.1])
    g = np.array([0.02, 0.05, -0.03])
    f, _ = implicit.solve(turn @ np.diag(moments) @ turn.T, turn @ g)
    straight, _ = implicit.solve(np.diag(moments), g)
    np.testing.assert_allclose(f, turn @ straight, atol=1e-15)


def test_near_the_end_it_is_the_branch_of_small_turns() -> None:
    """Both cases once gave a turn of 127 degrees on another branch; the true one is found by following g up from 0."""
    cases = [
        ((0.10578262977590672, 0.1057873492422704, 4.877027989702358e-06), (0.9911285954, -0.1183706004, 0.0604359863)),
        ((1.29385984, 0.79051488, 0.50334498), (0.42085598, -0.46489546, 0.77894316)),
    ]
    for moments, direction in cases:
        moments, direction = np.array(moments), np.array(direction) / np.linalg.norm(direction)
        f = np.zeros(3)
        for turn in np.linspace(0, 0.99901, 4000)[1:]:
            g = moments * direction * turn
            for _ in range(8):
                f = f + np.linalg.solve(
                    implicit.gradient(np.diag(moments), f), g - implicit.residual_function(np.diag(moments), f)
                )
        c, iterations = implicit.solve_cayley(tuple(1 / moments), ratios(moments), tuple(g))
        assert iterations > 0
        assert 2 * np.arctan(np.linalg.norm(c)) == pytest.approx(np.linalg.norm(f), rel=1e-9)
