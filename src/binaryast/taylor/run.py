"""A run by heyoka's Taylor series, watched at every step and at every row."""

import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from binaryast.arc_runs import ArcRun
from binaryast.arcs import Arc, ArcLookout
from binaryast.errors import InputError
from binaryast.events import Event
from binaryast.integrators import Taylor
from binaryast.kernels.bodies import layout
from binaryast.kernels.bodies.looking import view
from binaryast.occurrences import OccurrenceFloats
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
from binaryast.schedule import Leg, row_times
from binaryast.state import State
from binaryast.system import System
from binaryast.taylor import compiled
from binaryast.taylor.motion import Formulas
from binaryast.units import Floats
from binaryast.watchlist import Places, Watchlist
from binaryast.working import Motion
from binaryast.working.base import coinciding
from binaryast.working.bodies import WorkingBodies

SMALLEST_STEP = 1e-15  # over the time since the start: smaller ones lead nowhere


class TaylorRun(ArcRun):
    """One run under way."""

    def __init__(
        self, system: System, state: State, integrator: Taylor, leg: Leg, events: Sequence[Event] = ()
    ) -> None:
        self.system, self.begin, self.end = system, leg.begin, leg.length
        compiled.heyoka()  # says at once where it is missing
        self.times = row_times(leg)
        self.working = WorkingBodies(system, state)
        self.watch = Watch()
        self.formulas = Formulas(system, state, self.working)
        self._set_out(self.formulas.start, self._row())
        self.lookout = ArcLookout(Watchlist(events, system, state), self.working.surfaces, leg.begin, self._see)
        self._begin(state)
        self.integrator = compiled.integrator(self.formulas, integrator.tolerance, compact=integrator.compact)

    def _row(self) -> Floats:
        return self.working.state[: self.working.row_size].copy()

    def _begin(self, state: State) -> None:
        """Look at the start: overlap; and keep the references."""
        w = self.working
        if coincide := coinciding(self.system, state.si.position):
            raise overlap(self.system, coincide - 1, state.si.position)
        if (pair := self.lookout.overlapping(self.formulas.start)) is not None:
            raise overlap(self.system, pair, state.si.position)
        self.watch.begin(w.measure(w.state, w.constants), float(w.state[w.potential_at]))

    def go(self, show: Callable[[float], None]) -> None:
        """Follow the motion as far as it goes."""
        with keyboard() as self.pressed:
            while self.elapsed < self.end and self.ended == "completed":
                began = time.perf_counter()
                self._step()
                self.wall_time += time.perf_counter() - began
                show(self.elapsed)
                if self.pressed and self.ended == "completed" and self.elapsed < self.end:
                    self.ended, self.message = "interrupted", interruption_message(self.begin + self.elapsed)
        if self.times[self.saved - 1] != self.elapsed:  # what ended the run is not one of its rows
            self.times = np.append(self.times[: self.saved], self.elapsed)
            self._put(self.y)
            self.working.exert()
            self._save()

    def _save(self) -> None:
        """Keep what is in the working state as a row."""
        self.rows.append(self._row())
        self.saved += 1

    def _step(self) -> None:
        """Take one step, look at what lies in it, and save the rows that it passes."""
        saved = self.saved
        try:
            reached = self._advance()
            walked = self.lookout.walk(Arc(self.elapsed, reached, self.y, self.integrator.state.copy(), self._at))
            end, y = walked.end, walked.variables
            self._look(end, y)
            while self.saved < len(self.times) and self.times[self.saved] < end:
                due = float(self.times[self.saved])
                self._look(due, self._at(due))
                self._save()
        except InputError as error:
            del self.rows[len(self.rows) - (self.saved - saved) :]
            self.saved = saved
            self.ended, self.message = "failed", f"{error}; the last good row is at {self.begin + self.elapsed:g} s"
            return
        self.y, self.elapsed = y, end
        self.steps += 1
        if self.saved < len(self.times) and self.times[self.saved] == end:
            self._look(end, y)
            self._save()
        self._end_by(walked)

    def _advance(self) -> float:
        """Have heyoka take a step, up to the end of the run; return the time that it reaches."""
        unit = self.formulas.time
        self.formulas.normalise(self.integrator.state)
        left = self.end / unit - self.integrator.time
        _, step = self.integrator.step(left, write_tc=True)
        if not np.all(np.isfinite(self.integrator.state)):
            raise InputError(not_finite_message("positions, spins or gravity are not numbers any more", self.system))
        if step < SMALLEST_STEP * self.integrator.time:
            raise InputError("the steps have become too small to lead anywhere: bodies are too near one another")
        reached = float(self.integrator.time) * unit
        return self.end if step >= left or reached > self.end else reached

    def _at(self, when: float) -> Floats:
        """Return the variables at a time within the last step, by its own series."""
        return np.array(self.integrator.update_d_output(when / self.formulas.time))

    def _put(self, y: Floats) -> None:
        self.working.state[: layout.MOTION * self.working.count] = self.formulas.motion(y)

    def _look(self, when: float, y: Floats) -> None:
        """Put variables into the working state, and take in what is measured there."""
        w = self.working
        self._put(y)
        w.exert()
        measures = w.measure(w.state, w.constants)
        if not np.all(np.isfinite([*measures, w.state[w.potential_at]])):
            raise InputError(not_finite_message("the energy or another figure is not a number any more", self.system))
        if self.watch.look(measures):
            self.closest_time = when

    def _see(self, y: Floats, places: Places) -> None:
        """Put where the bodies are."""
        w = self.working
        w.before[: layout.MOTION * w.count] = self.formulas.motion(y)
        view(w.before, w.constants, w.shares, *places)

    def _occurrences(self) -> OccurrenceFloats:
        """Return what has happened."""
        rows = np.zeros((len(self.lookout.happened), self.working.row_size))
        for row, one in zip(rows, self.lookout.happened, strict=True):
            row[: layout.MOTION * self.working.count] = self.formulas.motion(one.variables)
        times = np.array([one.time - self.begin for one in self.lookout.happened])
        return occurrences(self.lookout.happened, self.working.from_rows(rows, times))

    def take_rows(self) -> tuple[Floats, Motion]:
        """Return the rows that have been saved since the last call, with their times; they are kept no longer."""
        times = self.times[self.taken : self.saved].copy()
        rows = np.array(self.rows).reshape(-1, self.working.row_size)
        self.rows, self.taken = [], self.saved
        return self.begin + times, self.working.from_rows(rows, times)

    def checkpoint(self) -> dict[str, Any]:
        """Return what the rest of the run depends on, after `take_rows`: heyoka's variables and its time."""
        own = {"state": self.integrator.state.copy(), "time": np.array(self.integrator.dtime)}
        return super().checkpoint() | own

    def restore(self, checkpoint: dict[str, Any], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint of a run with the same beginning; the rows before it are not made again."""
        super().restore(checkpoint, happened)
        self.integrator.state[:] = checkpoint["state"]
        self.integrator.dtime = tuple(checkpoint["time"].tolist())

    def outcome(self, rows: tuple[Floats, Motion] | None = None) -> Outcome:
        """Return what has been computed: the rows in memory, or those that were taken before."""
        time, motion = rows or self.take_rows()
        watch, closest_time = self.lookout.with_closest(self.watch, self.closest_time)
        return Outcome(
            time=time,
            motion=motion,
            occurrences=self._occurrences(),
            watch=watch,
            closest_time=self.begin + closest_time,
            status=self.ended,
            message=self.message,
            steps=self.steps,
            step=self.elapsed / max(self.steps, 1),
            wall_time=self.wall_time,
            pressed=bool(self.pressed),
        )
