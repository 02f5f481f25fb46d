"""A run by compiled steps: equal steps in segments, the loop called in chunks, and how it ended."""

import time
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple

import numpy as np
from astropy.time import TimeDelta

from binaryast import working
from binaryast.arcs import first_contact
from binaryast.errors import StepError
from binaryast.events import Event
from binaryast.integrators import Stepping
from binaryast.kernels import loop, status
from binaryast.kernels.clearance import least_clearance
from binaryast.lookout import Found, Looker, Lookout
from binaryast.occurrences import OccurrenceFloats
from binaryast.outcome import (
    Happening,
    Outcome,
    Watch,
    contact_message,
    event_message,
    interruption_message,
    not_finite_message,
    occurrences,
    overlap,
    turn_error,
)
from binaryast.perturbations.base import Span
from binaryast.progress import keyboard
from binaryast.run_file import ROWS_AT_ONCE
from binaryast.schedule import SLACK, Segment
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief
from binaryast.watchlist import Watchlist
from binaryast.working import Motion
from binaryast.working.base import coinciding

CHUNK_SECONDS = 0.1  # between two looks at the keyboard
GROWTH, MOST_AT_ONCE = 8, 500_000  # of steps between two looks, whatever the clock says
CHECKPOINT = ("segment", "kept", "elapsed", "steps", "closest_time", "energy_error", "wall_time")
LOOKED_BACK = 2  # steps within which an event may be found that ends the run before them


class Place(NamedTuple):
    """Where in a run something is: in which segment, when that began, and after how many of its steps."""

    segment: Segment
    begin: float
    steps: int

    @property
    def row_time(self) -> float:
        """When the row before the last step to there was saved."""
        stride = self.segment.stride
        return self.begin + max(0, self.steps - 1) // stride * stride * self.segment.step


