"""The driver of a run: it checks, cuts the time into equal steps, calls the compiled loop in chunks, and reports."""

import platform
import time
import warnings
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from math import pi
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast import constants, working
from binaryast.errors import ContactError, EndWarning, InputError, StepError, StepWarning
from binaryast.integrators import Integrator
from binaryast.kernels import layout, loop, status
from binaryast.kernels.contact import pair_touches
from binaryast.kernels.jit import source_hash
from binaryast.kernels.measure import pair_measure
from binaryast.progress import bar, keyboard
from binaryast.schedule import SLACK, Segment, schedule
from binaryast.state import State
from binaryast.system import System
from binaryast.trajectory import Trajectory, TrajectoryFloats
from binaryast.units import Floats, brief, quantity, to_si

DOUBTFUL_ENERGY_ERROR = 0.01
DOUBTFUL_TURN = 2 * pi / 20  # rad in one step
CHUNK_SECONDS = 0.1  # between two looks at the keyboard


def propagate(
    system: System,
    state: State,
    *,
    duration: Quantity,
    integrator: Integrator,
    save_every: Quantity | None = None,
    progress: bool = False,
) -> Trajectory:
    """Follow a system through time.

    Parameters
    ----------
    system : System
        The bodies and their gravity.
    state : State
        Where they start. A barycentre that moves goes on doing so.
    duration : Quantity
        How long (time); met exactly.
    integrator : Integrator
        How, such as ``LGVI(step=40 * u.s)``. The step used is the largest one up to this that divides ``save_every``.
    save_every : Quantity, optional
        Time between saved rows; met exactly, with one more row at the end where it does not divide ``duration``. By
        default at most 2000 rows are kept, each a whole number of steps apart.
    progress : bool
        Whether to show a bar with the simulated and the remaining time, on standard error.

    Returns
    -------
    Trajectory
        Also where the run ends early, by contact, by Ctrl-C or because a step had no solution: its ``status`` says so.

    Raises
    ------
    StepError
        For a step longer than the run, or one that turns a body by h Omega >= 1, for which (128) has no solution.
    ContactError
        Where the bodies overlap at the start.
    InputError
        For anything else that cannot be.

    Warns
    -----
    StepWarning
        For a step above 1/20 of the fastest turn.
    EndWarning
        Where the run ends early by itself.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> run.status, run.steps
    ('completed', 2160)
    """
    _check_kinds(system, state, integrator)
    end = float(to_si(duration, "s", "duration", sign="positive"))
    interval = None if save_every is None else float(to_si(save_every, "s", "save_every", sign="positive"))
    segments = schedule(end, integrator.step.value, interval)
    _check_turns(system, state, integrator, max(segment.step for segment in segments))
    run = _Run(system, state, integrator, segments)
    with bar(end, progress) as show:
        run.go(show)
    return run.trajectory()


def _check_kinds(system: Any, state: Any, integrator: Any) -> None:
    """Raise where an argument is another object than it should be."""
    for name, value, kind in (
        ("system", system, System),
        ("state", state, State),
        ("integrator", integrator, Integrator),
    ):
        if not isinstance(value, kind):
            raise InputError(f"{name}: expected an object of class {kind.__name__}, got {brief(value)}")
    if len(state.si.position) != len(system.bodies):
        raise InputError(f"state: it has {len(state.si.position)} bodies, the system has {len(system.bodies)}")


def _check_turns(system: System, state: State, integrator: Integrator, step: float) -> None:
    """Refuse a step without a solution, and warn of a doubtful one."""
    for body, spin in zip(system.bodies, np.linalg.norm(state.si.spin, axis=1), strict=True):
        turn = step * spin
        if turn >= integrator.largest_turn:
            raise _turn_error(body.name, float(spin), integrator, step)
        if turn > DOUBTFUL_TURN:
            warnings.warn(
                f"a step of {step:g} s turns {body.name} by {turn:.2g} rad: its attitude will run ahead by "
                f"about {turn**3 / 6:.2g} rad a step; {0.05 * step / turn:.3g} s would turn it by 0.05 rad",
                StepWarning,
                stacklevel=3,
            )


def _turn_error(name: str, spin: float, integrator: Integrator, step: float) -> StepError:
    """Return the error of a step that turns a body too far."""
    largest = integrator.largest_turn / spin
    return StepError(
        f"step: {name} spins at {spin:.6g} rad/s (once in {2 * pi / spin / 3600:.4g} h), h Omega = {step * spin:.4g}; "
        f"the implicit equation (128) has a solution only below {integrator.largest_turn:g}: the step must be below "
        f"{largest:.6g} s, got {step:g} s"
    )


