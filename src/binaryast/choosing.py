"""Method and step for an accuracy that is asked for: by short trials, and a model of what a step costs.

No clock is read, so the same question has the same answer on every machine. A trial covers some orbits. There the error
of each method is measured against a run of order 10, and its step is shortened until that error, carried on to the end
of the run by the way in which it grows, is a fraction of what is asked; the cheapest method is taken. Whether this was
right is looked at when the run is over, see `estimate`.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import inf, log2
from typing import NamedTuple

import numpy as np

from binaryast.dense import difference
from binaryast.errors import AccuracyError
from binaryast.integrators import KeplerSplitting, Splitting, Stepping
from binaryast.outcome import Outcome
from binaryast.trials import LARGE, REFERENCE, ROWS, SMALL, Trials, at_end, between, equal, whole
from binaryast.units import quantity, span
from binaryast.working import Motion

SAFETY = 4.0  # of the accuracy, this fraction is aimed at
ORBITS = 10  # of the slowest pair, in a trial
FIRST = 3  # steps in the fastest orbit
MOST_KNOWN = 100.0  # by how much the coarser of two runs is taken to be worse, at the most
CLOSE = 1.1  # of two numbers of steps
LAST = 3  # rows, of which the worst counts
STAGE = {Splitting: 0.15, KeplerSplitting: 0.23}  # microseconds, beside gravity; of a pair, or of two bodies of several


class Plan(NamedTuple):
    """How a run is to be made.

    Attributes
    ----------
    integrator : Stepping
        Method and step.
    power : float
        With which power of the step its error falls there.
    error : float
        What the error at the end will be, as far as the trial can tell.
    floor : float or None
        What round-off leaves there, where the trial was the whole run: then the error is known.
    reason : str
        Why it was picked.
    """

    integrator: Stepping
    power: float
    error: float
    floor: float | None
    reason: str

    def shortened(self, step: float, factor: float) -> "Plan":
        """Return the same method with a shorter step [s]: its error was so many times what may be."""
        ratio = min(2.0, (SAFETY * factor) ** (1 / self.integrator.order))
        shorter, error = _stepping(self.integrator, step / ratio), self.error / ratio**self.power
        return self._replace(integrator=shorter, error=error, floor=None)


class Estimate(NamedTuple):
    """What is wrong at the end of a run: by the steps, and at least by round-off."""

    of_steps: float
    floor: float

    @property
    def error(self) -> float:
        """The larger of them."""
        return max(self)

    def within(self, accuracy: float) -> bool:
        """Whether it is within an accuracy; the part of the steps is only known to a factor."""
        return self.of_steps <= accuracy / 2 and self.floor <= accuracy


class Candidate(NamedTuple):
    """A method with the step that it needs, and what a second of the motion then costs in microseconds."""

    integrator: Stepping
    power: float
    error: float
    cost: float


class Goal(NamedTuple):
    """What a trial is held to: its rows, if it were right; its time and the run's [s]; error and longest step [s]."""

    reference: Motion
    time: float
    end: float
    error: float
    longest: float


def plan(trials: Trials, end: float, accuracy: float, longest: float) -> Plan:
    """Return the cheapest method for an accuracy at the end [s] of a run, with its step, at most the longest one [s].

    Raises
    ------
    AccuracyError
        Where not even a trial can be followed.
    """
    some = min(end, ORBITS * trials.slowest)
    time = trials.free_time(some)
    if time < some:  # a contact is the end
        end = time
    wanted = accuracy / SAFETY * time / end
    reference, segments, apart = trials.reference(time, wanted)
    if reference is None:
        raise AccuracyError(
            f"accuracy: no trial run comes to {span(time)}: give an integrator to see what happens there"
        )
    sensitivity = trials.sensitivity(REFERENCE, segments, reference)
    if sensitivity is not None:
        sensitivity.refuse(accuracy, time)
    if apart > accuracy:
        raise AccuracyError(
            f"accuracy: after {span(time)} trials still differ by {apart:.1g}, however short their steps: ask for a "
            "shorter run"
        )
    best: Candidate | None = None
    for method in methods(trials):
        found = _fitted(trials, method, Goal(reference, time, end, accuracy / SAFETY, longest), best)
        best = found or best
    if best is None:
        if sensitivity is not None:
            sensitivity.refuse(accuracy, end)
        raise AccuracyError(
            f"accuracy: {accuracy:g} is not reached after {span(time)} by any method, however short its steps"
        )
    count = sum(1 for _ in methods(trials))
    reason = (
        f"{type(best.integrator).__name__} {best.integrator.shares.name}, cheapest of {count} methods for "
        f"{accuracy:g} after {span(end)}, by trials over {span(time)}"
    )
    floor = sensitivity.floor if sensitivity is not None and time == end else None
    return Plan(best.integrator, best.power, best.error, floor, reason)


