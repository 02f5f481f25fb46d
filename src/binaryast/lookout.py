"""Looks within compiled steps: where the bodies are a time after a step began, and the events of a run by steps."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import numpy as np

from binaryast.integrators import Stepping
from binaryast.kernels import loop
from binaryast.kernels.events.looking import ORIGINS, POTENTIAL, STEP, VIEW_POINTER, VIEWING
from binaryast.kernels.events.notice import notice
from binaryast.kernels.jit import EVENT_POINTER, PAIR_POINTER
from binaryast.kernels.pointers import WORDS, putter, table_of
from binaryast.kernels.status import COMPLETED, NOT_FINITE
from binaryast.locating import EDGE, Root, findings, resolve
from binaryast.schedule import Segment
from binaryast.units import Floats, brief
from binaryast.watchlist import Places, Watchlist
from binaryast.working import Working

NO_CHANGE = np.zeros(0)
NO_FUNCTIONS = np.zeros(0, dtype=np.int64)
START = 1e-9  # of a step: what is as near to the start of a run is no event, but where it starts


class Looker:
    """Where the bodies are a time after a state, by one step of that length, aside from the run.

    The state is the motion itself, also where an integrator steps other variables; ``scratch`` and ``places`` keep
    where the bodies were at the last look.
    """

    def __init__(self, working: Working, integrator: Stepping) -> None:
        self.working, self.scratch = working, np.zeros_like(working.state)
        self.places = Places.of(len(working.masses))
        if working.inertial:
            from binaryast.kernels.bodies import looking
        else:
            from binaryast.kernels.pair import looking  # type: ignore[no-redef]
        self.kernels: Any = looking
        self.potentials = working.attraction if working.inertial else NO_FUNCTIONS
        self.kernel = integrator.kernel(inertial=working.inertial, disturbed=working.disturbed)
        self.functions = np.zeros(3 * WORDS, dtype=np.int64)
        putter(looking.STEP_POINTER)(self.functions, STEP, self.kernel)
        putter(VIEW_POINTER)(self.functions, VIEWING, looking.view)
        if not working.inertial:
            putter(PAIR_POINTER)(self.functions, POTENTIAL, working.attraction)
        self.scheme = integrator.shares.shares
        changed = integrator.changed
        self.change = NO_CHANGE if changed is None else np.ascontiguousarray(changed.shares)
        self.back = NO_CHANGE if changed is None else np.ascontiguousarray(-changed.shares[::-1])

    def look(self, origin: Floats, after: float) -> None:
        """Look at the bodies a time after a state; where that goes wrong, they are nowhere."""
        try:
            status = self._look(origin, after)
        except Exception:  # whatever a user's potential raises there, where the run itself may never come
            status = NOT_FINITE
        if status != COMPLETED:
            for array in (self.scratch, *self.places):
                array[:] = np.nan

    def _look(self, origin: Floats, after: float) -> int:
        w = self.working
        status: int = self.kernels.look(
            self.functions,
            self.scheme,
            self.change,
            self.back,
            self.potentials,
            w.parameters,
            w.external,
            w.constants,
            w.shares,
            origin,
            self.scratch,
            after,
            *self.places,
        )
        return status


class Found(NamedTuple):
    """A root: of which function, when since the start of the run's steps, and the state there."""

    function: int
    root: Root
    state: Floats


