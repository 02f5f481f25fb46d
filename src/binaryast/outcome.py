"""What a run hands over to be reported, however it was followed."""

from dataclasses import dataclass, field
from math import inf, pi
from typing import NamedTuple

import numpy as np

from binaryast.errors import ContactError, StepError
from binaryast.events import Event
from binaryast.gravity import Gravity
from binaryast.integrators import Stepping
from binaryast.kernels import loop
from binaryast.occurrences import OccurrenceFloats
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working import Motion


@dataclass
class Watch:
    """What is watched at every step: the references at the start, and how far from them the run went.

    ``array`` has the layout of ``kernels/loop.py``; compiled loops write into it.
    """

    array: Floats = field(default_factory=lambda: np.zeros(loop.WATCH_SIZE))
    potential_energy: float = 0.0  # at the start

    def begin(self, measures: tuple[float, ...], potential_energy: float) -> None:
        """Keep the references."""
        self.array[: loop.REFERENCES] = measures[: loop.REFERENCES]
        self.array[loop.ROTATION_ERROR] = measures[loop.REFERENCES]
        self.array[loop.CLOSEST] = measures[loop.REFERENCES + 1]
        self.potential_energy = potential_energy

    def look(self, measures: tuple[float, ...]) -> bool:
        """Take in what was measured at one more step; whether the bodies were never so close before."""
        array = self.array
        new = np.array(measures)
        differences = np.abs(new[: loop.REFERENCES] - array[: loop.REFERENCES])
        angular, linear = (
            float(np.linalg.norm(differences[at : at + 3])) for at in (loop.ANGULAR_MOMENTUM, loop.LINEAR_MOMENTUM)
        )
        for at, value in (
            (loop.ENERGY_ERROR, differences[loop.ENERGY]),
            (loop.ANGULAR_ERROR, angular),
            (loop.LINEAR_ERROR, linear),
            (loop.ROTATION_ERROR, new[loop.REFERENCES]),
        ):
            array[at] = max(array[at], value)
        closer = bool(new[loop.REFERENCES + 1] < array[loop.CLOSEST])
        array[loop.CLOSEST] = min(array[loop.CLOSEST], new[loop.REFERENCES + 1])
        return closer


@dataclass(frozen=True)
class Outcome:
    """A run that is over.

    Attributes
    ----------
    time, motion : ndarray, Motion
        The saved rows.
    watch, closest_time : Watch, float
        The figures over every step, and when the bodies were closest [s].
    status, message : str
        How it ended.
    steps, step, wall_time : int, float, float
        Steps taken, their size [s], and how long they took [s].
    occurrences : OccurrenceFloats
        What happened, in order of time.
    pressed : bool
        Whether there was a Ctrl-C, be it too late to end it early.
    """

    time: Floats
    motion: Motion
    watch: Watch
    closest_time: float
    status: str
    message: str
    steps: int
    step: float
    wall_time: float
    occurrences: OccurrenceFloats
    pressed: bool = False


def contact_message(system: System, pair: int, after: float) -> str:
    """Return what is said of a contact."""
    primary, secondary = (system.names[i] for i in system.pairs[pair][:2])
    return f"{secondary} touched {primary} after {after:.9g} s"


class Happening(NamedTuple):
    """What happened, however the run was followed: which event, when, in which direction, and the variables then."""

    event: int
    time: float
    direction: int
    variables: Floats


def occurrences(happened: list[Happening], motion: Motion) -> OccurrenceFloats:
    """Return what happened, with where the bodies were then."""
    event, time, direction = (np.array([one[k] for one in happened], dtype=float) for k in range(3))
    return OccurrenceFloats(event, time, direction, *motion[:4])


def event_message(event: Event, system: System, after: float) -> str:
    """Return what is said of an event that ends a run."""
    return f"{event.title(system)} after {after:.9g} s"


def not_finite_message(what: str, system: System) -> str:
    """Return what is said where something is not a number: also why a gravity with limits of its own may be none."""
    limits = {pair.gravity.limits for pair in system.pairs} - {Gravity.limits}
    return ": ".join([what, *sorted(limits)])


def overlap(system: System, pair: int, position: Floats) -> ContactError:
    """Return the error of two bodies that touch at the start; positions (n, 3)."""
    two, one = system.pairs[pair][:2]
    distance = float(np.linalg.norm(position[one] - position[two]))
    return ContactError(
        f"state: {system.names[two]} and {system.names[one]} overlap at the start, {distance:g} m apart: "
        "expected surfaces that do not touch; move them further apart"
    )


def interruption_message(after: float) -> str:
    """Return what is said after Ctrl-C."""
    return f"stopped after {after:g} s; go on from the last row, run[-1]"


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
