"""Numbers that are taken from series: the limit of a quantity, frequencies of a motion, its mean rate."""

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np


def to_zero(values: Sequence[Any], power: float = 2, then: float = 2) -> Any:
    """Return the limit of values at sizes each half of the one before: Richardson's extrapolation.

    The error is a series in the size, of ``power``, ``power + then``, ``power + 2 then`` and so on.
    """
    factor = 2.0**power
    while len(values) > 1:
        values = [fine + (fine - coarse) / (factor - 1) for coarse, fine in pairwise(values)]
        factor *= 2.0**then
    return values[0]


def frequencies(time: np.ndarray, values: np.ndarray, guesses: Sequence[float], rounds: int = 8) -> np.ndarray:
    """Return the angular frequencies of a sum of oscillations near the guesses, by least squares (Gauss-Newton).

    A guess must be so near that over the time it falls out of step by less than about a radian.
    """
    found = np.array(guesses, dtype=float)
    time = time - time.mean()
    for _ in range(rounds):
        phases = np.outer(time, found)
        cosines, sines = np.cos(phases), np.sin(phases)
        waves = np.hstack([cosines, sines])
        a, b = np.split(np.linalg.lstsq(waves, values)[0], 2)
        by_frequency = time[:, None] * (b * cosines - a * sines)
        found = found + np.linalg.lstsq(np.hstack([waves, by_frequency]), values)[0][-len(found) :]
    return found


def mean_rate(time: np.ndarray, values: np.ndarray) -> float:
    """Return the mean rate of a quantity that runs on and oscillates, from equally spaced values.

    Increments are averaged with the weight exp(-1/(s (1 - s))): oscillations fall out faster than any power of their
    number (Das, Saiki, Sander, Yorke, Nonlinearity 30 (2017) 4111).
    """
    s = (np.arange(len(time) - 1) + 0.5) / (len(time) - 1)
    weights = np.exp(-1 / (s * (1 - s)))
    return float(weights @ np.diff(values) / (weights.sum() * (time[1] - time[0])))