class Lookout:
    """The events of a run by steps: looks at every step, and finds the roots of what was noticed."""

    def __init__(self, watchlist: Watchlist, looker: Looker, begin: float) -> None:
        self.watchlist, self.looker, self.begin = watchlist, looker, begin
        if looker.working.inertial:
            from binaryast.kernels.bodies.looking_loop import advance_looking
        else:
            from binaryast.kernels.pair.looking_loop import advance_looking
        self.advance_looking = advance_looking
        size = looker.working.state.size
        self.origins, self.watches = np.zeros((ORIGINS, size)), np.zeros((ORIGINS, loop.WATCH_SIZE))
        self.marks = watchlist.marks()
        self.table = table_of([one.function for one in watchlist.watched], EVENT_POINTER)
        parameters = [one.parameters for one in watchlist.watched]
        ends = np.cumsum([len(p) for p in parameters]).astype(float)
        self.needs = np.concatenate([*parameters, np.zeros(1)])
        self.where = np.column_stack([ends - [len(p) for p in parameters], ends])
        self.segment = Segment(1.0, 1, 1)
        self.time = 0.0  # when the segment begins, since the start of the run

    def start(self, segment: Segment, elapsed: float, watch: Floats) -> None:
        """Begin a segment, at the state of the run as it is now."""
        self._prepare(segment, elapsed)
        self.origins[-1], self.watches[-1] = self.looker.working.state, watch
        self.marks = self.watchlist.marks()
        self.looker.look(self.origins[-1], 0.0)
        for k in range(len(self.marks)):
            notice(self.marks, k, self.time, self.watchlist.value(k, self.time, self.looker.places))

    def _prepare(self, segment: Segment, elapsed: float) -> None:
        """Plan the looks at the steps of a segment."""
        self.segment, self.time = segment, self.begin + elapsed
        looks = self.watchlist.looks(segment.step)
        self.inner = np.arange(1, looks + 1) / looks
        self.first, self.last = np.array([EDGE, *self.inner]), np.array([*self.inner[:-1], 1.0 - EDGE, 1.0])
        self.findings = self.watchlist.findings(looks + 2)

    def checkpoint(self) -> dict[str, Any]:
        """Return what later findings depend on."""
        return {"origins": self.origins.copy(), "watches": self.watches.copy(), "marks": self.marks.copy()}

    def restore(self, checkpoint: dict[str, Any], segment: Segment, elapsed: float) -> None:
        """Go on from a checkpoint within a segment."""
        self._prepare(segment, elapsed)
        self.origins[:], self.watches[:] = checkpoint["origins"], checkpoint["watches"]
        self.marks[:] = checkpoint["marks"]

    def advance(self, arguments: tuple[Any, ...], count: int, stride: int, rows: Floats) -> int:
        """Take up to ``count`` steps that are looked at; the status, or minus the number of findings.

        The first step of a segment and its last are looked at near its ends too: what turns there shows nowhere else.
        """
        watch: Floats = arguments[11]
        done = int(watch[loop.STEPS])
        fractions = self.inner
        if self.segment.steps == 1:
            count, fractions = 1, np.array([EDGE, *self.inner[:-1], 1.0 - EDGE, 1.0])
        elif done == 0:
            count, fractions = 1, self.first
        elif done == self.segment.steps - 1:
            fractions = self.last
        else:
            count = min(count, self.segment.steps - 1 - done)
        status: int = self.advance_looking(
            *arguments,
            count,
            stride,
            rows,
            self.looker.kernels.view,
            self.looker.change,
            self.looker.back,
            self.looker.working.shares,
            *self.looker.places,
            self.table,
            self.needs,
            self.where,
            fractions,
            self.time,
            self.origins,
            self.watches,
            self.marks,
            self.findings,
            self.looker.scratch,
        )
        return status

    def resolve(self, count: int, steps: int) -> list[Found]:
        """Return the roots of the findings after so many steps, in order of time, those at the very start left out."""
        return self._roots(self.findings[:count].tolist(), lambda k: self._function(k, steps))

    def within(self, length: float) -> list[Found]:
        """Return the roots in a time after the last step, in order, those at the very start of the run left out."""
        begin, origin = self.time_of(self.watches[-1][loop.STEPS]), self.origins[-1].copy()

        def value(k: int, time: float) -> float:
            self.looker.look(origin, time - begin)
            return self.watchlist.value(k, time, self.looker.places)

        looks = self.watchlist.looks(length)
        found = findings(value, self.watchlist.marks(), begin, begin + length, looks)
        return self._roots(found, lambda k: partial(value, k))

    def _roots(self, findings: list[list[float]], function: Callable[[int], Callable[[float], float]]) -> list[Found]:
        """Return the roots of findings in order of time, those at the very start of the run left out."""
        found: list[Found] = []
        for finding in findings:
            k = int(finding[0])
            value = function(k)
            for root in resolve(value, finding, self.watchlist.event(k).direction, self.watchlist.accuracy(k)):
                value(root.time)
                found.append(Found(k, root, self.looker.scratch.copy()))
        least = self.begin + START * min(self.segment.step, self.watchlist.interval)
        return sorted((one for one in found if one.root.time > least), key=lambda one: one.root.time)

    def time_of(self, steps: float) -> float:
        """Return the time after so many steps of the segment, since the start of the run [s]."""
        return self.time + float(steps) * self.segment.step

    def complaint(self) -> str:
        """Return what a function of the user's raises where the last step ended, nothing where none does."""
        self.looker.look(self.origins[-1], 0.0)
        for k in range(len(self.marks)):
            try:
                self.watchlist.value(k, self.time_of(self.watches[-1][loop.STEPS]), self.looker.places)
            except Exception as error:  # whatever it is
                return f"an event raised {type(error).__name__}: {brief(error)}"
        return ""

    def _function(self, k: int, steps: int) -> Callable[[float], float]:
        """Return a function of time in the last two steps, of which the last one ended after so many."""
        step = self.segment.step
        middle = self.time_of(steps - 1)

        def value(time: float) -> float:
            which = -3 if time < middle and steps > 1 else -2
            begin = middle - step if which == -3 else middle
            self.looker.look(self.origins[which], time - begin)
            return self.watchlist.value(k, time, self.looker.places)

        return value

    def watch_before(self, time: float, steps: int) -> Floats:
        """Return what was watched before the step in which a time lies, of the last two."""
        before: Floats = self.watches[-2 if time >= self.time_of(steps - 1) or steps == 1 else -3]
        return before
