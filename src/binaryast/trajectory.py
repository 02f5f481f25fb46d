"""The result of a propagation: arrays with time first, what should be conserved and how well, and how it ended."""

import operator
import warnings
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, SupportsIndex, overload

import numpy as np
from astropy.time import Time, TimeDelta
from astropy.units import Quantity

from binaryast import markup, run_file, storage, summaries
from binaryast.between import Between
from binaryast.directions import Directions
from binaryast.errors import CheckError, InputError, StepWarning
from binaryast.events import Event
from binaryast.exports import Exports
from binaryast.impulses import AnyImpulse
from binaryast.integrators import Integrator
from binaryast.occurrences import Occurrence, OccurrenceFloats
from binaryast.rotations import ROTATION_TOLERANCE
from binaryast.rows import TrajectoryFloats, floats_of, nearest_rotations, rotation_errors, rotations_of
from binaryast.run_file import pieces_of
from binaryast.state import RelativeState, State
from binaryast.system import System
from binaryast.units import Floats, brief, numbers, quantity
from binaryast.values import Value
from binaryast.working.base import GIVEN

FIGURES = {  # of the whole run, over every step; with their units
    "max_relative_energy_error": "",
    "max_energy_error": "J",
    "max_energy_error_over_potential": "",
    "max_relative_angular_momentum_error": "",
    "max_relative_linear_momentum_error": "",
    "max_rotation_error": "",
    "closest_approach": "m",
    "closest_approach_time": "s",
    "max_next_degree_term": "",  # over saved rows; None of gravity that is not cut, and in older files
    "accuracy": "",  # None where an integrator was given
    "estimated_error": "",
}
ROUND_OFF = 1e-12  # ||I - R^T R|| above which a state that is taken from a run has the nearest rotations
ABOUT = ("status", "message", "steps", "step", "frame", "wall_time", "choice", *FIGURES)  # the run as a whole
DATASETS = (  # with a row for each time
    *("time", "position", "velocity", "attitude", "spin", "potential_energy"),
    *("energy", "linear_momentum", "angular_momentum", "rotation_error"),
)
SOMETIMES = ("max_next_degree_term", "accuracy", "estimated_error")  # None of some runs, and in older files


