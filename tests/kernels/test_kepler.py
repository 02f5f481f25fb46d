"""Kepler motion by universal variables: closed forms of every kind of orbit, halves, and the way back."""

import numba
import numpy as np
import pytest

from binaryast.kernels import kepler

GM = 2.5


@numba.njit(error_model="numpy")
def moved(x, v, gm, h):
    """Return how far position and velocity go."""
    return kepler.drift(x, v, gm, h)


def after(x: np.ndarray, v: np.ndarray, h: float) -> tuple[np.ndarray, np.ndarray]:
    dx, dv = moved(tuple(x), tuple(v), GM, h)
    return x + np.array(dx), v + np.array(dv)


def orbit(e: float, anomaly: float, a: float = 1.7) -> tuple[np.ndarray, np.ndarray, float]:
    """Return position, velocity and time since the pericentre, at an eccentric (or hyperbolic) anomaly."""
    n = np.sqrt(GM / a**3)
    if e < 1:
        b, c, s, r = np.sqrt(1 - e**2), np.cos(anomaly), np.sin(anomaly), 1 - e * np.cos(anomaly)
        return a * np.array([c - e, b * s, 0]), a * n / r * np.array([-s, b * c, 0]), (anomaly - e * s) / n
    b, c, s, r = np.sqrt(e**2 - 1), np.cosh(anomaly), np.sinh(anomaly), e * np.cosh(anomaly) - 1
    return a * np.array([e - c, b * s, 0]), a * n / r * np.array([-s, b * c, 0]), (e * s - anomaly) / n


@pytest.mark.parametrize("e", [0.0, 0.02, 0.3, 0.9, 0.99, 1.01, 1.5, 4.0])
def test_from_one_anomaly_to_another(e: float) -> None:
    anomalies = [-2.5, -1.0, -0.1, 0.0, 0.05, 0.4, 1.3, 2.9]
    for start in anomalies:
        for end in anomalies:
            x, v, begin = orbit(e, start)
            y, w, when = orbit(e, end)
            found, speed = after(x, v, when - begin)
            size = max(np.linalg.norm(x), np.linalg.norm(y)) * max(1.0, np.linalg.norm(v) / np.linalg.norm(w))
            worst = 3e-14 / abs(1 - e) if e else 5e-15  # the period is known as well as 1 - e is
            assert np.linalg.norm(found - y) < worst * size
            assert np.linalg.norm(speed - w) < 10 * worst * max(np.linalg.norm(v), np.linalg.norm(w))


@pytest.mark.parametrize("turns", [1e-6, 1e-3, 0.05, 0.3, 0.5, 1.0, 7.3, -0.3])
def test_a_circle(turns: float) -> None:
    r = 1.3
    n = np.sqrt(GM / r**3)
    x, v = r * np.array([1.0, 0, 0]), r * n * np.array([0, 1.0, 0])
    angle = 2 * np.pi * turns
    dx, dv = moved(tuple(x), tuple(v), GM, angle / n)
    half = np.sin(angle / 2)
    expected = r * np.array([-2 * half**2, np.sin(angle), 0])  # without cancellation, however small the angle
    np.testing.assert_allclose(dx, expected, rtol=0, atol=1.5e-15 * min(1, abs(angle)) * (1 + 4 * abs(turns)) * r)
    np.testing.assert_allclose(
        dv, n * np.array([-expected[1], expected[0], 0]), rtol=0, atol=2e-15 * (1 + 4 * abs(turns))
    )


@pytest.mark.parametrize("e", [0.1, 0.6, 0.9])
def test_many_revolutions(e: float) -> None:
    """Whole ones lead nowhere, but for the rounding of the time."""
    x, v, _ = orbit(e, 1.1)
    period = 2 * np.pi * np.sqrt(1.7**3 / GM)
    for turns in (1, 3, 1000):
        y, w = after(x, v, (turns + 0.3) * period)
        z, _ = after(x, v, 0.3 * period)
        assert np.linalg.norm(y - z) < 3e-14 * (turns + 1) / (1 - e)
        assert w @ w / 2 - GM / np.linalg.norm(y) == pytest.approx(-GM / (2 * 1.7), rel=3e-14 / (1 - e))


def test_a_parabola() -> None:
    """Barker's equation."""
    q = 0.8
    for start, end in ((-1.0, 2.0), (0.0, 0.1), (1.0, -3.0)):
        places = [q * np.array([1 - d * d, 2 * d, 0]) for d in (start, end)]
        times = [np.sqrt(2 * q**3 / GM) * (d + d**3 / 3) for d in (start, end)]
        rates = [1 / (np.sqrt(2 * q**3 / GM) * (1 + d * d)) for d in (start, end)]
        speeds = [q * np.array([-2 * d, 2, 0]) * rate for d, rate in zip((start, end), rates, strict=True)]
        x, v = after(places[0], speeds[0], times[1] - times[0])
        np.testing.assert_allclose(x, places[1], atol=1e-14 * np.linalg.norm(places[1]))
        np.testing.assert_allclose(v, speeds[1], atol=1e-14)


def test_straight_down() -> None:
    """A fall from rest: eccentricity 1, without a pericentre in the way."""
    r0 = 2.0
    for x in (1.9, 1.0, 0.3):
        angle = np.arccos(2 * x / r0 - 1)
        when = np.sqrt(r0**3 / (8 * GM)) * (angle + np.sin(angle))
        found, _ = after(np.array([r0, 0, 0]), np.zeros(3), when)
        np.testing.assert_allclose(found, [x, 0, 0], atol=1e-14)


def test_halves_and_back() -> None:
    random = np.random.default_rng(4)
    for _ in range(500):
        x, v = random.normal(size=(2, 3)) * [[2.0], [0.8]]
        h = random.uniform(-2, 2)
        y, w = after(x, v, h)
        z, _ = after(*after(x, v, h / 2), h / 2)
        rate = np.linalg.norm(v) + np.sqrt(2 * GM / min(np.linalg.norm(a) for a in (x, y)))
        worst = 3e-14 * (1 + (rate / min(np.linalg.norm(x), np.linalg.norm(y))) ** 2)
        assert np.linalg.norm(z - y) < worst
        back, _ = after(y, w, -h)
        assert np.linalg.norm(back - x) < worst


def test_what_is_no_number_is_said_so() -> None:
    dx, dv = moved((np.nan, 0.0, 1.0), (0.0, 1.0, 0.0), GM, 0.1)
    assert np.all(np.isnan(dx))
    assert np.all(np.isnan(dv))