class SteppedRun:
    """One run under way."""

    def __init__(
        self,
        system: System,
        state: State,
        integrator: Stepping,
        segments: list[Segment],
        begin: float = 0.0,
        events: Sequence[Event] = (),
    ) -> None:
        self.system, self.integrator, self.segments, self.begin = system, integrator, segments, begin
        inertial = integrator.is_inertial(system)
        disturbed = bool(system.perturbations)
        self.kernel = integrator.kernel(inertial=inertial, disturbed=disturbed)
        self.shares = integrator.shares.shares
        self.end = sum(segment.steps * segment.step for segment in segments)
        epoch = None if state.epoch is None else state.epoch - TimeDelta(begin, format="sec")
        span = Span(begin, begin + self.end, epoch, state.frame)
        self.working = working.of(system, state, inertial=inertial, span=span if disturbed else None)
        self.watchlist = Watchlist(events, system, state)
        self.looker = Looker(self.working, integrator)
        self.lookout = Lookout(self.watchlist, self.looker, begin) if self.watchlist else None
        self.surfaces = self.working.surfaces if self.watchlist.by_steps else np.zeros_like(self.working.surfaces)
        self.happened: list[Happening] = []
        self.stopped: Event | None = None
        self.watch = Watch()
        self.of_rows = Watch()  # rows in changed variables, after they were changed back
        self.rows: list[Floats] = [self._row()]
        self.times: list[Floats] = [np.zeros(1)]
        self.code = status.COMPLETED
        self.pressed: list[int] = []
        self.raised, self.gone = "", 0.0  # gone: how far into the last step the run ends [s]
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0
        self.segment, self.kept, self.energy_error = 0, 0, 0.0  # kept: rows of the segment taken out of its window
        self.window: Floats | None = None
        self.landmarks: tuple[Floats, Floats] = (np.empty(0), np.empty((0, self.working.row_size)))
        self._begin()

    def _row(self) -> Floats:
        return self.working.state[None, : self.working.row_size].copy()

    def _begin(self) -> None:
        """Look at the start: overlap; and keep the references."""
        w = self.working
        measures = w.measure(w.state, w.constants)
        position = w.from_rows(self.rows[0], self.times[0]).position[0]
        if touching := coinciding(self.system, position):
            raise overlap(self.system, touching - 1, position)
        if self.surfaces.any() and self._clearance(w.state, 0.0) < 0.0:
            raise overlap(self.system, self._nearest_pair(), position)
        for watch in (self.watch, self.of_rows):
            watch.begin(measures, float(w.state[w.potential_at]))

    def go(self, show: Callable[[float], None]) -> None:
        """Take all segments, as far as it goes.

        Raises
        ------
        StepError
            Where the first step has no solution.
        """
        with keyboard() as self.pressed:
            while self.segment < len(self.segments):
                self._take(self.segments[self.segment], show)
                if self.code != status.COMPLETED or self.pressed:
                    break
        if self.steps == 0 and status.NO_ROTATION <= self.code < status.CONTACT:
            raise self._turn_error()

    def _take(self, segment: Segment, show: Callable[[float], None]) -> None:
        """Take one segment, or the rest of it, in chunks short enough for the keyboard and the progress bar."""
        watch = self.watch.array
        if not watch[loop.STEPS]:
            self._begin_segment(segment)
        chunk = 16
        while (left := segment.steps - int(watch[loop.STEPS])) and self.code == status.COMPLETED and not self.pressed:
            began = time.perf_counter()
            rows = self._window(segment)
            count = min(chunk, left, self._room(segment))
            self.code = self._advance(segment, count, rows)
            if self.code >= status.CONTACT:
                self._look_closer(segment, rows)
            if status.STOPPED < self.code < status.COMPLETED:
                self._look_back(-self.code, segment)
            spent = time.perf_counter() - began
            self.wall_time += spent
            chunk = max(1, min(GROWTH * count, MOST_AT_ONCE, int(count * CHUNK_SECONDS / max(spent, 1e-6))))
            show(self.elapsed + watch[loop.STEPS] * segment.step)
        self._take_out(segment, int(watch[loop.STEPS]))
        if self.integrator.changed is not None:
            self._merge(self.of_rows)
            self._change(-self.integrator.changed.shares[::-1], segment.step)
        self._keep(segment)

    def _begin_segment(self, segment: Segment) -> None:
        """Have events looked for anew, and change the variables."""
        if self.lookout is not None:
            self.lookout.start(segment, self.elapsed, self.watch.array)
        if self.integrator.changed is not None:
            self.energy_error = float(self.watch.array[loop.ENERGY_ERROR])
            self._change(self.integrator.changed.shares, segment.step)

    def _window(self, segment: Segment) -> Floats:
        """Return where the loop puts its rows, a ring: not room for all of a segment, so that memory stays flat."""
        if self.window is None:
            self.window = np.empty((min(segment.steps // segment.stride, ROWS_AT_ONCE), self.working.row_size))
        elif self._room(segment) <= LOOKED_BACK * segment.stride:
            self._take_out(segment, self._settled())
        return self.window

    def _room(self, segment: Segment) -> int:
        """Return for how many steps there is room in the window."""
        if self.window is None or self.kept + len(self.window) >= segment.steps // segment.stride:
            return segment.steps
        return (self.kept + len(self.window)) * segment.stride - int(self.watch.array[loop.STEPS])

    def _settled(self) -> int:
        """Return up to which step of the segment the motion stays as it is, whatever event is found yet."""
        return max(0, int(self.watch.array[loop.STEPS]) - (0 if self.lookout is None else LOOKED_BACK))

    def _take_out(self, segment: Segment, steps: int) -> None:
        """Take rows up to a step of the segment out of the window, with their times."""
        rows = self._in_window(segment, steps)
        if not len(rows):
            return
        if self.integrator.changed is not None:
            self._change_back(-self.integrator.changed.shares[::-1], segment.step, rows)
        self.rows.append(rows)
        numbers = np.arange(self.kept + 1, self.kept + len(rows) + 1)
        self.times.append(self.elapsed + numbers * (segment.stride * segment.step))
        self.kept += len(rows)

    def _in_window(self, segment: Segment, steps: int) -> Floats:
        """Return the rows up to a step of the segment that are in the window yet."""
        numbers = np.arange(self.kept, steps // segment.stride)
        if self.window is None or not len(numbers):
            return np.empty((0, self.working.row_size))
        return self.window[numbers % len(self.window)]

    def _change(self, shares: Floats, step: float) -> None:
        """Change the variables of the working state, or change them back."""
        w = self.working
        code = self.kernel(
            w.state, w.constants, np.ascontiguousarray(shares), w.attraction, w.parameters, w.external, step
        )
        self.code = self.code or code

    def _change_back(self, shares: Floats, step: float, rows: Floats) -> None:
        """Change the variables of rows back, and watch them; the state stays in the changed ones."""
        w = self.working
        end = w.state.copy()
        for k in range(len(rows)):
            w.state[:] = 0
            w.state[: w.row_size] = rows[k]
            self._change(shares, step)
            self.of_rows.look(w.measure(w.state, w.constants))
            rows[k] = w.state[: w.row_size]
        w.state[:] = end

    def _merge(self, of_rows: Watch) -> None:
        """Take in what was watched at rows; the energy of the steps between, in changed variables, says nothing."""
        watch, rows = self.watch.array, of_rows.array
        watch[loop.ENERGY_ERROR] = max(self.energy_error, rows[loop.ENERGY_ERROR])
        errors = slice(loop.ANGULAR_ERROR, loop.CLOSEST)
        watch[errors] = np.maximum(watch[errors], rows[errors])
        watch[loop.CLOSEST] = min(watch[loop.CLOSEST], rows[loop.CLOSEST])

    def _clearance(self, origin: Floats, after: float) -> float:
        """Return the smallest clearance of all pairs a time after a state."""
        self.looker.look(origin, after)
        return float(least_clearance(*self.looker.places[::2], self.surfaces)[0])

    def _nearest_pair(self) -> int:
        """Return which pair has the smallest clearance where it was last looked at."""
        return int(least_clearance(*self.looker.places[::2], self.surfaces)[1])

    def _look_closer(self, segment: Segment, rows: Floats) -> None:
        """Look closer at a step in which bodies may touch: where they do, the run ends there; else the step is taken.

        What happens in the step before is no less an event.
        """
        origin = self._motion_itself(segment.step)
        gone = first_contact(lambda after: self._clearance(origin, after), 0.0, segment.step)
        if gone is None:
            free = np.zeros_like(self.surfaces)
            self.code = self._call(segment.step, 1, segment.stride, rows, self.watch.array, free)
            return
        for found in [] if self.lookout is None or not gone else self.lookout.within(gone):
            if self._takes_in(found):
                self._stop_at(found.state, found.root.time - self._now(segment), segment)
                return
        self.looker.look(origin, gone)
        pair = self._nearest_pair()
        event = self.watchlist.contact_of(pair)
        self.happened.append(Happening(event, self._now(segment) + gone, -1, self.looker.scratch.copy()))
        self._stop_at(self.looker.scratch.copy(), gone, segment)
        self.code = status.CONTACT + pair

    def _motion_itself(self, step: float) -> Floats:
        """Return the state in which the run is, changed back where its variables are others."""
        w, state = self.working, self.working.state.copy()
        if self.integrator.changed is not None:
            self._change(-self.integrator.changed.shares[::-1], step)
            state, w.state[:] = w.state.copy(), state
        return state

    def _now(self, segment: Segment) -> float:
        """Return the time after the steps done, since the start of the run."""
        return self.begin + self.elapsed + float(self.watch.array[loop.STEPS]) * segment.step

    def _look_back(self, count: int, segment: Segment) -> None:
        """Find what happened in the last two steps, of which there are so many findings; the run may end by it."""
        lookout, watch = self.lookout, self.watch.array
        assert lookout is not None
        steps = int(watch[loop.STEPS])
        self.code = status.COMPLETED
        for found in lookout.resolve(count, steps):
            if self._takes_in(found):
                watch[:] = lookout.watch_before(found.root.time, steps)
                self._stop_at(found.state, found.root.time - self._now(segment), segment)
                return

    def _takes_in(self, found: Found) -> bool:
        """Keep what happened; whether it ends the run."""
        event = self.watchlist.event(found.function)
        owner = self.watchlist.owners[found.function]
        self.happened.append(Happening(owner, found.root.time, found.root.direction, found.state))
        self.stopped = event if event.terminal else None
        return event.terminal

    def _stop_at(self, state: Floats, gone: float, segment: Segment) -> None:
        """End the run at a state, in the middle of a step."""
        w = self.working
        self.code, self.gone = status.STOPPED, gone
        w.state[:] = state
        measures = w.measure(w.state, w.constants)
        if self.watch.look(measures):
            self.closest_time, self.watch.array[loop.CLOSEST_STEP] = self._now(segment) - self.begin + gone, 0
        if self.integrator.changed is not None:
            self._change(self.integrator.changed.shares, segment.step)

    def follow_again(self, row: Floats, segment: Segment, steps: int) -> Floats:
        """Return the motion itself so many steps of a segment after a saved row; the run's state is left there."""
        w = self.working
        w.state[:] = 0
        w.state[: w.row_size] = row
        w.exert()
        if self.integrator.changed is not None and steps:
            self._change(self.integrator.changed.shares, segment.step)
        no_rows, watch = np.empty((0, w.row_size)), np.zeros_like(self.watch.array)
        arguments = self._arguments(np.zeros_like(self.surfaces), watch, segment.step)
        w.advance(*arguments, steps, 2 * steps + 1, no_rows)
        if self.integrator.changed is not None and steps:
            self._change(-self.integrator.changed.shares[::-1], segment.step)
        return w.state.copy()

    def _advance(self, segment: Segment, count: int, rows: Floats) -> int:
        """Call the compiled loop for some steps of a segment."""
        return self._call(segment.step, count, segment.stride, rows, self.watch.array, self.surfaces)

    def _call(self, step: float, count: int, stride: int, rows: Floats, watch: Floats, surfaces: Floats) -> int:
        """Call the compiled loop; a potential of the user's that raises ends the run like any other trouble."""
        w, arguments = self.working, self._arguments(surfaces, watch, step)
        try:
            if self.lookout is not None:
                return self.lookout.advance(arguments, count, stride, rows)
            code: int = w.advance(*arguments, count, stride, rows)
        except Exception as error:  # whatever the user's function raises, in the middle of a step or after it
            self.raised = "" if self.lookout is None else self.lookout.complaint()
            if not self.raised:
                w.state[: w.before.size] = w.before
                self.raised = f"a potential or a force raised {type(error).__name__}: {brief(error)}"
            return status.NOT_FINITE
        return code

    def _arguments(self, surfaces: Floats, watch: Floats, step: float) -> tuple[Any, ...]:
        """Return what the compiled loop is given first."""
        w = self.working
        return (
            self.kernel,
            w.measure,
            w.touching,
            self.shares,
            w.attraction,
            w.parameters,
            w.external,
            w.constants,
            surfaces,
            w.state,
            w.before,
            watch,
            step,
        )

    def _keep(self, segment: Segment) -> None:
        """Close a segment, with the last state as a row where that is not one yet."""
        watch = self.watch.array
        done = int(watch[loop.STEPS])
        if done % segment.stride or self.gone:
            self.rows.append(self._row())
            self.times.append(np.array([self.elapsed + done * segment.step + self.gone]))
        self.closest_time, watch[loop.CLOSEST_STEP] = self._closest(), 0
        self.elapsed += done * segment.step + self.gone
        self.steps += done
        self.segment += 1
        self.kept, watch[loop.STEPS], self.window = 0, 0, None

    def _closest(self) -> float:
        """Return when the bodies were closest so far, since the start of the leg."""
        step = self.watch.array[loop.CLOSEST_STEP]
        return self.elapsed + float(step) * self.segments[self.segment].step if step else self.closest_time

    def take_rows(self) -> tuple[Floats, Motion]:
        """Return the rows that have been saved since the last call, with their times; they are kept no longer."""
        if self.segment < len(self.segments):
            self._take_out(self.segments[self.segment], self._settled())
        rows = np.concatenate([np.empty((0, self.working.row_size)), *self.rows])
        times = np.concatenate([np.empty(0), *self.times])
        self.landmarks = self._landmarks()
        self.rows, self.times = [], []
        return self.begin + times, self.working.from_rows(rows, times)

    def _landmarks(self) -> tuple[Floats, Floats]:
        """Return two rows that are kept, with their times: that before the closest approach so far, and the last."""
        times = np.concatenate([self.landmarks[0], *self.times])
        rows = np.concatenate([self.landmarks[1], *self.rows])
        place = self.place_of_closest()
        chosen = [len(times) - 1] if place is None else [int(np.argmin(np.abs(times - place.row_time))), len(times) - 1]
        return times[chosen], rows[chosen]

    def place_of_closest(self) -> Place | None:
        """Return where the closest approach is, None where there is no step."""
        begin, closest = 0.0, self._closest()
        for segment in self.segments:
            steps = round((closest - begin) / segment.step)
            if steps <= segment.steps and self.elapsed + self.watch.array[loop.STEPS] > 0.0:
                return Place(segment, begin, steps)
            begin += segment.steps * segment.step
        return None

    def row_before(self, place: Place) -> Floats | None:
        """Return the row before the last step to a place, None where it is not kept."""
        times, rows = self._landmarks()
        nearest = int(np.argmin(np.abs(times - place.row_time)))
        return rows[nearest] if abs(times[nearest] - place.row_time) < 0.5 * place.segment.step else None

    @property
    def pending(self) -> int:
        """About how many rows are in memory."""
        return sum(len(rows) for rows in self.rows)

    @property
    def can_go_on(self) -> bool:
        """Whether nothing has ended it but the end of its time, or Ctrl-C."""
        return self.code == status.COMPLETED

    def checkpoint(self) -> dict[str, Any]:
        """Return what the rest of the run depends on, after `take_rows`: the working state, and where it is."""
        segment = self.segments[min(self.segment, len(self.segments) - 1)]
        return {
            "state": self.working.state.copy(),
            "watch": self.watch.array.copy(),
            "of_rows": self.of_rows.array.copy(),
            "window": self._in_window(segment, int(self.watch.array[loop.STEPS])),
            "landmarks": self.landmarks,
            "lookout": {} if self.lookout is None else self.lookout.checkpoint(),
            **{name: getattr(self, name) for name in CHECKPOINT},
        }

    def restore(self, checkpoint: dict[str, Any], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint of a run with the same beginning; the rows before it are not made again."""
        self.working.state[:] = checkpoint["state"]
        self.watch.array[:] = checkpoint["watch"]
        self.of_rows.array[:] = checkpoint["of_rows"]
        for name in CHECKPOINT:
            setattr(self, name, checkpoint[name])
        self.rows, self.times, self.landmarks = [], [], checkpoint["landmarks"]
        self.happened = list(happened)
        if self.segment < len(self.segments):
            segment = self.segments[self.segment]
            rows = checkpoint["window"]
            for number, row in enumerate(rows, start=self.kept):
                self._window(segment)[number % len(self._window(segment))] = row
            if self.lookout is not None:
                self.lookout.restore(checkpoint["lookout"], segment, self.elapsed)

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed: the rows in memory, or those that were taken before."""
        time, motion = rows or self.take_rows()
        ended, message = self._end()
        return Outcome(
            time=time,
            motion=motion,
            watch=self.watch,
            closest_time=self.begin + self._closest(),
            status=ended,
            message=message,
            steps=self.steps,
            step=self.segments[0].step if self.segments else 0.0,
            wall_time=self.wall_time,
            occurrences=self._occurrences(),
            pressed=bool(self.pressed),
        )

    def _occurrences(self) -> OccurrenceFloats:
        """Return what has happened."""
        rows = np.array([one.variables[: self.working.row_size] for one in self.happened])
        times = np.array([one.time - self.begin for one in self.happened])
        return occurrences(self.happened, self.working.from_rows(rows.reshape(-1, self.working.row_size), times))

    def _end(self) -> tuple[str, str]:
        """Return the status and what there is to say about it."""
        now = self.begin + self.elapsed
        if self.pressed and self.elapsed < self.end * (1 - SLACK):
            return "interrupted", interruption_message(now)
        if self.code == status.STOPPED and self.stopped is not None:
            return self.stopped.status, event_message(self.stopped, self.system, now)
        if self.code >= status.CONTACT:
            return "contact", contact_message(self.system, self.code - status.CONTACT, now)
        if self.code == status.NOT_FINITE:
            what = "positions, momenta, gravity or a force are not numbers any more"
            reason = self.raised or not_finite_message(what, self.system)
            return "failed", f"{reason}; the last good row is at {now:g} s"
        if self.code != status.COMPLETED:
            return "failed", str(self._turn_error())
        return "completed", ""

    def _turn_error(self) -> StepError:
        """Return the error of the body that turns too fast now."""
        index = self.code - status.NO_ROTATION
        body = self.system.bodies[index]
        step = max(segment.step for segment in self.segments)
        momentum, torque = self.working.momentum_and_torque(index)
        spin = float(np.linalg.norm((momentum + step / 2 * torque) / body.si.moments))
        return turn_error(body.name, spin, self.integrator, step)
