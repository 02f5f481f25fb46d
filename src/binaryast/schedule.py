"""How a run is cut into equal steps, so that its duration and its saving interval are met exactly."""

from math import ceil, floor
from typing import NamedTuple

import numpy as np

from binaryast.errors import InputError, StepError
from binaryast.units import Floats

MOST_ROWS_BY_DEFAULT = 2000
MOST_ROWS = 10_000_000
ROWS_OF_UNEQUAL_STEPS = 1000  # by default
MOST_STEPS = 10**15  # beyond it, times would lose digits
SLACK = 1e-9  # relative: a duration of 8640.000000001 saving intervals has 8640 of them


class Segment(NamedTuple):
    """Equal steps: their size [s], how many, and after how many a row is saved."""

    step: float
    steps: int
    stride: int


def schedule(end: float, step: float, interval: float | None) -> list[Segment]:
    """Return the segments of a run: whole saving intervals, then what remains, each in equal steps up to ``step``."""
    if step > end * (1 + SLACK):
        raise StepError(
            f"step: {step:g} s is longer than the run of {end:g} s: give a smaller step or a longer duration"
        )
    if end / step > MOST_STEPS:
        raise StepError(f"step: {step:g} s makes {end / step:.3g} steps of the run of {end:g} s, expected at most 1e15")
    if interval is None:
        count = ceil(end / step * (1 - SLACK))
        stride = _stride(count)
        whole, rest = divmod(count, stride)
        segments = [Segment(end / count, whole * stride, stride), Segment(end / count, rest, max(rest, 1))]
    else:
        _check_interval(end, interval)
        stride = ceil(interval / step * (1 - SLACK))
        whole = floor(end / interval * (1 + SLACK))
        remaining = end - whole * interval
        rest = ceil(remaining / (interval / stride) * (1 - SLACK)) if remaining > SLACK * interval else 0
        segments = [
            Segment(interval / stride, whole * stride, stride),
            Segment(remaining / max(rest, 1), rest, max(rest, 1)),
        ]
    return [segment for segment in segments if segment.steps]


def row_times(end: float, interval: float | None) -> Floats:
    """Return when rows of a run are saved whose steps are not equal: every interval, and at the end."""
    if interval is None:
        return np.linspace(0.0, end, ROWS_OF_UNEQUAL_STEPS + 1)
    _check_interval(end, interval)
    times = np.arange(floor(end / interval * (1 + SLACK)) + 1) * interval
    if end - times[-1] <= SLACK * interval:
        times[-1] = end
        return times
    return np.append(times, end)


def _check_interval(end: float, interval: float) -> None:
    """Raise for an interval of saving that is longer than the run, or makes too many rows."""
    if interval > end * (1 + SLACK):
        raise StepError(
            f"save_every: {interval:g} s is longer than the run of {end:g} s: save more often, or run longer"
        )
    if end / interval * (1 + SLACK) >= MOST_ROWS + 1:
        raise InputError(
            f"save_every: {interval:g} s would keep {end / interval:.3g} rows, at most {MOST_ROWS} are possible"
        )


def _stride(count: int) -> int:
    """Return how many steps lie between rows by default: few enough rows, and a divisor where one is near."""
    least = ceil(count / (MOST_ROWS_BY_DEFAULT - 2))  # the start and what remains are rows too
    return next((stride for stride in range(least, min(2 * least, least + 10_000)) if count % stride == 0), least)
