"""Method and step for an accuracy that is asked for: by short trials, and a model of what a step costs.

No clock is read, so the same question has the same answer on every machine. A trial covers some orbits. There the error
of each method is measured against a run of order 10, and its step is shortened until that error, carried on to the end
of the run by the way in which it grows, is a fraction of what is asked; the cheapest method is taken. Whether this was
right is looked at when the run is over, see `Problem.estimate`.
"""

from collections.abc import Iterator
from dataclasses import replace
from math import ceil, inf, log2, pi, sqrt
from typing import NamedTuple

import numpy as np

from binaryast.errors import AccuracyError, StepError
from binaryast.integrators import KeplerSplitting, Splitting, Stepping
from binaryast.outcome import Outcome
from binaryast.schedule import Segment
from binaryast.state import State
from binaryast.stepping import SteppedRun
from binaryast.system import Pair, System
from binaryast.units import Floats, quantity, span
from binaryast.working import Motion

SAFETY = 4.0  # of the accuracy, this fraction is aimed at
ROWS = 8  # at which runs are compared
ORBITS = 10  # of the slowest pair, in a trial
FIRST = 3  # steps in the fastest orbit
MOST = 20_000  # steps in the fastest orbit
DISTURBANCES = (1e-9, 1e-13)  # of velocities and spins, to see how errors grow; the other where the first grows large
LARGE = 1e-2  # of a difference: it grows no more in proportion
ROUNDING = 1e-15  # as if the start had been wrong by so much
SMALL = 1e-9  # an error that does not fall any more below this is round-off
REFERENCE = Splitting(quantity(1.0, "s"), "ss10")
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
    reason : str
        Why it was picked.
    """

    integrator: Stepping
    power: float
    error: float
    reason: str

    def shortened(self, step: float, factor: float) -> "Plan":
        """Return the same method with a shorter step [s]: its error was so many times what may be."""
        ratio = min(2.0, (SAFETY * factor) ** (1 / self.power))
        return self._replace(integrator=_stepping(self.integrator, step / ratio), error=self.error / ratio**self.power)


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
        longer, growth = end / self.times[-1], _growth(self.factors)
        floor = self.floor * longer**growth
        if floor <= accuracy:
            return
        if self.floor <= accuracy:
            held = self.times[-1] * (accuracy / self.floor) ** (1 / growth)
        else:
            grown = np.log(np.maximum.accumulate(np.maximum(self.factors, 1.0)))
            held = float(np.interp(np.log(accuracy / ROUNDING), grown, self.times))
        horizon = f"it can be had for the first {span(held)}" if held > 0 else "it cannot be had for any time"
        raise AccuracyError(
            f"accuracy: {accuracy:g} after {span(end)} is below what round-off leaves, about {floor:.1g}, for a "
            f"disturbance of the start grows {floor / ROUNDING:.2g} times; {horizon}"
        )


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
        return self.of_steps <= accuracy / 3 and self.floor <= accuracy


class Candidate(NamedTuple):
    """A method with the step that it needs, and what a second of the motion then costs in microseconds."""

    integrator: Stepping
    power: float
    error: float
    cost: float


def rates(system: System, state: State) -> Iterator[tuple[Pair, float]]:
    """Yield how fast each pair goes, or would fall, round each other now [rad/s]."""
    position, velocity, _, _ = state.si
    for pair in system.pairs:
        x, v = (array[pair.secondary] - array[pair.primary] for array in (position, velocity))
        distance = float(np.linalg.norm(x))
        if distance > 0:
            gm = system.bodies[pair.primary].si.gm + system.bodies[pair.secondary].si.gm
            yield pair, max(sqrt(gm / distance**3), float(np.linalg.norm(np.cross(x, v))) / distance**2)


def errors(one: Motion, other: Motion) -> Floats:
    """Return how far two motions are apart at their rows: the largest of all bodies.

    Positions count from the primary's and relative to the distance from it, attitudes as angles [rad].
    """
    x, y = (motion.position[:, 1:] - motion.position[:, :1] for motion in (one, other))
    position = np.linalg.norm(x - y, axis=-1) / np.linalg.norm(y, axis=-1)
    chord = np.linalg.norm(one.attitude - other.attitude, axis=(-2, -1)) / sqrt(8)  # sin of half of the angle
    angle = 2 * np.arcsin(np.minimum(chord, 1.0))
    return np.asarray(np.maximum(position.max(axis=1), angle.max(axis=1)))


def last_row(motion: Motion) -> Motion:
    """Return the last row of a motion alone."""
    return Motion(*(array[-1:] for array in motion))


class Problem:
    """A system and its start, of which runs are made to compare them."""

    def __init__(self, system: System, state: State) -> None:
        self.system, self.state = system, state
        found = [rate for _, rate in rates(system, state)]
        self.fastest, self.slowest = (2 * pi / rate for rate in (max(found), min(found)))  # periods
        self.evaluation = sum(
            pair.gravity.evaluation_time(system.bodies[pair.secondary], system.bodies[pair.primary])
            for pair in system.pairs
        )

    def outcome(self, integrator: Stepping, time: float, count: int, state: State | None = None) -> Outcome:
        """Return a run of so many equal steps, up to a multiple of its rows: `ROWS`, or as many as there are steps."""
        rows = min(ROWS, count)
        stride = ceil(count / rows)
        segment = Segment(time / (stride * rows), stride * rows, stride)
        run = SteppedRun(self.system, state or self.state, integrator, [segment])
        run.go(lambda _: None)
        outcome = run.outcome()
        if outcome.status == "interrupted":
            raise KeyboardInterrupt
        return outcome

    def motion(self, integrator: Stepping, time: float, count: int, state: State | None = None) -> Motion | None:
        """Return the rows, None where the run does not come to its end."""
        try:
            outcome = self.outcome(integrator, time, count, state)
        except StepError:
            return None
        return outcome.motion if outcome.status == "completed" else None

    def free_time(self, time: float) -> float:
        """Return a time, or most of the time until two bodies touch, where they do before: also with shorter steps."""
        for steps in (12, 50, 200):
            outcome = self.outcome(REFERENCE, time, _whole(steps * time / self.fastest))
            if outcome.status != "contact":
                return time
        return 0.9 * float(outcome.time[-1])

    def reference(self, time: float, wanted: float) -> tuple[Motion | None, int, float]:
        """Return rows that are right to a fraction of what is wanted, or to round-off, the steps, and how right."""
        count = _whole(12 * time / self.fastest)
        best, last, stalls = None, inf, 0
        while count < MOST * time / self.fastest:
            finer = self.motion(REFERENCE, time, count)
            if finer is not None and best is not None:
                apart = float(errors(best, finer).max())
                stalls = stalls + 1 if apart > last / 2 else 0
                if apart < wanted / 30 or (stalls and last < SMALL) or stalls == 3:  # shorter steps do not help
                    return finer, count, apart
                last = apart
            best, count = finer, _whole(1.5 * count)
        return best, count, last

    def estimate(self, plan: Plan, end: Motion, step: float, time: float, accuracy: float) -> Estimate | None:
        """Return the error at the end of a run, by another with steps twice as long; None where that one breaks off.

        Raises
        ------
        AccuracyError
            Where round-off leaves more than is asked.
        """
        for longer in (2.0, 1.5, 1.2):
            count = ceil(time / step / longer)
            coarse = self.motion(plan.integrator, time, count)
            if coarse is not None:
                break
        else:
            return None
        sensitivity = self.sensitivity(plan.integrator, time, count, coarse)
        if sensitivity is not None:
            sensitivity.refuse(accuracy, time)
        floor = 0.0 if sensitivity is None else sensitivity.floor
        rows = min(ROWS, count)
        longer = max(1.1, time / (rows * ceil(count / rows)) / step)
        apart = float(errors(last_row(end), last_row(coarse))[0])
        return Estimate(max(plan.error, apart / float(longer**plan.power - 1)), floor)

    def sensitivity(self, integrator: Stepping, time: float, count: int, undisturbed: Motion) -> Sensitivity | None:
        """Return how a disturbance of velocities and spins grows along a run."""
        for disturbance in DISTURBANCES:
            more = 1 + disturbance
            place, attitude = self.state.position, self.state.attitude
            disturbed = State(place, self.state.velocity * more, attitude, self.state.spin * more)
            motion = self.motion(integrator, time, count, disturbed)
            if motion is None:
                return None
            apart = errors(motion, undisturbed)
            if apart.max() < LARGE:
                break
        return Sensitivity(np.linspace(0, time, len(apart)), apart / disturbance)

    def cost(self, integrator: Stepping, step: float) -> float:
        """Return what a second of the motion costs, in microseconds."""
        stage = STAGE[type(integrator)] * len(self.system.bodies) / 2
        return integrator.shares.stages * (stage + self.evaluation) / step

    def methods(self) -> Iterator[Stepping]:
        """Yield the methods that can follow this system."""
        one = quantity(1.0, "s")
        for scheme in ("rkn4", "rkn6a", "ss10"):
            yield Splitting(one, scheme)
        if len(self.system.bodies) == 2 and KeplerSplitting.is_bound(self.system, self.state):
            for scheme in KeplerSplitting.schemes:
                yield KeplerSplitting(one, scheme)


def plan(problem: Problem, end: float, accuracy: float, longest: float) -> Plan:
    """Return the cheapest method for an accuracy at the end [s] of a run, with its step, at most the longest one [s].

    Raises
    ------
    AccuracyError
        Where not even a trial can be followed.
    """
    some = min(end, ORBITS * problem.slowest)
    time = problem.free_time(some)
    if time < some:  # a contact is the end
        end = time
    wanted = accuracy / SAFETY * time / end
    reference, count, apart = problem.reference(time, wanted)
    if reference is None:
        raise AccuracyError(
            f"accuracy: no trial run comes to {span(time)}: give an integrator to see what happens there"
        )
    if (sensitivity := problem.sensitivity(REFERENCE, time, count, reference)) is not None:
        sensitivity.refuse(accuracy, end)
    if apart > accuracy:
        raise AccuracyError(
            f"accuracy: after {span(time)} trials still differ by {apart:.1g}, however short their steps: ask for a "
            "shorter run"
        )
    best: Candidate | None = None
    for method in problem.methods():
        most = inf if best is None else best.cost
        found = _fitted(problem, method, reference, time, end, accuracy / SAFETY, longest, most)
        if found is not None and (best is None or found.cost < best.cost):
            best = found
    if best is None:
        raise AccuracyError(
            f"accuracy: {accuracy:g} is not reached after {span(time)} by any method, down to {MOST} steps an orbit"
        )
    others = sum(1 for _ in problem.methods()) - 1
    steps = problem.fastest / best.integrator.step.value
    reason = (
        f"{type(best.integrator).__name__} {best.integrator.shares.name}, cheapest of {others + 1} methods for "
        f"{accuracy:g} after {span(end)}, by trials over {span(time)}: {steps:.3g} steps in the fastest orbit of "
        f"{span(problem.fastest)}"
    )
    return Plan(best.integrator, best.power, best.error, reason)


def _fitted(
    problem: Problem,
    method: Stepping,
    reference: Motion,
    time: float,
    end: float,
    aim: float,
    longest: float,
    most: float,
) -> Candidate | None:
    """Return a method with the step that its error asks for; None where it costs more than another does already."""
    count = _whole(max(FIRST * time / problem.fastest, time / longest))
    before: tuple[int, float] | None = None
    while count <= MOST * time / problem.fastest:
        step = time / count
        if problem.cost(method, step) > most:
            return None
        motion = problem.motion(method, time, count)
        error = inf if motion is None else _at_end(errors(motion, reference), end / time)
        if error <= aim:
            power = method.order if before is None else _power(before, (count, error), method.order)
            return Candidate(_stepping(method, step), power, error, problem.cost(method, step))
        if before is not None and before[1] < SMALL and error > before[1] / 2:  # round-off: it gets no better
            return None
        before = (count, error)
        count = _whole(count * (1.5 if error == inf else min(2.0, max(1.1, (error / aim) ** (1 / method.order)))))
    return None


def _stepping(method: Stepping, step: float) -> Stepping:
    """Return a method with another step [s]."""
    return replace(method, step=quantity(step, "s"))  # type: ignore[type-var]


def _whole(count: float) -> int:
    """Return a number of steps of a trial, the same in each of its rows."""
    return ROWS * ceil(count / ROWS)


def _at_end(rows: Floats, longer: float) -> float:
    """Return the error at the end of a run that is so many times longer, growing as in the trial: t to t^2."""
    return float(rows[len(rows) // 2 + 1 :].max() * longer ** _growth(rows))


def _growth(rows: Floats) -> float:
    """Return with which power of the time what is in the rows grows from the second to the last quarter: 1 to 2."""
    quarter = (len(rows) - 1) // 4
    middle, last = (
        float(rows[quarter + 1 : 2 * quarter + 1].max(initial=0)),
        float(rows[3 * quarter + 1 :].max(initial=0)),
    )
    return 1.0 if not 0 < middle < last < inf else min(2.0, max(1.0, log2(last / middle)))


def _power(one: tuple[int, float], other: tuple[int, float], order: int) -> float:
    """Return with which power of the step an error falls between two numbers of steps."""
    if not (0 < other[1] < one[1] < inf):
        return float(order)
    return min(order + 2.0, max(0.8 * order, log2(one[1] / other[1]) / log2(other[0] / one[0])))
