"""A run by compiled steps: equal steps in segments, the loop called in chunks, and how it ended."""

import time
from collections.abc import Callable
from math import inf, pi
from typing import Any

import numpy as np

from binaryast import working
from binaryast.errors import StepError
from binaryast.integrators import Stepping
from binaryast.kernels import loop, status
from binaryast.outcome import Outcome, Watch, contact_message, interruption_message, not_finite_message, overlap
from binaryast.progress import keyboard
from binaryast.run_file import ROWS_AT_ONCE
from binaryast.schedule import SLACK, Segment
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief
from binaryast.working import Motion
from binaryast.working.base import coinciding

CHUNK_SECONDS = 0.1  # between two looks at the keyboard
GROWTH, MOST_AT_ONCE = 8, 500_000  # of steps between two looks, whatever the clock says
CHECKPOINT = ("segment", "done", "elapsed", "steps", "closest_time", "energy_error", "wall_time")
PARTS, LEVELS = 16, 3  # of a step in which bodies seem to touch: 16 parts, of which one in 16, and so on


def turn_error(name: str, spin: float, integrator: Stepping, step: float) -> StepError:
    """Return the error of a step that turns a body too far."""
    turned = (
        f"step: {name} spins at {spin:.6g} rad/s (once in {2 * pi / spin / 3600:.4g} h), h Omega = {step * spin:.4g}"
    )
    if integrator.largest_turn == inf:
        return StepError(f"{turned}: more turns in a step of {step:g} s than can be followed: give a shorter one")
    scheme = "" if integrator.order == 2 else f" at order {integrator.order} ({integrator.shares.name})"
    return StepError(
        f"{turned}; the implicit equation (128) has a solution only below {integrator.largest_turn:.4g}{scheme}: the "
        f"step must be below {integrator.largest_turn / spin:.6g} s, got {step:g} s; ba.Splitting has no such limit"
    )


