"""A run with impulses is a sequence of legs, each an ordinary run: where they are cut, and how they are joined."""

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np

from binaryast.impulses import AnyImpulse
from binaryast.occurrences import OccurrenceFloats
from binaryast.rows import TrajectoryFloats
from binaryast.schedule import Leg
from binaryast.trajectory import FIGURES, Trajectory
from binaryast.units import quantity


def cut(end: float, interval: float | None, impulses: Sequence[AnyImpulse]) -> list[tuple[Leg, list[AnyImpulse]]]:
    """Return the legs of a run up to its end [s], each with the impulses, in order of time, at its begin.

    The first leg has none: where there are some at the very start, it is a single row, the state before them. So is the
    last leg, the state after them, where there are some at the very end.
    """
    times = [0.0, *sorted({float(impulse.time.value) for impulse in impulses}), end]
    legs = [Leg(begin, stop, end, interval) for begin, stop in pairwise(times)]
    rest = [[impulse for impulse in impulses if float(impulse.time.value) == leg.begin] for leg in legs[1:]]
    return list(zip(legs, [[], *rest], strict=True))


def joined(runs: Sequence[Trajectory], impulses: tuple[AnyImpulse, ...]) -> Trajectory:
    """Return the legs as one run: all rows, the largest of each figure, and the cost of all."""
    if len(runs) == 1:
        return replace(runs[0], impulses=impulses) if impulses else runs[0]
    moved = [run for run in runs if run.steps] or list(runs)
    last, ended = moved[-1], runs[-1]
    steps = sum(run.steps for run in runs)
    step = max(run.step.value for run in moved)
    if last.integrator.adaptive and steps:
        step = sum(run.step.value * run.steps for run in moved) / steps
    figures: dict[str, Any] = {name: _largest([getattr(run, name) for run in moved]) for name in FIGURES}
    nearest = min(runs, key=lambda run: float(run.closest_approach.value))
    figures |= {name: getattr(nearest, name) for name in ("closest_approach", "closest_approach_time")}
    if any(run.estimated_error is None for run in moved):  # one of them is not known
        figures["estimated_error"] = None
    return replace(
        last,
        si=_rows(runs),
        status=ended.status,
        message=ended.message,
        steps=steps,
        step=quantity(step, "s"),
        wall_time=quantity(sum(run.wall_time.value for run in runs), "s"),
        choice="; then ".join(dict.fromkeys(run.choice for run in moved)),
        impulses=impulses,
        watched=max((run.watched for run in runs), key=len),
        occurrences=OccurrenceFloats.joined([run.occurrences for run in runs if run.occurrences is not None]),
        **figures,
    )


def _rows(runs: Sequence[Trajectory]) -> TrajectoryFloats:
    """Return the rows of all legs; each ends exactly when the next begins, not by round-off before or after.

    What came from outside adds up over the legs.
    """
    rows = TrajectoryFloats(*(np.concatenate(arrays) for arrays in zip(*(run.si for run in runs), strict=True)))
    ends = np.cumsum([len(run) for run in runs])
    begins = ends[:-1]
    rows.time[begins - 1] = rows.time[begins]
    for given in (rows.work, rows.impulse, rows.angular_impulse):
        for begin, end in pairwise(ends):
            given[begin:end] += given[begin - 1]
    return rows


def _largest(values: list[object]) -> object:
    """Return the largest of figures that are numbers, or quantities, or not known."""
    known = [value for value in values if value is not None]
    return max(known, key=_float) if known else None


def _float(figure: object) -> float:
    """Return a figure without its unit."""
    return float(getattr(figure, "value", figure))  # type: ignore[arg-type]