class _Run:
    """One run under way."""

    def __init__(self, system: System, state: State, integrator: Integrator, segments: list[Segment]) -> None:
        self.system, self.integrator, self.segments = system, integrator, segments
        self.start = state
        self.end = sum(segment.steps * segment.step for segment in segments)
        self.origin = working.barycentre(system, state)
        self.constants = working.constants(system)
        self.surfaces = working.surfaces(system)
        self.state = working.to_working(system, state)
        self.watch = np.zeros(loop.WATCH_SIZE)
        self.rows: list[Floats] = [self.state[None, : layout.ROW_SIZE].copy()]
        self.times: list[Floats] = [np.zeros(1)]
        self.code = status.COMPLETED
        self.pressed: list[int] = []
        self.raised = ""
        self.steps, self.elapsed, self.wall_time, self.closest_time = 0, 0.0, 0.0, 0.0
        self._begin()

    def _begin(self) -> None:
        """Look at the start: overlap; and keep the references."""
        energy, *momentum, rotation_error, separation = pair_measure(self.state, self.constants)
        if separation == 0 or (
            separation < self.surfaces[0] and pair_touches(self.state, self.surfaces, *self.state[:3])
        ):
            primary, secondary = self.system.names
            raise ContactError(
                f"state: {primary} and {secondary} overlap at the start, {separation:g} m apart: "
                "expected surfaces that do not touch; move them further apart"
            )
        self.watch[loop.ENERGY] = energy
        self.watch[loop.ANGULAR_MOMENTUM : loop.ANGULAR_MOMENTUM + 3] = momentum
        self.watch[loop.ROTATION_ERROR] = rotation_error
        self.watch[loop.CLOSEST] = separation
        self.potential = abs(self.state[layout.POTENTIAL])

    def go(self, show: Any) -> None:
        """Take all segments, as far as it goes."""
        with keyboard() as self.pressed:
            for segment in self.segments:
                self._take(segment, show)
                if self.code != status.COMPLETED or self.pressed:
                    break
        if self.steps == 0 and self.code in (status.NO_ROTATION_1, status.NO_ROTATION_2):
            raise self._turn_error()

    def _take(self, segment: Segment, show: Any) -> None:
        """Take one segment, in chunks short enough for the keyboard and the progress bar."""
        rows = np.empty((segment.steps // segment.stride, layout.ROW_SIZE))
        self.rows.append(rows)
        self.watch[loop.STEPS] = 0
        chunk = 16
        while (
            (left := segment.steps - int(self.watch[loop.STEPS])) and self.code == status.COMPLETED and not self.pressed
        ):
            began = time.perf_counter()
            count = min(chunk, left)
            self.code = self._advance(segment, count, rows)
            spent = time.perf_counter() - began
            self.wall_time += spent
            chunk = max(1, min(100 * count, int(count * CHUNK_SECONDS / max(spent, 1e-6))))
            show(self.elapsed + self.watch[loop.STEPS] * segment.step)
        self._keep(segment)

    def _advance(self, segment: Segment, count: int, rows: Floats) -> int:
        """Call the compiled loop; a potential of the user's that raises ends the run like any other trouble."""
        try:
            code: int = loop.advance(
                self.integrator.kernel,
                pair_measure,
                pair_touches,
                self.system.gravity.potential,
                self.system.parameters,
                self.constants,
                self.surfaces,
                self.state,
                self.watch,
                segment.step,
                count,
                segment.stride,
                rows,
            )
        except Exception as error:  # whatever the user's function raises
            self.raised = f"the potential raised {type(error).__name__}: {brief(error)}"
            return status.NOT_FINITE
        return code

    def _keep(self, segment: Segment) -> None:
        """Close a segment: its saved rows with their times, and the last state where that is not one of them."""
        done = int(self.watch[loop.STEPS])
        saved = done // segment.stride
        self.rows[-1] = self.rows[-1][:saved]
        self.times.append(self.elapsed + np.arange(1, saved + 1) * (segment.stride * segment.step))
        if done % segment.stride:
            self.rows.append(self.state[None, : layout.ROW_SIZE].copy())
            self.times.append(np.array([self.elapsed + done * segment.step]))
        if self.watch[loop.CLOSEST_STEP]:
            self.closest_time = self.elapsed + self.watch[loop.CLOSEST_STEP] * segment.step
            self.watch[loop.CLOSEST_STEP] = 0
        self.elapsed += done * segment.step
        self.steps += done

    def trajectory(self) -> Trajectory:
        """Return what has been computed."""
        rows, times = np.concatenate(self.rows), np.concatenate(self.times)
        motion = working.from_rows(self.system, rows, times, self.origin)
        ended, message = self._end()
        if ended in ("contact", "failed"):
            warnings.warn(f"the run ended after {self.elapsed:g} s: {message}", EndWarning, stacklevel=3)
        figures = self._figures(motion)
        error = min(figures["max_relative_energy_error"], figures["max_energy_error_over_potential"])
        if error > DOUBTFUL_ENERGY_ERROR:
            warnings.warn(
                f"the energy was wrong by {error:.2g} of its size at some step: a step of {self.segments[0].step:g} s "
                "is too large for what happened, such as a close approach",
                StepWarning,
                stacklevel=3,
            )
        return Trajectory(
            system=self.system,
            integrator=self.integrator,
            si=TrajectoryFloats(times, *motion),
            epoch=self.start.epoch,
            frame=self.start.frame,
            status=ended,
            message=message,
            steps=self.steps,
            step=quantity(self.segments[0].step, "s"),
            wall_time=quantity(self.wall_time, "s"),
            provenance=provenance(),
            **figures,
        )

    def _figures(self, motion: working.Motion) -> dict[str, Any]:
        """Return the largest errors in the ways in which they are reported."""
        watch = self.watch
        energy_error = float(watch[loop.ENERGY_ERROR])
        momentum = float(np.linalg.norm(watch[loop.ANGULAR_MOMENTUM : loop.ANGULAR_MOMENTUM + 3]))
        masses = np.array([body.si.mass for body in self.system.bodies])
        linear = np.einsum("i,nij->nj", masses, motion.velocity)
        speeds = masses @ np.linalg.norm(motion.velocity[0], axis=1)
        return {
            "max_relative_energy_error": _over(energy_error, abs(watch[loop.ENERGY])),
            "max_energy_error": quantity(energy_error, "J"),
            "max_energy_error_over_potential": _over(energy_error, self.potential),
            "max_relative_angular_momentum_error": _over(float(watch[loop.MOMENTUM_ERROR]), momentum),
            "max_relative_linear_momentum_error": _over(
                float(np.linalg.norm(linear - linear[0], axis=1).max()), speeds
            ),
            "max_rotation_error": float(watch[loop.ROTATION_ERROR]),
            "closest_approach": quantity(float(watch[loop.CLOSEST]), "m"),
            "closest_approach_time": quantity(self.closest_time, "s"),
        }

    def _end(self) -> tuple[str, str]:
        """Return the status and what there is to say about it."""
        primary, secondary = self.system.names
        if self.pressed and self.elapsed < self.end * (1 - SLACK):
            return "interrupted", f"stopped after {self.elapsed:g} s; go on from the last row, run[-1]"
        if self.code == status.CONTACT:
            return "contact", f"{secondary} touched {primary} within a step of {self.elapsed:g} s"
        if self.code == status.NOT_FINITE:
            reason = self.raised or "positions, momenta or gravity are not numbers any more"
            return "failed", f"{reason}; the last good row is at {self.elapsed:g} s"
        if self.code != status.COMPLETED:
            return "failed", str(self._turn_error())
        return "completed", ""

    def _turn_error(self) -> StepError:
        """Return the error of the body that turns too fast now."""
        secondary = self.code == status.NO_ROTATION_1
        body = self.system.secondary if secondary else self.system.primary
        at = layout.MOMENTUM_1 if secondary else layout.MOMENTUM_2
        torque = layout.TORQUE_1 if secondary else layout.TORQUE_2
        step = max(segment.step for segment in self.segments)
        momentum = self.state[at : at + 3] + step / 2 * self.state[torque : torque + 3]
        spin = float(np.linalg.norm(momentum / body.si.moments))
        return _turn_error(body.name, spin, self.integrator, step)


def _over(error: float, size: float) -> float:
    """Return a relative error; the absolute one where there is nothing to compare it with."""
    return float(error / size) if size > 0 else error


def provenance() -> dict[str, str]:
    """Return what is needed to repeat a run: versions, sources, machine, date, and G."""
    return _origin() | {"date": datetime.now(UTC).isoformat(timespec="seconds")}


@cache
def _origin() -> dict[str, str]:
    """Return what does not change in a process: looking it up takes longer than a short run."""
    return {
        "binaryast": constants.VERSION,
        "kernels": source_hash(),
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "numba", "astropy", "h5py")},
        "machine": f"{platform.machine()} {platform.system()}",
        "host": platform.node(),
        "G": repr(constants.G),
    }