class SteppedRun:
    """One run under way."""

    def __init__(
        self, system: System, state: State, integrator: Stepping, segments: list[Segment], begin: float = 0.0
    ) -> None:
        self.system, self.integrator, self.segments, self.begin = system, integrator, segments, begin
        inertial = integrator.is_inertial(len(system.bodies))
        self.kernel, self.shares = integrator.kernel(inertial=inertial), integrator.shares.shares
        self.working = working.of(system, state, inertial=inertial)
        self.end = sum(segment.steps * segment.step for segment in segments)
        self.watch = Watch()
        self.of_rows = Watch()  # rows in changed variables, after they were changed back
        self.rows: list[Floats] = [self._row()]
        self.times: list[Floats] = [np.zeros(1)]
        self.code = status.COMPLETED
        self.pressed: list[int] = []
        self.raised, self.gone = "", 0.0  # gone: how far into the last step bodies touch [s]
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0
        self.segment, self.done, self.energy_error = 0, 0, 0.0  # done: steps of the segment up to the last row kept
        self.window: Floats | None = None
        self._begin()

    def _row(self) -> Floats:
        return self.working.state[None, : self.working.row_size].copy()

    def _begin(self) -> None:
        """Look at the start: overlap; and keep the references."""
        w = self.working
        measures = w.measure(w.state, w.constants)
        position = w.from_rows(self.rows[0], self.times[0]).position[0]
        touching = coinciding(self.system, position) or w.touching(w.state, w.surfaces, w.state)
        if touching:
            raise overlap(self.system, touching - 1, position)
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
        if self.integrator.changed is not None and not self.done and not watch[loop.STEPS]:
            self.energy_error = float(watch[loop.ENERGY_ERROR])
            self._change(self.integrator.changed.shares, segment.step)
        chunk = 16
        while (left := self._left(segment)) and self.code == status.COMPLETED and not self.pressed:
            began = time.perf_counter()
            rows = self._window(segment)
            count = min(chunk, left, len(rows) * segment.stride - int(watch[loop.STEPS]))
            self.code = self._advance(segment, count, rows)
            if self.code >= status.CONTACT:
                self._look_closer(segment, rows)
            spent = time.perf_counter() - began
            self.wall_time += spent
            chunk = max(1, min(GROWTH * count, MOST_AT_ONCE, int(count * CHUNK_SECONDS / max(spent, 1e-6))))
            show(self.elapsed + (self.done + watch[loop.STEPS]) * segment.step)
        self._close_window(segment)
        if self.integrator.changed is not None:
            self._merge(self.of_rows)
            self._change(-self.integrator.changed.shares[::-1], segment.step)
        self._keep(segment)

    def _left(self, segment: Segment) -> int:
        """Return how many steps of a segment are still to be taken."""
        return segment.steps - self.done - int(self.watch.array[loop.STEPS])

    def _window(self, segment: Segment) -> Floats:
        """Return where the loop puts its next rows: not room for all of a segment, so that memory stays flat."""
        if self.window is not None and int(self.watch.array[loop.STEPS]) == len(self.window) * segment.stride:
            self._close_window(segment)
        if self.window is None:
            rows = min((segment.steps - self.done) // segment.stride, ROWS_AT_ONCE)
            self.window = np.empty((rows, self.working.row_size))
        return self.window

    def _close_window(self, segment: Segment) -> None:
        """Keep the rows of a window with their times, and count the steps of a segment anew from its last row."""
        watch = self.watch.array
        if watch[loop.CLOSEST_STEP]:
            self.closest_time = self.elapsed + (self.done + watch[loop.CLOSEST_STEP]) * segment.step
            watch[loop.CLOSEST_STEP] = 0
        saved = int(watch[loop.STEPS]) // segment.stride
        if self.window is None or not saved:
            return
        rows, self.window = self.window[:saved], None
        first = self.done // segment.stride
        times = self.elapsed + np.arange(first + 1, first + saved + 1) * (segment.stride * segment.step)
        if self.integrator.changed is not None:
            self._change_back(-self.integrator.changed.shares[::-1], segment.step, rows)
        self.rows.append(rows)
        self.times.append(times)
        self.done += saved * segment.stride
        watch[loop.STEPS] -= saved * segment.stride

    def _change(self, shares: Floats, step: float) -> None:
        """Change the variables of the working state, or change them back."""
        w = self.working
        code = self.kernel(w.state, w.constants, np.ascontiguousarray(shares), w.attraction, w.parameters, step)
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

    def _look_closer(self, segment: Segment, rows: Floats) -> None:
        """Repeat a step in which bodies seem to touch in short parts: the chord of its arc may, where the arc does not.

        Where they do, the run ends with the part in which they touch; else the step is taken after all.
        """
        w, watch = self.working, self.watch.array.copy()
        start = w.state.copy()
        gone = self._by_parts(segment.step, LEVELS, watch)
        if gone is None:
            w.state[:] = start
            self.code = self._call(segment.step, 1, segment.stride, rows, self.watch.array, np.zeros_like(w.surfaces))
        else:
            self.gone = gone
            separation = float(w.measure(w.state, w.constants)[-1])
            if separation < self.watch.array[loop.CLOSEST]:
                self.closest_time = self.elapsed + (self.done + self.watch.array[loop.STEPS]) * segment.step + gone
                self.watch.array[[loop.CLOSEST, loop.CLOSEST_STEP]] = separation, 0
            self.watch.array[loop.ENERGY_ERROR : loop.CLOSEST] = watch[loop.ENERGY_ERROR : loop.CLOSEST]

    def _by_parts(self, step: float, levels: int, watch: Floats) -> float | None:
        """Follow a step in parts; return after what time bodies touch or it goes wrong, None where they do not."""
        w, part, no_rows = self.working, step / PARTS, np.empty((0, self.working.row_size))
        for k in range(PARTS):
            watch[loop.STEPS] = -4.0  # no multiple of a stride that long, nor are the next: there is no room for rows
            self.code = self._call(part, 1, 10**9, no_rows, watch, w.surfaces)
            if self.code < status.CONTACT and self.code != status.COMPLETED:
                return k * part
            if self.code >= status.CONTACT and levels == 1:
                self._call(part, 1, 10**9, no_rows, watch, np.zeros_like(w.surfaces))
                return (k + 1) * part
            if self.code >= status.CONTACT:
                gone = self._by_parts(part, levels - 1, watch)
                if gone is not None:
                    return k * part + gone
        return None

    def _advance(self, segment: Segment, count: int, rows: Floats) -> int:
        """Call the compiled loop for some steps of a segment."""
        return self._call(segment.step, count, segment.stride, rows, self.watch.array, self.working.surfaces)

    def _call(self, step: float, count: int, stride: int, rows: Floats, watch: Floats, surfaces: Floats) -> int:
        """Call the compiled loop; a potential of the user's that raises ends the run like any other trouble."""
        w = self.working
        try:
            code: int = w.advance(
                self.kernel,
                w.measure,
                w.touching,
                self.shares,
                w.attraction,
                w.parameters,
                w.constants,
                surfaces,
                w.state,
                w.before,
                watch,
                step,
                count,
                stride,
                rows,
            )
        except Exception as error:  # whatever the user's function raises, in the middle of a step
            w.state[: w.before.size] = w.before
            self.raised = f"the potential raised {type(error).__name__}: {brief(error)}"
            return status.NOT_FINITE
        return code

    def _keep(self, segment: Segment) -> None:
        """Close a segment, with the last state as a row where that is not one yet."""
        watch = self.watch.array
        done = self.done + int(watch[loop.STEPS])
        if done % segment.stride or self.gone:
            self.rows.append(self._row())
            self.times.append(np.array([self.elapsed + done * segment.step + self.gone]))
        self.elapsed += done * segment.step + self.gone
        self.steps += done
        self.segment += 1
        self.done, watch[loop.STEPS], self.window = 0, 0, None

    def take_rows(self) -> tuple[Floats, Motion]:
        """Return the rows that have been saved since the last call, with their times; they are kept no longer."""
        if self.segment < len(self.segments):
            self._close_window(self.segments[self.segment])
        rows = np.concatenate([np.empty((0, self.working.row_size)), *self.rows])
        times = np.concatenate([np.empty(0), *self.times])
        self.rows, self.times = [], []
        return self.begin + times, self.working.from_rows(rows, times)

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
        return {
            "state": self.working.state.copy(),
            "watch": self.watch.array.copy(),
            "of_rows": self.of_rows.array.copy(),
            **{name: getattr(self, name) for name in CHECKPOINT},
        }

    def restore(self, checkpoint: dict[str, Any]) -> None:
        """Go on from a checkpoint of a run with the same beginning; the rows before it are not made again."""
        self.working.state[:] = checkpoint["state"]
        self.watch.array[:] = checkpoint["watch"]
        self.of_rows.array[:] = checkpoint["of_rows"]
        for name in CHECKPOINT:
            setattr(self, name, checkpoint[name])
        self.rows, self.times = [], []

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed: the rows in memory, or those that were taken before."""
        time, motion = rows or self.take_rows()
        ended, message = self._end()
        return Outcome(
            time=time,
            motion=motion,
            watch=self.watch,
            closest_time=self.begin + self.closest_time,
            status=ended,
            message=message,
            steps=self.steps,
            step=self.segments[0].step if self.segments else 0.0,
            wall_time=self.wall_time,
            pressed=bool(self.pressed),
        )

    def _end(self) -> tuple[str, str]:
        """Return the status and what there is to say about it."""
        now = self.begin + self.elapsed
        if self.pressed and self.elapsed < self.end * (1 - SLACK):
            return "interrupted", interruption_message(now)
        if self.code >= status.CONTACT:
            return "contact", contact_message(self.system, self.code - status.CONTACT, now)
        if self.code == status.NOT_FINITE:
            what = "positions, momenta or gravity are not numbers any more"
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
