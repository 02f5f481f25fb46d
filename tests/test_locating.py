"""Roots of functions: passes, turns that cross zero by a little, touch it, or stay away."""

from math import acos, cos, sin

import numpy as np
import pytest

from binaryast import locating
from binaryast.kernels.events.notice import MARKS, PERIOD


def test_a_root_takes_few_looks() -> None:
    looks = []

    def g(t: float) -> float:
        looks.append(t)
        return cos(t) - 0.3

    assert locating.root(g, 0.0, g(0.0), 3.0, g(3.0), 0.0) == pytest.approx(acos(0.3), rel=3e-16)
    assert len(looks) < 14
    looks.clear()
    assert locating.root(g, 0.0, 0.7, 3.0, -1.3, 1e-2) == pytest.approx(acos(0.3), abs=1e-2)
    assert len(looks) < 8


def test_a_jump_through_zero_is_found_as_well() -> None:
    found = locating.root(lambda t: -1.0 if t < 0.7 else 1e9, 0.0, -1.0, 1.0, 1e9, 0.0)
    assert found == pytest.approx(0.7, rel=1e-15)


@pytest.mark.parametrize("depth", [1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-14])
def test_two_roots_that_are_near_each_other(depth: float) -> None:
    """However g lies beside the looks, of which there are six in two radians."""
    for shift in np.linspace(0.011, 1.97, 67):
        found = locating.within(lambda t, s=shift: 1 - cos(t - s) - depth, 0.0, 2.0, 6, 0.0)
        apart = acos(1 - depth)
        expected = [shift - apart, shift + apart]
        assert [one.direction for one in found] == [d for d, t in zip([-1, 1], expected, strict=True) if 0 < t < 2]
        times = [t for t in expected if 0 < t < 2]
        np.testing.assert_allclose([one.time for one in found], times, atol=3e-16 / depth**0.5 + 1e-15)


def test_a_touch_counts_where_both_directions_do() -> None:
    for shift in np.linspace(0.05, 1.95, 30):
        for sign in (1, -1):
            (found,) = locating.within(lambda t, s=shift, k=sign: k * (1 - cos(t - s)), 0.0, 2.0, 6, 0.0)
            assert found.direction == 0
            assert found.time == pytest.approx(shift, abs=1e-11)
        for direction in (1, -1):
            assert locating.within(lambda t, s=shift: 1 - cos(t - s) + 1e-13, 0.0, 2.0, 6, 0.0, direction) == []
        assert locating.within(lambda t, s=shift: 1 - cos(t - s) + 1e-6, 0.0, 2.0, 6, 0.0) == []


def test_roots_near_the_ends() -> None:
    for first, second in ((0.0012, 0.003), (0.9968, 0.9985), (0.0012, 0.9985)):
        found = locating.within(lambda t, a=first, b=second: (t - a) * (t - b), 0.0, 1.0, 4, 0.0)
        assert [one.time for one in found] == pytest.approx([first, second], rel=1e-13)


def test_directions_and_periods() -> None:
    up = locating.within(sin, 0.5, 20.0, 60, 0.0, 1)
    assert [one.time for one in up] == pytest.approx([2 * np.pi, 4 * np.pi, 6 * np.pi], rel=1e-15)

    def angle(t: float) -> float:
        return (t + np.pi) % (2 * np.pi) - np.pi

    marks = np.zeros((1, MARKS))
    marks[0, PERIOD] = 2 * np.pi
    found = locating.findings(lambda _, t: angle(t), marks, 0.5, 20.0, 60)
    times = [root.time for one in found for root in locating.resolve(angle, one, 0, 0.0)]
    assert times == pytest.approx([2 * np.pi, 4 * np.pi, 6 * np.pi], rel=1e-15)


def test_what_is_no_number_is_no_root() -> None:
    assert locating.within(lambda t: float("nan"), 0.0, 1.0, 6, 0.0) == []
