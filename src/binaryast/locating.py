"""When something happens that was noticed between looks: a function passes through zero, or turns at it."""

from collections.abc import Callable, Sequence
from math import isfinite
from typing import NamedTuple

import numpy as np

from binaryast.kernels.events.notice import DIRECTION, LOOKS, MARKS, NOTHING, PASS, TIMES, VALUES, notice
from binaryast.units import Floats

EPSILON = 2.0**-52
MOST_LOOKS = 100  # for one root, which needs about ten
EDGE = 1e-3  # of an interval: a look so near to its end tells which way g goes there
SHIFT = 1e-2  # of the distance of three looks: for a derivative whose error, of order 4, is below round-off
TOUCH = 1e-9  # of what g changes about a turn: so near to zero it touches it


class Root(NamedTuple):
    """When, and in which direction: 1 upwards, -1 downwards, 0 where zero is touched."""

    time: float
    direction: int


def root(g: Callable[[float], float], a: float, g_a: float, b: float, g_b: float, accuracy: float) -> float:
    """Return where g is zero between a and b, at which it has other signs, to an accuracy, or to round-off.

    It is Chandrupatla's method: inverse quadratic interpolation where that can be trusted, else bisection (Adv. Eng.
    Softw. 28, 145, 1997).
    """
    if g_a == 0.0 or g_b == 0.0:
        return a if g_a == 0.0 else b
    c, g_c, t = a, g_a, 0.5
    for _ in range(MOST_LOOKS):
        x = a + t * (b - a)
        g_x = g(x)
        if (g_x < 0.0) == (g_a < 0.0):
            c, g_c = a, g_a
        else:
            c, b, g_c, g_b = b, a, g_b, g_a
        a, g_a = x, g_x
        best, g_best = (a, g_a) if abs(g_a) < abs(g_b) else (b, g_b)
        smallest = 2.0 * EPSILON * abs(best) + 0.5 * accuracy
        limit = smallest / abs(b - a) if b != a else 1.0
        if limit > 0.5 or g_best == 0.0:
            return best
        xi, phi = (a - b) / (c - b), (g_a - g_b) / (g_c - g_b)
        t = 0.5
        if phi * phi < xi and (1.0 - phi) ** 2 < 1.0 - xi:
            t = g_a / (g_b - g_a) * g_c / (g_b - g_c) + (c - a) / (b - a) * g_a / (g_c - g_a) * g_b / (g_c - g_b)
        t = min(1.0 - limit, max(limit, t))
    return best


def turn(g: Callable[[float], float], a: float, b: float, accuracy: float) -> float | None:
    """Return where g turns between a and b, None where it does not: where its derivative is zero.

    It is asked for g a little beyond both.
    """
    shift = SHIFT * (b - a)

    def derivative(t: float) -> float:
        return 8.0 * (g(t + shift) - g(t - shift)) - (g(t + 2.0 * shift) - g(t - 2.0 * shift))

    at_a, at_b = derivative(a), derivative(b)
    if not isfinite(at_a) or not isfinite(at_b) or (at_a < 0.0) == (at_b < 0.0):
        return None
    return root(derivative, a, at_a, b, at_b, accuracy)


def resolve(g: Callable[[float], float], finding: Sequence[float], direction: int, accuracy: float) -> list[Root]:
    """Return the roots of what was found, in order of time: one of a pass; of a turn two, one or none."""
    t0, t1, t2, g0, g1, g2 = (float(number) for number in finding[LOOKS:])
    if finding[1] == PASS:
        return [Root(root(g, t1, g1, t2, g2, accuracy), 1 if g2 > g1 else -1)]
    when = turn(g, t0, t2, accuracy)
    if when is None:
        return []
    lowest = g(when)
    sign = -1 if g1 < 0.0 else 1
    if lowest * sign < 0.0:
        roots = [
            Root(root(g, t0, g0, when, lowest, accuracy), -sign),
            Root(root(g, when, lowest, t2, g2, accuracy), sign),
        ]
        return [one for one in roots if one.direction * direction >= 0]
    if direction == 0 and abs(lowest) <= TOUCH * max(abs(g1 - g0), abs(g2 - g1)):
        return [Root(when, 0)]
    return []


def looks_within(count: int) -> list[float]:
    """Return fractions of an interval at which it is looked at, by itself: also near its ends, for what turns there."""
    return [EDGE, *(k / count for k in range(1, count)), 1.0 - EDGE, 1.0]


def findings(
    value: Callable[[int, float], float], marks: Floats, begin: float, end: float, count: int
) -> list[list[float]]:
    """Return what is found in an interval by ``count`` looks at several functions, of which there are fresh marks."""
    found: list[list[float]] = []
    for fraction in [0.0, *looks_within(count)]:
        when = end if fraction == 1.0 else begin + fraction * (end - begin)
        for k in range(len(marks)):
            kind = notice(marks, k, when, value(k, when))
            if kind != NOTHING:
                found.append([float(k), kind, *marks[k, TIMES : VALUES + 3].tolist()])
    return found


def within(
    g: Callable[[float], float], begin: float, end: float, count: int, accuracy: float, direction: int = 0
) -> list[Root]:
    """Return the roots of a function in an interval, in order of time, by ``count`` looks.

    Each is found, also two that are near each other, where g turns at most once in three looks.
    """
    marks = np.zeros((1, MARKS))
    marks[0, DIRECTION] = direction
    roots: list[Root] = []
    for finding in findings(lambda _, time: g(time), marks, begin, end, count):
        roots += resolve(g, finding, direction, accuracy)
    return sorted(roots)
