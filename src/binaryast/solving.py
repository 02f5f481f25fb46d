"""A run by SciPy's solvers on the continuous equations, watched at every step they take."""

import time
from collections.abc import Iterator
from typing import Any

import numpy as np
from scipy import integrate

from binaryast import equations
from binaryast.integrators import RungeKutta
from binaryast.outcome import Outcome, Watch, contact_message, interruption_message, overlap
from binaryast.progress import keyboard
from binaryast.schedule import Segment, row_times, schedule
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working import Motion
from binaryast.working.bodies import WorkingBodies

NEVER_REJECT = 1e200  # a tolerance for fixed steps


class SolvedRun:
    """One run under way."""

    def __init__(
        self, system: System, state: State, integrator: RungeKutta, end: float, interval: float | None
    ) -> None:
        self.system, self.integrator, self.end = system, integrator, end
        inertial = integrator.is_inertial(len(system.bodies))
        self.equations = equations.continuous(system, frame="inertial" if inertial else "relative")
        self.working = WorkingBodies(system, state)
        self.y = self.equations.from_state(state)
        self.segments: list[Segment] = []
        if integrator.step is not None:
            self.segments = schedule(end, integrator.step.value, interval)
            self.times = np.concatenate([[0.0], *self._times_of_rows()])
        else:
            self.times = row_times(end, interval)
        self.watch = Watch()
        self.rows = [self.y]
        self.ended, self.message = "completed", ""
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0
        self.equations.rhs(0.0, self.y)  # compiles, where it must, before any bar is shown
        start = self.equations.invariants(self.y)
        self.watch.begin(start.measures, start.potential_energy)
        if touching := self._touching(self.y, self.y):
            raise overlap(system, touching - 1, state.si.position)

    def _times_of_rows(self) -> Iterator[Floats]:
        """Yield when rows are saved, segment by segment of equal steps."""
        begin = 0.0
        for segment in self.segments:
            yield begin + np.arange(1, segment.steps // segment.stride + 1) * (segment.stride * segment.step)
            begin += segment.steps * segment.step

    def go(self, show: Any) -> None:
        """Follow the motion as far as it goes."""
        with keyboard() as pressed:
            for solver in self._solvers():
                while solver.status == "running" and self.ended == "completed":
                    began = time.perf_counter()
                    self._step(solver)
                    self.wall_time += time.perf_counter() - began
                    show(self.elapsed)
                    if pressed and self.elapsed < self.end:
                        self.ended, self.message = "interrupted", interruption_message(self.elapsed)
                if self.ended != "completed":
                    break
        if self.times[len(self.rows) - 1] != self.elapsed:  # what ended the run is not one of its rows
            self.times = np.append(self.times[: len(self.rows)], self.elapsed)
            self.rows.append(self.y)

    def _solvers(self) -> Iterator[Any]:
        """Yield SciPy's solver, one for each segment of fixed steps."""
        kind = getattr(integrate, self.integrator.method)
        rhs, scales = self.equations.rhs, self.equations.scales(self.y)
        if not self.segments:
            yield kind(rhs, 0.0, self.y, self.end, rtol=self.integrator.rtol, atol=self.integrator.atol * scales)
        begin = 0.0
        for segment in self.segments:
            for _ in range(segment.steps // segment.stride):  # to land on the rows exactly
                end = begin + segment.stride * segment.step
                steps = {"first_step": min(segment.step, end - begin), "max_step": segment.step * (1 + 1e-9)}
                yield kind(rhs, begin, self.y, end, rtol=NEVER_REJECT, atol=NEVER_REJECT, **steps)
                begin = end

    def _step(self, solver: Any) -> None:
        """Take one step of the solver, look at it, and save the rows that it passes."""
        message = solver.step()
        if solver.status == "failed" or not np.all(np.isfinite(solver.y)):
            self.ended, self.message = "failed", f"SciPy's solver gave up after {self.elapsed:g} s: {message}"
            return
        if np.any(np.linalg.det(self.equations.snapshot(solver.y).R) <= 0):
            self.ended, self.message = "failed", f"an attitude has left SO(3) altogether after {self.elapsed:g} s"
            return
        before, self.y, self.elapsed = self.y, solver.y.copy(), float(solver.t)
        self.steps += 1
        now = self.equations.invariants(self.y)
        if self.watch.look(now.measures):
            self.closest_time = self.elapsed
        between: Any = None
        while len(self.rows) < len(self.times) and self.times[len(self.rows)] <= self.elapsed * (1 + 1e-12):
            due = self.times[len(self.rows)]
            if abs(due - self.elapsed) <= 1e-12 * self.elapsed:
                self.times[len(self.rows)] = self.elapsed
                self.rows.append(self.y)
            else:
                between = solver.dense_output() if between is None else between
                self.rows.append(between(due))
        if touching := self._touching(before, self.y):
            self.ended, self.message = "contact", contact_message(self.system, touching - 1, self.elapsed)

    def _touching(self, before: Floats, after: Floats) -> int:
        """Return which pair touches within a step, counted from 1, or 0."""
        now = self.equations.snapshot(after)
        return self.working.pair_touching(self.equations.snapshot(before).x, now.x, now.R)

    def outcome(self) -> Outcome:
        """Return what has been computed."""
        moments = [self.equations.snapshot(row) for row in self.rows]
        motion = Motion(
            position=np.array([moment.x for moment in moments]),
            velocity=np.array([moment.v for moment in moments]),
            attitude=np.array([moment.R for moment in moments]),
            spin=np.array([moment.Omega for moment in moments]),
            potential_energy=np.array([self.equations.invariants(row).potential_energy for row in self.rows]),
        )
        return Outcome(
            time=self.times[: len(self.rows)].copy(),
            motion=motion,
            watch=self.watch,
            closest_time=self.closest_time,
            status=self.ended,
            message=self.message,
            steps=self.steps,
            step=self.segments[0].step if self.segments else self.elapsed / max(self.steps, 1),
            wall_time=self.wall_time,
        )
