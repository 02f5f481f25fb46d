"""A run by SciPy's solvers on the continuous equations, watched at every step they take and at every row."""

import time
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import numpy as np
from scipy import integrate

from binaryast import equations
from binaryast.arc_runs import ArcRun
from binaryast.arcs import Arc, ArcLookout
from binaryast.errors import InputError
from binaryast.events import Event
from binaryast.integrators import RungeKutta
from binaryast.outcome import (
    Happening,
    Outcome,
    Watch,
    interruption_message,
    not_finite_message,
    occurrences,
    overlap,
)
from binaryast.progress import keyboard
from binaryast.schedule import Leg, Segment, row_times, schedule
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, quantity
from binaryast.watchlist import Places, Watchlist
from binaryast.working import Motion
from binaryast.working.base import coinciding, nothing_given
from binaryast.working.bodies import WorkingBodies

OF_SOLVER = ("t", "y", "f", "h_abs")  # what the next step of SciPy's Runge-Kutta methods depends on
NEVER_REJECT = 1e200  # a tolerance for fixed steps


class SolvedRun(ArcRun):
    """One run under way."""

    def __init__(
        self, system: System, state: State, integrator: RungeKutta, leg: Leg, events: Sequence[Event] = ()
    ) -> None:
        self.system, self.integrator, self.begin, self.end = system, integrator, leg.begin, leg.length
        inertial = integrator.is_inertial(system)
        self.equations = equations.continuous(system, frame="inertial" if inertial else "relative")
        self.working = WorkingBodies(system, state)
        self.segments: list[Segment] = []
        if integrator.step is not None:
            self.segments = schedule(leg, integrator.step.value)
            self.times = np.array([0.0, *self._times_of_rows()])
        else:
            self.times = row_times(leg)
        self.y = self.equations.from_state(_about(self.working.origin, state))
        self.start = self.y
        self._set_out(self.y, self.y)
        self.last_row = self.y
        self.solver: Any = None
        self.continued: dict[str, Any] = {}
        self.watch = Watch()
        self.lookout = ArcLookout(Watchlist(events, system, state), self.working.surfaces, leg.begin, self._put)
        if coincide := coinciding(system, state.si.position):
            raise overlap(system, coincide - 1, state.si.position)
        if (pair := self.lookout.overlapping(self.y)) is not None:
            raise overlap(system, pair, state.si.position)
        start = self.equations.invariants(self.y)
        self.equations.rhs(0.0, self.y)  # compiles, where it must, before any bar is shown
        self.watch.begin(start.measures, start.potential_energy)

    def _times_of_rows(self) -> Iterator[float]:
        """Yield when rows are saved, segment by segment of equal steps, the last at the very end."""
        begin, left = 0.0, sum(segment.steps // segment.stride for segment in self.segments)
        for segment in self.segments:
            for k in range(1, segment.steps // segment.stride + 1):
                left -= 1
                yield begin + k * segment.stride * segment.step if left else self.end
            begin += segment.steps * segment.step

    def go(self, show: Callable[[float], None]) -> None:
        """Follow the motion as far as it goes."""
        with keyboard() as self.pressed, np.errstate(all="ignore"):  # SciPy's own arithmetic, on its way to give up
            for solver in self._solvers():
                self.solver = solver
                while solver.status == "running" and self.ended == "completed":
                    began = time.perf_counter()
                    self._step(solver)
                    self.wall_time += time.perf_counter() - began
                    show(self.elapsed)
                    if self.pressed and self.ended == "completed" and self.elapsed < self.end:
                        self.ended, self.message = "interrupted", interruption_message(self.begin + self.elapsed)
                if self.ended != "completed":
                    break
        if self.times[self.saved - 1] != self.elapsed:  # what ended the run is not one of its rows
            self.times = np.append(self.times[: self.saved], self.elapsed)
            self._save(self.y)

    def _save(self, row: Floats) -> None:
        """Keep a row."""
        self.rows.append(row)
        self.last_row = row
        self.saved += 1

    def _solvers(self) -> Iterator[Any]:
        """Yield SciPy's solver; of fixed steps one from each row to the next, to land on them exactly."""
        kind = getattr(integrate, self.integrator.method)
        rhs, atol = self.equations.rhs, self.integrator.atol * self.equations.scales(self.start)
        if not self.segments and self.elapsed < self.end:
            yield self._as_it_was(kind(rhs, 0.0, self.y, self.end, rtol=self.integrator.rtol, atol=atol))
        strides = [segment.stride for segment in self.segments for _ in range(segment.steps // segment.stride)]
        for row, stride in enumerate(strides, start=1):
            if row >= self.saved:  # not before a checkpoint
                begin, end = self.times[row - 1 : row + 1]
                step = (end - begin) / stride
                fixed = {"first_step": step, "max_step": step * (1 + 1e-9)}
                yield self._as_it_was(kind(rhs, begin, self.y, end, rtol=NEVER_REJECT, atol=NEVER_REJECT, **fixed))

    def _as_it_was(self, solver: Any) -> Any:
        """Return a solver in the state of that of a checkpoint, the first time after one."""
        for name, value in self.continued.items():
            setattr(solver, name, value)
        self.continued = {}
        return solver

    def _step(self, solver: Any) -> None:
        """Take one step of the solver, look at what lies in it, and save the rows that it passes."""
        try:
            message = solver.step()
            if solver.status == "failed":
                raise InputError(f"SciPy's solver gave up: {message}")
            between = solver.dense_output()
            walked = self.lookout.walk(Arc(self.elapsed, float(solver.t), self.y, solver.y.copy(), between))
            end, y = walked.end, walked.variables
            while self.saved < len(self.times) and self.times[self.saved] < end:
                due = self.times[self.saved]
                row = between(due)
                self._look(due, row)
                self._save(row)
            self._look(end, y)
        except Exception as error:  # of SciPy, or what a user's potential raises
            self.elapsed, self.y = float(self.times[self.saved - 1]), self.last_row
            self.ended, self.message = "failed", f"{error}; the last good row is at {self.begin + self.elapsed:g} s"
            return
        self.y, self.elapsed = y, end
        self.steps += 1
        if self.saved < len(self.times) and self.times[self.saved] == end:
            self._save(y)
        self._end_by(walked)

    def _look(self, when: float, y: Floats) -> None:
        """Take in what is measured; raise where it is not a number, or an attitude no rotation at all."""
        now = self.equations.invariants(y)
        if not np.all(np.isfinite([*now.measures, now.potential_energy])):
            raise InputError(not_finite_message("the energy or another figure is not a number any more", self.system))
        if np.any(np.linalg.det(self.equations.snapshot(y).R) <= 0):
            raise InputError("an attitude has left SO(3) altogether: tighten the tolerances")
        if self.watch.look(now.measures):
            self.closest_time = when

    def _put(self, y: Floats, places: Places) -> None:
        """Put where the bodies are."""
        now = self.equations.snapshot(y)
        for array, values in zip(places, (now.x, now.v, now.R, now.Omega), strict=True):
            array[:] = values

    def take_rows(self) -> tuple[Floats, Motion]:
        """Return the rows that have been saved since the last call, with their times; they are kept no longer."""
        times = self.times[self.taken : self.saved].copy()
        motion = self._motion(self.rows, times)
        self.rows, self.taken = [], self.saved
        return self.begin + times, motion

    def checkpoint(self) -> dict[str, Any]:
        """Return what the rest of the run depends on, after `take_rows`: SciPy's solver between two of its steps."""
        under_way = self.solver is not None and self.solver.status == "running"
        solver = {name: getattr(self.solver, name) for name in OF_SOLVER} if under_way else {}
        return super().checkpoint() | {"last_row": self.last_row, "solver": solver}

    def restore(self, checkpoint: dict[str, Any], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint of a run with the same beginning; the rows before it are not made again."""
        super().restore(checkpoint, happened)
        self.last_row, self.continued = checkpoint["last_row"], checkpoint["solver"]

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed: the rows in memory, or those that were taken before."""
        time, motion = rows or self.take_rows()
        happened = self.lookout.happened
        then = np.array([one.time - self.begin for one in happened])
        watch, closest_time = self.lookout.with_closest(self.watch, self.closest_time)
        return Outcome(
            time=time,
            motion=motion,
            occurrences=occurrences(happened, self._motion([one.variables for one in happened], then)),
            watch=watch,
            closest_time=self.begin + closest_time,
            status=self.ended,
            message=self.message,
            steps=self.steps,
            step=self.segments[0].step if self.segments else self.elapsed / max(self.steps, 1),
            wall_time=self.wall_time,
            pressed=bool(self.pressed),
        )

    def _motion(self, rows: list[Floats], times: Floats) -> Motion:
        """Return the inertial motion of all bodies at times."""
        n = len(self.system.bodies)
        found = [self.equations.snapshot(row) for row in rows]
        return Motion(
            position=self.working.moving_origin(times) + np.array([one.x for one in found]).reshape(-1, n, 3),
            velocity=self.working.origin[1] + np.array([one.v for one in found]).reshape(-1, n, 3),
            attitude=np.array([one.R for one in found]).reshape(-1, n, 3, 3),
            spin=np.array([one.Omega for one in found]).reshape(-1, n, 3),
            potential_energy=np.array([self.equations.invariants(row).potential_energy for row in rows]),
            **nothing_given(len(rows)),
        )


def _about(origin: tuple[Floats, Floats], state: State) -> State:
    """Return a state about its barycentre: tolerances are relative to what moves there."""
    position, velocity, attitude, spin = state.si
    return State(
        quantity(position - origin[0], "m"),
        quantity(velocity - origin[1], "m / s"),
        attitude,
        quantity(spin, "rad / s"),
    )
