"""Monomials and solid harmonics against SciPy's Legendre functions and against themselves in other frames."""

from math import factorial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.special import lpmv

from binaryast.kernels import harmonics, moments

N = 9
POINTS = np.random.default_rng(4).normal(size=(5, 3))
FRACTIONS = np.array([0.1, 0.3, 0.2, 0.15, 0.25])


def test_the_order_of_monomials() -> None:
    rows = moments.exponents(N)
    assert len(rows) == moments.count(N)
    assert rows[:10].tolist() == [
        *([0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]),
        *([2, 0, 0], [1, 1, 0], [1, 0, 1], [0, 2, 0], [0, 1, 1], [0, 0, 2]),
    ]
    assert [moments.index(*row) for row in rows.tolist()] == list(range(len(rows)))


def test_moments_in_another_frame() -> None:
    origin, turn = np.array([0.3, -0.2, 0.5]), Rotation.from_rotvec([0.4, 1.0, -0.3]).as_matrix()
    here, there = (
        moments.of_points(points, FRACTIONS, degree) for points, degree in ((POINTS, N), ((POINTS - origin) @ turn, N))
    )
    np.testing.assert_allclose(moments.moved(here, N, origin, turn), there, rtol=1e-11, atol=1e-12)
    for degree in (0, 1, 2):
        lower = moments.of_points(POINTS, FRACTIONS, degree)
        np.testing.assert_allclose(moments.moved(lower, degree, origin, turn), there[: len(lower)], atol=1e-14)


def test_harmonics_of_a_point() -> None:
    """R_lm = r^l P_lm(cos theta) e^(i m phi)/(l + m)!, without the sign that SciPy's P_lm has."""
    x = POINTS[0]
    r, phi = np.linalg.norm(x), np.arctan2(x[1], x[0])
    c, s = harmonics.harmonic_moments(moments.of_points(x[None], np.ones(1), N), N)
    for l in range(N + 1):
        for m in range(l + 1):
            size = r**l / factorial(l + m)
            value = size * (-1) ** m * lpmv(m, l, x[2] / r) * np.exp(1j * m * phi)
            assert c[harmonics.place(l, m)] + 1j * s[harmonics.place(l, m)] == pytest.approx(
                value, abs=1e-13 * abs(value)
            )


def test_the_exchange_of_axes() -> None:
    here, there = (
        harmonics.harmonic_moments(moments.of_points(points, FRACTIONS, N), N)
        for points in (POINTS, POINTS[:, ::-1] * [-1, 1, 1])
    )
    for l in range(N + 1):
        rows = slice(harmonics.place(l, 0), harmonics.place(l + 1, 0))
        for matrix, old, new in zip(harmonics.exchange(l), here, there, strict=True):
            np.testing.assert_allclose(matrix @ old[rows], new[rows], atol=1e-14 * np.abs(old[rows]).max())
            assert np.count_nonzero(matrix) <= (l + 1) ** 2 / 2 + 1


def test_monomials_of_given_harmonics() -> None:
    """The same harmonics, and nothing that they do not say: moments of r^2 times anything vanish."""
    c, s = harmonics.harmonic_moments(moments.of_points(POINTS, FRACTIONS, N), N)
    monomials = harmonics.monomial_moments(c, s, N)
    again = harmonics.harmonic_moments(monomials, N)
    np.testing.assert_allclose(again, (c, s), atol=1e-15)
    for i, j, k in moments.exponents(N - 2).tolist():
        places = [moments.index(i + 2, j, k), moments.index(i, j + 2, k), moments.index(i, j, k + 2)]
        assert abs(monomials[places].sum()) < 1e-14 * np.abs(monomials).max()
