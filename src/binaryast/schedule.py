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
ROUNDING = 1e-13  # the same of an impulse, whose time is kept: only round-off puts it on a saving time


class Leg(NamedTuple):
    """A run, or the part of one between two impulses, in seconds since the start of the whole run.

    Attributes
    ----------
    begin, end : float
        When it begins and ends.
    whole : float
        How long the whole run is.
    interval : float or None
        Rows are saved at the multiples of it that lie between.
    """

    begin: float
    end: float
    whole: float
    interval: float | None

    @classmethod
    def of_run(cls, end: float, interval: float | None = None) -> "Leg":
        """Return a whole run as one leg."""
        return cls(0.0, end, end, interval)

    @property
    def length(self) -> float:
        """How long it takes."""
        return self.end - self.begin

    @property
    def slack(self) -> float:
        """How far, relatively, its end may be from a saving time that it is taken for."""
        return SLACK if self.end == self.whole else ROUNDING


class Segment(NamedTuple):
    """Equal steps: their size [s], how many, and after how many a row is saved."""

    step: float
    steps: int
    stride: int


def schedule(leg: Leg, step: float) -> list[Segment]:
    """Return the segments of a leg, in equal steps up to ``step``.

    They are what is left of a saving interval at its begin, whole intervals, and what remains at its end.
    """
    whole, interval = leg.whole, leg.interval
    if step > whole * (1 + SLACK):
        raise StepError(
            f"step: {step:g} s is longer than the run of {whole:g} s: give a smaller step or a longer duration"
        )
    if whole / step > MOST_STEPS:
        raise StepError(
            f"step: {step:g} s makes {whole / step:.3g} steps of the run of {whole:g} s, expected at most 1e15"
        )
    if interval is None:
        count = ceil(leg.length / step * (1 - SLACK))
        stride = _stride(count, ceil(whole / step * (1 - SLACK)))
        equal = leg.length / count
        intervals, rest = divmod(count, stride)
        segments = [Segment(equal, intervals * stride, stride), Segment(equal, rest, max(rest, 1))]
    else:
        _check_interval(whole, interval)
        stride = ceil(interval / step * (1 - SLACK))
        equal = interval / stride
        first, last = ceil(leg.begin / interval * (1 - ROUNDING)), floor(leg.end / interval * (1 + leg.slack))
        if last < first:  # it lies within an interval
            return [_one_row(leg.length, equal)]
        head, tail = first * interval - leg.begin, leg.end - last * interval
        segments = [
            *([_one_row(head, equal)] if head > ROUNDING * leg.begin else []),
            Segment(equal, (last - first) * stride, stride),
            *([_one_row(tail, equal)] if tail > leg.slack * interval else []),
        ]
    return [segment for segment in segments if segment.steps] or [_one_row(leg.length, equal)]


def _one_row(length: float, step: float) -> Segment:
    """Return a segment of equal steps up to ``step`` with a row at its end."""
    count = max(1, ceil(length / step * (1 - SLACK)))
    return Segment(length / count, count, count)


def row_times(leg: Leg) -> Floats:
    """Return when rows of a leg of unequal steps are saved, since its begin: at every interval, and at the end."""
    interval = leg.interval
    if interval is None:
        return np.linspace(0.0, leg.length, max(1, round(ROWS_OF_UNEQUAL_STEPS * leg.length / leg.whole)) + 1)
    _check_interval(leg.whole, interval)
    first, last = floor(leg.begin / interval * (1 + ROUNDING)) + 1, floor(leg.end / interval * (1 + leg.slack))
    between = np.arange(first, last + 1) * interval - leg.begin
    if len(between) and leg.length - between[-1] <= leg.slack * interval:
        between = between[:-1]
    return np.array([0.0, *between, leg.length])


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


def _stride(count: int, of_run: int) -> int:
    """Return how many steps lie between rows by default: few enough rows, and a divisor where one is near.

    They are few enough for the steps of the whole run, of which those of a leg are ``count``.
    """
    least = ceil(of_run / (MOST_ROWS_BY_DEFAULT - 2))  # the start and what remains are rows too
    return next((stride for stride in range(least, min(2 * least, least + 10_000)) if count % stride == 0), least)
