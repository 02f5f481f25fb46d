"""A run by compiled steps: equal steps in segments, the loop called in chunks, and how it ended."""

import time
from collections.abc import Callable
from math import inf, pi

import numpy as np
from astropy.time import TimeDelta

from binaryast import working
from binaryast.errors import StepError
from binaryast.integrators import Stepping
from binaryast.kernels import loop, status
from binaryast.outcome import Outcome, Watch, contact_message, interruption_message, not_finite_message, overlap
from binaryast.perturbations.base import Span
from binaryast.progress import keyboard
from binaryast.schedule import SLACK, Segment
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief
from binaryast.working.base import coinciding

CHUNK_SECONDS = 0.1  # between two looks at the keyboard
GROWTH, MOST_AT_ONCE = 8, 500_000  # of steps between two looks, whatever the clock says
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
        inertial = integrator.is_inertial(system)
        disturbed = bool(system.perturbations)
        self.kernel = integrator.kernel(inertial=inertial, disturbed=disturbed)
        self.shares = integrator.shares.shares
        self.end = sum(segment.steps * segment.step for segment in segments)
        epoch = None if state.epoch is None else state.epoch - TimeDelta(begin, format="sec")
        span = Span(begin, begin + self.end, epoch, state.frame)
        self.working = working.of(system, state, inertial=inertial, span=span if disturbed else None)
        self.watch = Watch()
        self.rows: list[Floats] = [self._row()]
        self.times: list[Floats] = [np.zeros(1)]
        self.code = status.COMPLETED
        self.pressed: list[int] = []
        self.raised, self.gone = "", 0.0  # gone: how far into the last step bodies touch [s]
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0
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
        self.watch.begin(measures, float(w.state[w.potential_at]))

    def go(self, show: Callable[[float], None]) -> None:
        """Take all segments, as far as it goes.

        Raises
        ------
        StepError
            Where the first step has no solution.
        """
        with keyboard() as self.pressed:
            for segment in self.segments:
                self._take(segment, show)
                if self.code != status.COMPLETED or self.pressed:
                    break
        if self.steps == 0 and status.NO_ROTATION <= self.code < status.CONTACT:
            raise self._turn_error()

    def _take(self, segment: Segment, show: Callable[[float], None]) -> None:
        """Take one segment, in chunks short enough for the keyboard and the progress bar."""
        rows = np.empty((segment.steps // segment.stride, self.working.row_size))
        self.rows.append(rows)
        watch = self.watch.array
        energy_error = float(watch[loop.ENERGY_ERROR])
        if self.integrator.changed is not None:
            self._change(self.integrator.changed.shares, segment.step)
        watch[loop.STEPS] = 0
        chunk = 16
        while (left := segment.steps - int(watch[loop.STEPS])) and self.code == status.COMPLETED and not self.pressed:
            began = time.perf_counter()
            count = min(chunk, left)
            self.code = self._advance(segment, count, rows)
            if self.code >= status.CONTACT:
                self._look_closer(segment, rows)
            spent = time.perf_counter() - began
            self.wall_time += spent
            chunk = max(1, min(GROWTH * count, MOST_AT_ONCE, int(count * CHUNK_SECONDS / max(spent, 1e-6))))
            show(self.elapsed + watch[loop.STEPS] * segment.step)
        if self.integrator.changed is not None:
            watch[loop.ENERGY_ERROR] = energy_error
            self._change_back(-self.integrator.changed.shares[::-1], segment)
        self._keep(segment)

    def _change(self, shares: Floats, step: float) -> None:
        """Change the variables of the working state, or change them back."""
        w = self.working
        code = self.kernel(
            w.state, w.constants, np.ascontiguousarray(shares), w.attraction, w.parameters, w.external, step
        )
        self.code = self.code or code

    def _change_back(self, shares: Floats, segment: Segment) -> None:
        """Change the variables of the rows of a segment and of the state at its end back, and watch their energy."""
        w = self.working
        end, rows = w.state.copy(), self.rows[-1]
        for k in range(int(self.watch.array[loop.STEPS]) // segment.stride):
            w.state[:] = 0
            w.state[: w.row_size] = rows[k]
            self._change(shares, segment.step)
            self.watch.look(w.measure(w.state, w.constants))
            rows[k] = w.state[: w.row_size]
        w.state[:] = end
        self._change(shares, segment.step)

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
                self.closest_time = self.elapsed + self.watch.array[loop.STEPS] * segment.step + gone
                self.watch.array[[loop.CLOSEST, loop.CLOSEST_STEP]] = separation, 0
            self.watch.array[loop.ENERGY_ERROR : loop.CLOSEST] = watch[loop.ENERGY_ERROR : loop.CLOSEST]

    def _by_parts(self, step: float, levels: int, watch: Floats) -> float | None:
        """Follow a step in parts; return after what time bodies touch or it goes wrong, None where they do not."""
        w, part, no_rows = self.working, step / PARTS, np.empty((0, self.working.row_size))
        watch[loop.STEPS] = -2.0 * PARTS  # never a multiple of a stride that long
        for k in range(PARTS):
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
                w.external,
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
            self.raised = f"a potential or a force raised {type(error).__name__}: {brief(error)}"
            return status.NOT_FINITE
        return code

    def _keep(self, segment: Segment) -> None:
        """Close a segment: its saved rows with their times, and the last state where that is not one of them."""
        watch = self.watch.array
        done = int(watch[loop.STEPS])
        saved = done // segment.stride
        self.rows[-1] = self.rows[-1][:saved]
        self.times.append(self.elapsed + np.arange(1, saved + 1) * (segment.stride * segment.step))
        if done % segment.stride or self.gone:
            self.rows.append(self._row())
            self.times.append(np.array([self.elapsed + done * segment.step + self.gone]))
        if watch[loop.CLOSEST_STEP]:
            self.closest_time = self.elapsed + watch[loop.CLOSEST_STEP] * segment.step
            watch[loop.CLOSEST_STEP] = 0
        self.elapsed += done * segment.step + self.gone
        self.steps += done

    def outcome(self) -> Outcome:
        """Return what has been computed."""
        rows, times = np.concatenate(self.rows), np.concatenate(self.times)
        ended, message = self._end()
        return Outcome(
            time=self.begin + times,
            motion=self.working.from_rows(rows, times),
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