def _fitted(trials: Trials, method: Stepping, goal: Goal, best: Candidate | None) -> Candidate | None:
    """Return a method with the step that its error asks for; None where it costs more than the best so far."""
    count = whole(max(FIRST * goal.time / trials.fastest, goal.time / goal.longest))
    most = max(trials.most(goal.time), count)
    before: tuple[int, float] | None = None
    while count <= most:
        price = cost(trials, method, goal.time / count)
        if best is not None and price >= best.cost:
            return None
        error = _error(trials, method, goal, count)
        if error <= goal.error:
            if before is not None:
                count, error = _longer(trials, method, goal, before[0], (count, error))
            power = method.order if before is None else _power(before, (count, error), method.order)
            step = goal.time / count
            return Candidate(_stepping(method, step), power, error, cost(trials, method, step))
        if before is not None and before[1] < SMALL and error > before[1] / 2:  # round-off: it gets no better
            return None
        before = (count, error)
        count = whole(count * (1.5 if error == inf else min(2.0, max(1.1, (error / goal.error) ** (1 / method.order)))))
    return None


def _error(trials: Trials, method: Stepping, goal: Goal, count: int) -> float:
    """Return what the error of a method will be at the end of the run, by so many steps in the trial."""
    motion = trials.motion(method, equal(goal.time, count))
    return inf if motion is None else at_end(difference(motion, goal.reference), goal.end / goal.time)


def _longer(trials: Trials, method: Stepping, goal: Goal, too_few: int, found: tuple[int, float]) -> tuple[int, float]:
    """Return fewer steps than were found that are good enough too, with their error, where there are some."""
    while found[0] > CLOSE * too_few and too_few < (count := whole((too_few * found[0]) ** 0.5)) < found[0]:
        error = _error(trials, method, goal, count)
        if error <= goal.error:
            found = (count, error)
        else:
            too_few = count
    return found


def _stepping(method: Stepping, step: float) -> Stepping:
    """Return a method with another step [s]."""
    return replace(method, step=quantity(step, "s"))  # type: ignore[type-var]


def _power(one: tuple[int, float], other: tuple[int, float], order: int) -> float:
    """Return with which power of the step an error falls between two numbers of steps."""
    if not (0 < other[1] < one[1] < inf):
        return float(order)
    return min(float(order), max(0.6 * order, log2(one[1] / other[1]) / log2(other[0] / one[0])))


def cost(trials: Trials, integrator: Stepping, step: float) -> float:
    """Return what a second of the motion costs, in microseconds."""
    bodies, pairs = trials.system.bodies, trials.system.pairs
    stage = STAGE[type(integrator)] * len(bodies) / 2
    gravity = sum(pair.gravity.evaluation_time(bodies[pair.secondary], bodies[pair.primary]) for pair in pairs)
    return integrator.shares.stages * (stage + gravity) / step


def methods(trials: Trials) -> Iterator[Stepping]:
    """Yield the methods that can follow this system."""
    one = quantity(1.0, "s")
    for scheme in ("rkn4", "rkn6a", "ss10"):
        yield Splitting(one, scheme)
    if len(trials.system.bodies) == 2 and KeplerSplitting.is_bound(trials.system, trials.state):
        for scheme in KeplerSplitting.schemes:
            yield KeplerSplitting(one, scheme)


def estimate(trials: Trials, plan: Plan, outcome: Outcome, accuracy: float) -> Estimate | None:
    """Return the error at the end of a run, by another with steps of another length; None where that one breaks off.

    They are compared at some of the saved rows, of which the last three count: at one instant an error may pass zero.

    Raises
    ------
    AccuracyError
        Where round-off leaves more than is asked.
    """
    if plan.floor is not None:
        return Estimate(plan.error, plan.floor)
    chosen = np.unique(np.linspace(0, len(outcome.time) - 1, ROWS + 1).round().astype(int))
    times = outcome.time[chosen] - outcome.time[0]
    rows = Motion(*(array[chosen] for array in outcome.motion))
    for longer in (2.0, 1.5, 1 / 1.5):
        segments = between(times, outcome.step * longer)
        other = trials.motion(plan.integrator, segments)
        if other is not None:
            break
    else:
        return None
    sensitivity = trials.sensitivity(plan.integrator, segments, other)
    if sensitivity is not None:
        sensitivity.refuse(accuracy, float(times[-1]))
    floor = 0.0 if sensitivity is None else sensitivity.floor
    ratio = max(segment.step for segment in segments) / outcome.step
    apart = float(difference(rows, other)[-LAST:].max())
    known = abs(ratio**plan.power - 1) if apart < LARGE else 1.0  # of errors that follow the power
    return Estimate(max(plan.error, apart / float(min(max(known, 0.1), MOST_KNOWN))), floor)
