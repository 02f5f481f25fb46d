"""Whether ellipsoids touch: against spheres, against minimisation, at tangency."""

import numpy as np
import pytest
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from binaryast.kernels import contact


def symmetric(matrix: np.ndarray) -> tuple:
    return tuple(matrix[np.triu_indices(3)])


def ellipsoid(axes: np.ndarray, turn: Rotation) -> np.ndarray:
    r = turn.as_matrix()
    return r @ np.diag(axes**2) @ r.T


def smallest_common_level(d: np.ndarray, a: np.ndarray, b: np.ndarray) -> float:
    """Return the smallest factor by which both ellipsoids must grow to touch, squared, by minimisation."""
    inverse_a, inverse_b = np.linalg.inv(a), np.linalg.inv(b)

    def level(x: np.ndarray) -> float:
        return x[3]

    bounds = [
        {"type": "ineq", "fun": lambda x: x[3] - x[:3] @ inverse_a @ x[:3]},
        {"type": "ineq", "fun": lambda x: x[3] - (x[:3] - d) @ inverse_b @ (x[:3] - d)},
    ]
    start = np.append(d / 2, 10.0)
    return float(minimize(level, start, constraints=bounds, method="SLSQP", options={"ftol": 1e-12}).fun)


def test_against_minimisation() -> None:
    random = np.random.default_rng(5)
    turns = Rotation.random(400, rng=random) if hasattr(Rotation, "__iter__") else Rotation.random(400, random)
    touched = 0
    for i in range(200):
        a = ellipsoid(random.uniform(0.3, 2, 3), turns[2 * i])
        b = ellipsoid(random.uniform(0.3, 2, 3), turns[2 * i + 1])
        d = random.normal(size=3) * 1.5
        level = smallest_common_level(d, a, b)
        assert contact.largest(tuple(d), symmetric(a), symmetric(b)) == pytest.approx(level, rel=2e-5)
        touched += level < 1
    assert 50 < touched < 150


@pytest.mark.parametrize("gap", [1e-7, -1e-7])
def test_tangent_ellipsoids(gap: float) -> None:
    a, b = np.diag([4.0, 1.0, 0.25]), np.diag([0.25, 9.0, 1.0])
    assert contact.largest((2.5 + gap, 0.0, 0.0), symmetric(a), symmetric(b)) == pytest.approx(
        (1 + gap / 2.5) ** 2, abs=1e-15
    )
    assert contact.largest((0.0, 4.0 + gap, 0.0), symmetric(a), symmetric(b)) == pytest.approx(
        (1 + gap / 4) ** 2, abs=1e-15
    )


def test_one_inside_the_other_touches() -> None:
    assert contact.largest((0.1, 0.0, 0.0), symmetric(np.eye(3)), symmetric(0.01 * np.eye(3))) < 1
