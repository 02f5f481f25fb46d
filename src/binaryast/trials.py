"""Short runs to be compared: how far they are apart, how errors and disturbances grow along them."""

from collections.abc import Callable
from dataclasses import replace
from math import ceil, inf, log2, pi
from typing import NamedTuple

import numpy as np

from binaryast.dense import difference
from binaryast.errors import AccuracyError, StepError
from binaryast.integrators import Splitting, Stepping
from binaryast.outcome import Outcome
from binaryast.rates import rates
from binaryast.schedule import SLACK, Segment
from binaryast.state import State
from binaryast.stepping import SteppedRun
from binaryast.system import System
from binaryast.units import Floats, quantity, span
from binaryast.working import Motion

ROWS = 8  # at which runs are compared
MOST = 20_000  # steps in the fastest orbit
DISTURBANCES = (1e-9, 1e-13)  # of velocities and spins, to see how errors grow; the other where the first grows large
LARGE = 1e-2  # of a difference: it grows no more in proportion
ROUNDING = 1e-15  # as if the start had been wrong by so much
LEAST = 5000  # of that bound, for runs of less than an orbit
SMALL = 1e-9  # an error that does not fall any more below this is round-off
REFERENCE = Splitting(quantity(1.0, "s"), "ss10")
SHORT_STEPS = Splitting(quantity(1.0, "s"), "rkn6a")  # to see whether bodies touch


def whole(count: float) -> int:
    """Return a number of steps of a trial, the same in each of its rows."""
    return ROWS * max(1, ceil(count / ROWS))


