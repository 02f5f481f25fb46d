"""Timing in turns, errors against a reference, and the CPU time that an error takes."""

from collections.abc import Callable, Iterable, Sequence
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from binaryast.equations.legendre import Snapshot
from validation.differences import turns

ENOUGH = 2.0  # CPU seconds spent on one setting, after which it is not run again


class Run(NamedTuple):
    """One run: CPU seconds of its steps and of the whole call, and where the bodies are in the end."""

    seconds: float
    call: float
    end: Snapshot


class Candidate(NamedTuple):
    """A method with its setting, compiled and warm."""

    family: str
    method: str
    setting: str
    go: Callable[[], Run]


class Point(NamedTuple):
    """What a setting takes, at best, and the errors it leaves: of position, relative, and of all, attitudes in rad."""

    family: str
    method: str
    setting: str
    seconds: float
    call: float
    position: float
    everything: float


def errors(end: Snapshot, reference: Snapshot) -> tuple[float, float]:
    """Return the largest error of a body's place relative to the first, over its distance, and that of everything."""
    x, y = (at.x[1:].astype(float) - at.x[0].astype(float) for at in (end, reference))
    position = float(np.max(np.linalg.norm(x - y, axis=1) / np.linalg.norm(y, axis=1)))
    attitude = float(np.max(turns(end.R.astype(float), reference.R.astype(float))))
    return position, max(position, attitude)


def measure(candidates: Sequence[Candidate], reference: Snapshot, rounds: int) -> list[Point]:
    """Run all candidates in turn, round after round, and keep the shortest time of each."""
    runs: list[list[Run]] = [[] for _ in candidates]
    for _ in range(rounds):
        for candidate, done in zip(candidates, runs, strict=True):
            if sum(run.call for run in done) < ENOUGH:
                done.append(candidate.go())
    points = []
    for candidate, done in zip(candidates, runs, strict=True):
        at = errors(done[0].end, reference)
        best = min(run.seconds for run in done), min(run.call for run in done)
        points.append(Point(candidate.family, candidate.method, candidate.setting, *best, *at))
    return points


def front(points: Iterable[tuple[float, float]]) -> list[tuple[float, float]]:
    """Return the (error, time) that nothing quicker betters, the largest error first."""
    result: list[tuple[float, float]] = []
    for error, seconds in sorted(points, key=lambda point: (point[1], point[0])):
        if np.isfinite(error) and (not result or error < result[-1][0]):
            result.append((error, seconds))
    return result


def time_to_reach(target: float, points: Iterable[tuple[float, float]]) -> float | None:
    """Return the time at which the front of (error, time) passes an error; None where it does not get there.

    Between two points it is interpolated in logarithms; where the quickest is good enough already, it is that one's.
    """
    line = front(points)
    if not line or line[-1][0] > target:
        return None
    for (e1, t1), (e2, t2) in pairwise(line):
        if e2 <= target < e1:
            share = np.log(e1 / target) / np.log(e1 / max(e2, 1e-300))
            return float(t1 * (t2 / t1) ** share)
    return line[0][1]


class Best(NamedTuple):
    """The quickest method of a family to an error."""

    seconds: float
    method: str


def best(target: float, points: Sequence[Point], kind: str, *, call: bool = False) -> Best | None:
    """Return the quickest method among points to reach an error of a kind, each by its own front."""
    found = []
    for method in dict.fromkeys(point.method for point in points):
        of_method = [p for p in points if p.method == method]
        at = [(getattr(p, kind), p.call if call else p.seconds) for p in of_method]
        seconds = time_to_reach(target, at)
        if seconds is not None:
            found.append(Best(seconds, method))
    return min(found, default=None)