@dataclass(frozen=True, eq=False)
class Trajectory(Directions, Exports, Between, Value):
    """What `binaryast.propagate` returns.

    ``run[i]`` is a `State`, ``run[a:b]`` a `Trajectory` of those rows; `len` is the number of rows.

    Attributes
    ----------
    time : Quantity
        Since the start (N,) [s].
    position, velocity : Quantity
        Of the mass centres, inertial (N, n, 3).
    attitude : ndarray
        Body frame -> inertial (N, n, 3, 3).
    spin : Quantity
        Each in its own body's frame (N, n, 3).
    relative : RelativeState
        X, V, R, Omega, Omega2 of the paper, time first; of a pair.
    energy, potential_energy, translational_energy, rotational_energy : Quantity
        About the barycentre (N,) [J].
    linear_momentum, angular_momentum : Quantity
        (N, 3) [kg m/s], and about the barycentre [kg m2/s].
    work, impulse, angular_impulse : Quantity
        What of the three came from outside since the start; zero without perturbations.
    rotation_error : ndarray
        Frobenius norm ||I - R^T R||, the largest of all attitudes (N,).
    status : str
        ``completed``, ``contact``, ``escape``, ``event``, ``interrupted`` or ``failed``; ``message`` says more.
    steps, step, wall_time : int, Quantity, Quantity
        Steps taken; the step used, the largest one up to the integrator's that divides ``save_every``, or the run where
        none is given (a last stretch that ``save_every`` leaves has its own, smaller one; of an adaptive integrator,
        their mean); and the time it took.
    max_relative_energy_error, max_energy_error, max_energy_error_over_potential : float, Quantity, float
        Largest |E - E0| over every step, less the work done from outside: over |E0|, itself, and over |U0|. Spin energy
        hides the orbit in the first, and heavy bodies hide light ones in all of them.
    max_relative_angular_momentum_error, max_relative_linear_momentum_error, max_rotation_error : float
        Over every step. Linear momentum is relative to sum m |v|; in the relative frame it is kept by construction,
        and its figure is the round-off of the saved rows.
    closest_approach, closest_approach_time : Quantity
        Smallest distance of any two mass centres, also within steps (unless rows are more than 20 000 steps apart), and
        when.
    max_next_degree_term : float or None
        Largest size, at saved rows, of the next two degrees of U that the gravity of a pair leaves out, over G m1 m2/r.
        It is an estimate of what its cut costs; torques lose more, by (r/size)^2. None of gravity without a cut.
    accuracy, estimated_error, choice : float or None, float or None, str
        Of a run for which an accuracy was asked: that, an estimate of the error at the end (of the position relative to
        the distance, and of the attitudes of all bodies [rad], the largest), None where it ended early, and why the
        integrator was picked.
    impulses : tuple of Impulse and Impact
        By which the motion was changed, in order of time; after an early end there may be some that were not reached.
        Then figures are the largest of all legs, errors of energy and momentum from the start of each leg, and an
        accuracy is that of each leg; ``integrator`` is that of the last.
    legs : tuple of Trajectory
        The rows between impulses; the run itself where there are none.
    watched : tuple of Event
        What was looked for, and the contact that ended the run.
    events : tuple of Occurrence
        What happened, in order of time, with the states there; ``occurrences`` are its arrays.
    integrator, system, epoch, frame, provenance
        What was run, and on what.
    si : TrajectoryFloats
        The arrays as plain floats.
    """

    system: System
    integrator: Integrator
    si: TrajectoryFloats = field(repr=False)
    epoch: Time | None
    frame: str
    status: str
    message: str
    steps: int
    step: Quantity
    wall_time: Quantity
    max_relative_energy_error: float
    max_energy_error: Quantity
    max_energy_error_over_potential: float
    max_relative_angular_momentum_error: float
    max_relative_linear_momentum_error: float
    max_rotation_error: float
    closest_approach: Quantity
    closest_approach_time: Quantity
    max_next_degree_term: float | None
    provenance: dict[str, str] = field(repr=False)
    accuracy: float | None = None
    estimated_error: float | None = None
    choice: str = ""
    impulses: tuple[AnyImpulse, ...] = ()
    watched: tuple[Event, ...] = ()
    occurrences: OccurrenceFloats | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        for array in self.si:
            array.flags.writeable = False

    @overload
    def __getitem__(self, index: SupportsIndex) -> State: ...

    @overload
    def __getitem__(self, index: slice) -> "Trajectory": ...

    def __getitem__(self, index: Any) -> "State | Trajectory":
        try:
            if isinstance(index, slice):
                return self._rows(index)
            index = operator.index(index)
        except (TypeError, ValueError):
            raise InputError(f"run[{index!r}]: expected a whole number or a slice of them") from None
        if not -len(self) <= index < len(self):
            raise IndexError(f"run[{index}]: there are {len(self)} rows")
        epoch = None if self.epoch is None else self.epoch + TimeDelta(self.time[index])
        if (error := float(rotation_errors(self.si.attitude[index]).max())) > ROTATION_TOLERANCE:
            warnings.warn(
                f"run[{index}]: its attitudes are no rotations, ||I - R^T R|| is {error:.3g}, and the nearest ones are "
                f"taken: give {type(self.integrator).__name__} tighter tolerances, or use ba.LGVI",
                StepWarning,
                stacklevel=2,
            )
        attitude = self.si.attitude[index]
        attitude = nearest_rotations(attitude) if error > ROUND_OFF else attitude
        return State(self.position[index], self.velocity[index], attitude, self.spin[index], epoch, self.frame)

    @cached_property
    def events(self) -> tuple[Occurrence, ...]:
        """What happened, in order of time."""
        if self.occurrences is None:
            return ()
        return tuple(self._occurrence(*one) for one in zip(*self.occurrences, strict=True))

    def _occurrence(self, event: Any, time: Any, direction: Any, *motion: Any) -> Occurrence:
        """Return one of them, with units."""
        position, velocity, attitude, spin = motion
        when = quantity(float(time), "s")
        state = State(
            quantity(position, "m"),
            quantity(velocity, "m / s"),
            rotations_of(attitude),
            quantity(spin, "rad / s"),
            None if self.epoch is None else self.epoch + TimeDelta(when),
            self.frame,
        )
        return Occurrence(self.watched[int(event)], when, int(direction), state)

    @property
    def time(self) -> Quantity:
        """Since the start (N,)."""
        return quantity(self.si.time, "s")

    @property
    def position(self) -> Quantity:
        """Of the mass centres, inertial (N, n, 3)."""
        return quantity(self.si.position, "m")

    @property
    def velocity(self) -> Quantity:
        """Of the mass centres, inertial (N, n, 3)."""
        return quantity(self.si.velocity, "m / s")

    @property
    def attitude(self) -> Floats:
        """Body frame -> inertial (N, n, 3, 3)."""
        return self.si.attitude

    @property
    def spin(self) -> Quantity:
        """Each in its own body's frame (N, n, 3)."""
        return quantity(self.si.spin, "rad / s")

    @cached_property
    def relative(self) -> RelativeState:
        """The paper's reduced variables (34)-(39) of a pair, time first."""
        self._only_pair("relative")
        position, velocity, _, spin = self.si[1:5]
        return RelativeState.from_arrays(position, velocity, self.rotations, spin, epoch=self.epoch, frame=self.frame)

    @property
    def separation(self) -> Quantity:
        """Distance of the mass centres of a pair (N,)."""
        self._only_pair("separation")
        return self.distance(0, 1)

    def distance(self, one: str | int, two: str | int) -> Quantity:
        """Return the distance of the mass centres of two bodies, given by names or indices (N,)."""
        i, j = self.system.index(one), self.system.index(two)
        return quantity(np.linalg.norm(self.si.position[:, j] - self.si.position[:, i], axis=-1), "m")

    def _only_pair(self, what: str) -> None:
        """Raise where there are several bodies."""
        if len(self.system.bodies) > 2:
            raise InputError(
                f"{what}: of a pair; this run has {len(self.system.bodies)} bodies: see run.distance and run.position"
            )

    def check(
        self, *, energy: float | None = None, momentum: float | None = None, rotation: float | None = None
    ) -> "Trajectory":
        """Raise where an error is larger than the figure given; return the run itself otherwise.

        Parameters
        ----------
        energy : float
            For `max_relative_energy_error`.
        momentum : float
            For `max_relative_angular_momentum_error` and `max_relative_linear_momentum_error`.
        rotation : float
            For `max_rotation_error`.

        Raises
        ------
        CheckError
            Naming the figure; also where the run did not complete.
        """
        if self.status != "completed":
            raise CheckError(f"the run did not complete: {self.status}: {self.message}")
        for name, bound in (
            ("max_relative_energy_error", energy),
            ("max_relative_angular_momentum_error", momentum),
            ("max_relative_linear_momentum_error", momentum),
            ("max_rotation_error", rotation),
        ):
            figure = getattr(self, name)
            if bound is None:
                continue
            if figure > float(numbers(bound, "check", ())):
                raise CheckError(f"{name} is {figure:.4g}, expected at most {bound:g}: try a smaller step")
        return self

    def summary(self) -> str:
        """Return a few lines: how the run ended, its cost, and how well it conserved what it should."""
        return summaries.summary(self)

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        return markup.run(self)

    def write(self, path: str | Path, *, force: bool = False) -> Path:
        """Write the run to an HDF5 file, whole or not at all.

        Parameters
        ----------
        path : path
            The file; its folder must be there.
        force : bool
            Whether a file of that name may be replaced.

        Returns
        -------
        Path
            Where it is.

        Raises
        ------
        StorageError
            Where the file exists and ``force`` is not set, or it cannot be written.
        """
        pieces = (self._rows(slice(*piece)).datasets() for piece in pieces_of(len(self)))
        return storage.write(storage.as_path(path), self.content(), len(self), pieces, force=force)

    def datasets(self) -> dict[str, Any]:
        """Return what a file has a row of for each time, by name."""
        return {name: getattr(self, name) for name in (*DATASETS, *(GIVEN if self.system.perturbations else ()))}

    def attributes(self) -> dict[str, Any]:
        """Return what is said of the run as a whole, in SI, by name."""
        figures = {name: getattr(self, name) for name in ABOUT}
        return {name: getattr(figure, "value", figure) for name, figure in figures.items() if figure is not None}

    def content(self) -> storage.Content:
        """Return what a file holds beside `datasets`."""
        values = {"system": self.system, "integrator": self.integrator, "epoch": self.epoch}
        values |= {"impulses": self.impulses} if self.impulses else {}
        datasets: dict[str, Any] = {}
        if self.watched and self.occurrences is not None:
            values["watched"] = self.watched
            datasets = self.occurrences.datasets()
        return storage.Content(datasets, self.attributes(), values, self.provenance)

    @classmethod
    def read(cls, path: str | Path, *, verify: bool = True) -> "Trajectory":
        """Read a run from an HDF5 file.

        Parameters
        ----------
        path : path
            The file.
        verify : bool
            Whether to refuse a file that is not, byte for byte, what was written.

        Returns
        -------
        Trajectory

        Raises
        ------
        StorageError
            Where the file is missing, broken, or not one of ours.
        """
        path = storage.as_path(path)
        content = run_file.with_rows(path, storage.read(path, verify=verify), verify=verify)
        try:
            return cls.of_content(content)
        except KeyError as error:
            raise storage.broken(path, f"{error.args[0]} is missing") from None
        except Exception as error:  # a file that was changed can hold anything
            raise storage.broken(path, brief(error)) from None

    @classmethod
    def of_content(cls, content: storage.Content) -> "Trajectory":
        """Return the run that the content of a file tells of; it raises whatever comes to what is none."""
        attributes: dict[str, Any] = dict.fromkeys(SOMETIMES) | {"choice": ""} | content.attributes
        return cls(
            system=content.values["system"],
            integrator=content.values["integrator"],
            si=floats_of(content.datasets, len(content.values["system"].bodies)),
            epoch=content.values.get("epoch"),
            frame=str(attributes["frame"]),
            status=str(attributes["status"]),
            message=str(attributes["message"]),
            steps=int(attributes["steps"]),
            step=quantity(float(attributes["step"]), "s"),
            wall_time=quantity(float(attributes["wall_time"]), "s"),
            provenance=content.provenance,
            choice=str(attributes["choice"]),
            impulses=content.values.get("impulses", ()),
            watched=content.values.get("watched", ()),
            occurrences=OccurrenceFloats.of_datasets(content.datasets, len(content.values["system"].bodies)),
            **{name: quantity(attributes[name], unit) if unit else attributes[name] for name, unit in FIGURES.items()},
        )