def equal(time: float, count: float) -> list[Segment]:
    """Return at least so many equal steps in a time, with `ROWS` rows."""
    steps = whole(count)
    return [Segment(time / steps, steps, steps // ROWS)]


def between(times: Floats, step: float) -> list[Segment]:
    """Return segments from each of some times to the next, in equal steps up to a length [s], with a row at each."""
    counts = [max(1, ceil(apart / step * (1 - SLACK))) for apart in np.diff(times).tolist()]
    return [Segment(apart / count, count, count) for apart, count in zip(np.diff(times).tolist(), counts, strict=True)]


def row_ends(segments: list[Segment]) -> Floats:
    """Return the times of the rows of segments, the start first."""
    times = [0.0]
    for segment in segments:
        begin = times[-1]
        times += [begin + k * segment.stride * segment.step for k in range(1, segment.steps // segment.stride + 1)]
    return np.array(times)


def at_end(rows: Floats, longer: float) -> float:
    """Return the error at the end of a run that is so many times longer, growing as in the trial: t to t^2."""
    return float(rows[len(rows) // 2 + 1 :].max() * longer ** growth_of(rows))


def growth_of(rows: Floats) -> float:
    """Return with which power of the time what is in the rows grows from the second to the last quarter: 1 to 2."""
    quarter = (len(rows) - 1) // 4
    middle, last = (
        float(rows[quarter + 1 : 2 * quarter + 1].max(initial=0)),
        float(rows[3 * quarter + 1 :].max(initial=0)),
    )
    return 1.0 if not 0 < middle < last < inf else min(2.0, max(1.0, log2(last / middle)))


class Sensitivity(NamedTuple):
    """How much of a disturbance of the start is left at times since: a factor for each of the rows."""

    times: Floats
    factors: Floats

    @property
    def floor(self) -> float:
        """What round-off alone leaves at the end."""
        return ROUNDING * float(self.factors[-1])

    def refuse(self, accuracy: float, end: float) -> None:
        """Raise where round-off leaves more than is asked at a later end [s], growing on as in the second half.

        Raises
        ------
        AccuracyError
            With what can be reached, and until when the accuracy holds.
        """
        longer, growth = end / self.times[-1], growth_of(self.factors)
        floor = self.floor * longer**growth
        if floor <= accuracy:
            return
        if self.floor <= accuracy:
            held = self.times[-1] * (accuracy / self.floor) ** (1 / growth)
        else:
            known = np.isfinite(self.factors)
            grown = np.log(np.maximum.accumulate(np.maximum(self.factors[known], 1.0)))
            held = float(np.interp(np.log(accuracy / ROUNDING), grown, self.times[known]))
        horizon = f"it can be had for the first {span(held)}" if held > 0 else "it cannot be had for any time"
        if floor < inf:
            left = f"is below what round-off leaves, about {floor:.1g}"
            why = f"a disturbance of the start grows {floor / ROUNDING:.2g} times"
        else:
            left, why = "is lost to round-off", "a disturbance of the start grows until nothing of the motion is left"
        raise AccuracyError(f"accuracy: {accuracy:g} after {span(end)} {left}, for {why}; {horizon}")


class Trials:
    """A system and its start, of which runs are made to compare them.

    Attributes
    ----------
    begin : float
        The time of the start [s].
    fastest, slowest : float
        The shortest and longest periods of pairs, as they are at the start [s].
    show : callable
        Takes how far a run is [s].
    """

    def __init__(self, system: System, state: State, begin: float = 0.0) -> None:
        self.system, self.state, self.begin = system, state, begin
        found = [rate for _, rate in rates(system, state)]
        self.fastest, self.slowest = (2 * pi / rate for rate in (max(found), min(found)))
        self.show: Callable[[float], None] = lambda _: None

    def most(self, time: float) -> float:
        """Return how many steps a run may have."""
        return max(MOST * time / self.fastest, LEAST)

    def outcome(self, integrator: Stepping, segments: list[Segment], state: State | None = None) -> Outcome:
        """Return a run by segments of equal steps, of this start or another."""
        run = SteppedRun(self.system, state or self.state, integrator, segments, self.begin)
        run.go(self.show)
        if run.pressed:
            raise KeyboardInterrupt
        return run.outcome()

    def motion(self, integrator: Stepping, segments: list[Segment], state: State | None = None) -> Motion | None:
        """Return the rows, None where the run does not come to its end."""
        try:
            outcome = self.outcome(integrator, segments, state)
        except StepError:
            return None
        return outcome.motion if outcome.status == "completed" else None

    def free_time(self, time: float) -> float:
        """Return a time, or most of the time until two bodies touch, where they do before."""
        outcome = self.outcome(SHORT_STEPS, equal(time, 400 * time / self.fastest))
        return 0.9 * float(outcome.time[-1]) if outcome.status == "contact" else time

    def reference(self, time: float, wanted: float) -> tuple[Motion | None, list[Segment], float]:
        """Return rows that are right to a fraction of what is wanted, or to round-off, the steps, and how right."""
        count = whole(12 * time / self.fastest)
        segments = equal(time, count)
        best, last, stalls = self.motion(REFERENCE, segments), inf, 0
        while count < self.most(time):
            count = whole(1.5 * count)
            before, segments = best, equal(time, count)
            best = self.motion(REFERENCE, segments)
            if best is not None and before is not None:
                apart = float(difference(before, best).max())
                stalls = stalls + 1 if apart > last / 2 else 0
                if apart < wanted / 30 or (stalls and last < SMALL) or stalls == 3:  # shorter steps do not help
                    return best, segments, apart
                last = apart
        return best, segments, last

    def sensitivity(self, integrator: Stepping, segments: list[Segment], undisturbed: Motion) -> Sensitivity | None:
        """Return how a disturbance of velocities and spins grows along a run."""
        times = row_ends(segments)
        for disturbance in DISTURBANCES:
            more = 1 + disturbance
            disturbed = replace(self.state, velocity=self.state.velocity * more, spin=self.state.spin * more)
            motion = self.motion(integrator, segments, disturbed)
            if motion is None:
                return None
            apart = difference(motion, undisturbed)
            if apart.max() < LARGE:
                return Sensitivity(times, apart / disturbance)
        factors = np.where(np.maximum.accumulate(apart) < LARGE, apart / disturbance, inf)  # it is lost in the end
        return Sensitivity(times, factors)
