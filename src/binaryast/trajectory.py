"""The result of a propagation: arrays with time first, what should be conserved and how well, and how it ended."""

import operator
import warnings
from dataclasses import dataclass, field, replace
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal, NamedTuple, SupportsIndex, overload

import numpy as np
from astropy.time import Time, TimeDelta
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast import dense, markup, storage, summaries
from binaryast.directions import Directions
from binaryast.errors import CheckError, InputError, InterpolationWarning, StepWarning
from binaryast.events import Event
from binaryast.exports import Exports
from binaryast.impulses import AnyImpulse
from binaryast.integrators import Integrator
from binaryast.occurrences import Occurrence, OccurrenceFloats
from binaryast.rotations import ROTATION_TOLERANCE
from binaryast.state import RelativeState, State
from binaryast.system import System
from binaryast.units import Floats, as_quantity, brief, checked, numbers, quantity, span, to_si
from binaryast.values import Value
from binaryast.working.base import nothing_given


class TrajectoryFloats(NamedTuple):
    """The arrays of a trajectory as plain SI floats; the last three are what came from outside since the start."""

    time: Floats
    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats
    potential_energy: Floats
    work: Floats
    impulse: Floats
    angular_impulse: Floats


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
DOUBTFUL_INTERPOLATION = 1e-5
OCCURRENCE_UNITS = dict(zip(OccurrenceFloats._fields, ("", "s", "", "m", "m / s", "", "rad / s"), strict=True))
SOMETIMES = ("max_next_degree_term", "accuracy", "estimated_error")  # None of some runs, and in older files


@dataclass(frozen=True, eq=False)
class Trajectory(Directions, Exports, Value):
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

    def __len__(self) -> int:
        return len(self.si.time)

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
        if (error := float(_rotation_errors(self.si.attitude[index]).max())) > ROTATION_TOLERANCE:
            warnings.warn(
                f"run[{index}]: its attitudes are no rotations, ||I - R^T R|| is {error:.3g}, and the nearest ones are "
                f"taken: give {type(self.integrator).__name__} tighter tolerances, or use ba.LGVI",
                StepWarning,
                stacklevel=2,
            )
        attitude = self._rotations[index]
        return State(self.position[index], self.velocity[index], attitude, self.spin[index], epoch, self.frame)

    @cached_property
    def _rotations(self) -> Floats:
        """The attitudes, or the rotations nearest to them where they are none (N, n, 3, 3)."""
        return nearest_rotations(self.si.attitude)

    def _rows(self, index: slice) -> "Trajectory":
        """Return some of the rows; the figures remain those of the whole run."""
        if index.step is not None and index.step <= 0:
            raise ValueError
        if not len(self.si.time[index]):
            raise IndexError(f"run[{index.start}:{index.stop}] has no rows: there are {len(self)}")
        return replace(self, si=TrajectoryFloats(*(array[index] for array in self.si)))

    @property
    def legs(self) -> "tuple[Trajectory, ...]":
        """The rows between impulses, where the same time comes twice; their figures remain those of the whole run."""
        begins = [0, *(np.flatnonzero(np.diff(self.si.time) == 0) + 1).tolist(), len(self)]
        return tuple(self._rows(slice(begin, end)) for begin, end in pairwise(begins))

    def at(self, time: Quantity, *, side: Literal["before", "after"] = "after") -> "State | Trajectory":
        """Return where everything is between the saved rows, by interpolation.

        Through the four rows about a moment goes a polynomial of degree 7 in positions, and one in the rotation vectors
        that lead from a uniform turn to the attitudes, so that these remain rotations (``dense.py``). The error falls
        with the eighth power of the distance of the rows, that of velocities and spins with the seventh; at a row it is
        none. Of a method of order 2 the velocities are the rates of the positions only to its own error, which is in it
        too. `interpolation_error` says how large it is. Where that is not enough, save more often, or ask
        `binaryast.retrace`, which follows the motion again from the row before.

        Parameters
        ----------
        time : Quantity
            Since the start: one time, or an array (M,) of them that grow.
        side : {"after", "before"}
            Of an impulse at this very time.

        Returns
        -------
        State or Trajectory
            A state of one time; of several a trajectory, whose figures remain those of the whole run. Its potential
            energy is what the total energy, which is interpolated, leaves.

        Raises
        ------
        InputError
            For a time outside of the run, times that do not grow, or a run of one row.

        Warns
        -----
        InterpolationWarning
            Where the estimated error is above 1e-5, of the distance from the primary, or in rad.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, state = ba.catalogue.load("didymos")
        >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
        >>> run.at(12345.6 * u.s).separation.round(3)
        <Quantity 1184.266 m>
        >>> len(run.at([1, 2, 3] * u.h))
        3
        """
        times, single = self.checked_times(time, side)
        rows = self._between(times, side)
        error = self._error_at(times)
        if error > DOUBTFUL_INTERPOLATION:
            warnings.warn(
                f"run.at: rows are too far apart for more than an accuracy of {error:.1g} there, as estimated: "
                "save more often, or take ba.retrace(run, time)",
                InterpolationWarning,
                stacklevel=2,
            )
        result = replace(self, si=rows)
        return result[0] if single else result

    def checked_times(self, time: Quantity, side: str) -> tuple[Floats, bool]:
        """Return times within the run [s], and whether it is a single one; round-off may put them outside.

        Raises
        ------
        InputError
            As for `at`.
        """
        if side not in ("before", "after"):
            raise InputError(f"side: expected 'before' or 'after' an impulse, got {brief(repr(side))}")
        shape = as_quantity(time, "s", "time").shape
        times = np.atleast_1d(to_si(time, "s", "time", shape=shape if len(shape) == 1 else ()))
        first, last = self.si.time[[0, -1]]
        if len(times) == 0 or np.any(np.diff(times) <= 0):
            raise InputError(f"time: expected times that grow, got {brief(times)} s")
        if len(self) < 2 and np.any(times != first):
            raise InputError("time: the run has one row only: expected at least 2")
        within = np.clip(times, first, last)
        for wrong in times[np.abs(times - within) > 1e-14 * last]:
            raise InputError(
                f"time: {span(wrong)} is outside of the run, whose rows are from {span(first)} to {span(last)}"
            )
        return np.asarray(within), not shape

    def _between(self, times: Floats, side: str) -> TrajectoryFloats:
        """Return rows at times, each interpolated in the leg in which it lies."""
        legs = self.legs
        begins = np.array([leg.si.time[0] for leg in legs[1:]])
        of_leg = np.searchsorted(begins, times, side="right" if side == "after" else "left")
        parts = []
        for k, leg in enumerate(legs):
            chosen = times[of_leg == k]
            if len(chosen):
                parts.append(leg.interpolated(chosen) if len(leg) > 1 else leg.si)
        return TrajectoryFloats(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))

    def interpolated(self, times: Floats) -> TrajectoryFloats:
        """Return rows at times [s] within this leg, which has two rows or more, by the interpolant of `at`."""
        found = dense.between(self._dense_rows, times)
        given = [
            _linear(times, self.si.time, array) for array in (self.si.work, self.si.impulse, self.si.angular_impulse)
        ]
        result = replace(self, si=TrajectoryFloats(*found, np.zeros(len(times)), *given))
        energy = np.interp(times, self.si.time, self.energy.value)
        known = np.isin(times, self.si.time)
        potential = energy - result.energy.value
        potential[known] = self.si.potential_energy[np.searchsorted(self.si.time, times[known])]
        return TrajectoryFloats(*found, potential, *given)

    @property
    def _dense_rows(self) -> dense.Rows:
        position, velocity, _, spin = self.si[1:5]
        return dense.Rows(self.si.time, position, velocity, self._rotations, spin)

    @cached_property
    def interpolation_error(self) -> Floats:
        """The estimated error of `at` in each interval between rows (N - 1,).

        It is that of positions, relative to the distance from the primary, and of attitudes [rad], the largest of all
        bodies; infinite where there are too few rows to tell, zero between the rows before and after an impulse.
        """
        parts: list[Floats] = []
        for leg in self.legs:
            parts += [dense.errors(leg._dense_rows), np.zeros(1)]
        return np.concatenate(parts[:-1])

    def _error_at(self, times: Floats) -> float:
        """Return the largest estimated error at times; none at rows."""
        times = times[~np.isin(times, self.si.time)]
        intervals = np.searchsorted(self.si.time, times, side="right") - 1
        return float(self.interpolation_error[intervals].max(initial=0.0))

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
            nearest_rotations(attitude),
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
        return RelativeState.from_arrays(position, velocity, self._rotations, spin, epoch=self.epoch, frame=self.frame)

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

    @property
    def potential_energy(self) -> Quantity:
        """U (N,)."""
        return quantity(self.si.potential_energy, "J")

    @property
    def translational_energy(self) -> Quantity:
        """Kinetic energy of the mass centres about the barycentre (N,)."""
        _, velocity = self._about_barycentre
        return quantity(0.5 * np.sum(velocity**2, axis=-1) @ self._masses, "J")

    @cached_property
    def _about_barycentre(self) -> tuple[Floats, Floats]:
        """Positions and velocities (N, n, 3) relative to the barycentre."""
        masses = self._masses / self._masses.sum()
        position, velocity = self.si.position, self.si.velocity
        if len(masses) == 2:  # by the difference, which keeps digits where the barycentre is far or fast
            factors = np.array([[-masses[1]], [masses[0]]])
            return factors * np.diff(position, axis=1), factors * np.diff(velocity, axis=1)
        return (
            position - np.einsum("i,nij->nj", masses, position)[:, None],
            velocity - np.einsum("i,nij->nj", masses, velocity)[:, None],
        )

    @property
    def _masses(self) -> Floats:
        return np.array([body.si.mass * body.pulls for body in self.system.bodies])

    @property
    def _moments(self) -> Floats:
        return np.array([body.si.moments * body.pulls for body in self.system.bodies])

    @property
    def rotational_energy(self) -> Quantity:
        """Of all bodies together (N,)."""
        return quantity(0.5 * np.sum(self._moments * self.si.spin**2, axis=(-2, -1)), "J")

    @property
    def energy(self) -> Quantity:
        """Total energy about the barycentre (N,)."""
        return self.translational_energy + self.rotational_energy + self.potential_energy

    @property
    def energy_of_orbit(self) -> Quantity:
        """Translational and potential energy (N,): below zero a pair is bound, but for what its spins can give."""
        return self.translational_energy + self.potential_energy

    @property
    def linear_momentum(self) -> Quantity:
        """The paper's gamma_T (N, 3)."""
        return quantity(np.einsum("i,nij->nj", self._masses, self.si.velocity), "kg m / s")

    @property
    def angular_momentum(self) -> Quantity:
        """The paper's pi_T, about the barycentre, inertial (N, 3)."""
        spins = np.einsum("nbij,nbj->ni", self.si.attitude, self._moments * self.si.spin)
        orbits = np.einsum("i,nij->nj", self._masses, np.cross(*self._about_barycentre))
        return quantity(orbits + spins, "kg m2 / s")

    @property
    def work(self) -> Quantity:
        """Done from outside since the start (N,): by forces, and by potentials that change with time.

        The energy less this work is what a run should keep. It is counted about the barycentre, as the energy is.
        """
        return quantity(self.si.work, "J")

    @property
    def impulse(self) -> Quantity:
        """Linear momentum that came from outside since the start (N, 3)."""
        return quantity(self.si.impulse, "kg m / s")

    @property
    def angular_impulse(self) -> Quantity:
        """Angular momentum about the barycentre that came from outside since the start (N, 3)."""
        return quantity(self.si.angular_impulse, "kg m2 / s")

    @property
    def rotation_error(self) -> Floats:
        """||I - R^T R||, the largest of all attitudes (N,)."""
        return np.asarray(_rotation_errors(self.si.attitude).max(axis=1))

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
        datasets = {
            "time": self.time,
            "position": self.position,
            "velocity": self.velocity,
            "attitude": self.attitude,
            "spin": self.spin,
            "potential_energy": self.potential_energy,
            "energy": self.energy,
            "linear_momentum": self.linear_momentum,
            "angular_momentum": self.angular_momentum,
            "rotation_error": self.rotation_error,
        }
        if self.system.perturbations:
            datasets |= {"work": self.work, "impulse": self.impulse, "angular_impulse": self.angular_impulse}
        attributes = {
            "status": self.status,
            "message": self.message,
            "steps": self.steps,
            "step": self.step.value,
            "frame": self.frame,
            "wall_time": self.wall_time.value,
            "choice": self.choice,
        }
        figures = {name: getattr(self, name) for name in FIGURES}
        attributes |= {name: getattr(figure, "value", figure) for name, figure in figures.items() if figure is not None}
        values = {"system": self.system, "integrator": self.integrator, "epoch": self.epoch}
        values |= {"impulses": self.impulses} if self.impulses else {}
        if self.watched and self.occurrences is not None:
            values["watched"] = self.watched
            datasets |= {
                f"events_{name}": quantity(array, unit) if unit else array
                for (name, unit), array in zip(OCCURRENCE_UNITS.items(), self.occurrences, strict=True)
            }
        return storage.write(
            storage.as_path(path), storage.Content(datasets, attributes, values, self.provenance), force=force
        )

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
        content = storage.read(path, verify=verify)
        attributes: dict[str, Any] = dict.fromkeys(SOMETIMES) | {"choice": ""} | content.attributes
        try:
            return cls(
                system=content.values["system"],
                integrator=content.values["integrator"],
                si=_floats(content.datasets, len(content.values["system"].bodies)),
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
                occurrences=_occurrences(content.datasets, content.values),
                **{
                    name: quantity(attributes[name], unit) if unit else attributes[name]
                    for name, unit in FIGURES.items()
                },
            )
        except KeyError as error:
            raise storage.broken(path, f"{error.args[0]} is missing") from None
        except Exception as error:  # a file that was changed can hold anything
            raise storage.broken(path, brief(error)) from None


def nearest_rotations(r: Floats) -> Floats:
    """Return attitudes (.., 3, 3) as they are, or the rotations nearest to them where they are none."""
    if not np.any(_rotation_errors(r) > ROTATION_TOLERANCE):
        return r
    matrices = r.reshape(-1, 3, 3).copy()  # SciPy below 1.15 takes no read-only array
    return np.asarray(Rotation.from_matrix(matrices).as_matrix().reshape(r.shape))


def _linear(times: Floats, of_rows: Floats, values: Floats) -> Floats:
    """Return values (N, ...) of rows at times between these."""
    columns = values.reshape(len(values), -1).T
    return np.stack([np.interp(times, of_rows, column) for column in columns], axis=-1).reshape(-1, *values.shape[1:])


def _rotation_errors(r: Floats) -> Floats:
    """Return ||I - R^T R|| of matrices (..., 3, 3)."""
    return np.asarray(np.linalg.norm(np.eye(3) - np.swapaxes(r, -1, -2) @ r, axis=(-2, -1)))


def _floats(datasets: dict[str, Any], count: int) -> TrajectoryFloats:
    """Return the arrays of a file, after a look at their shapes and values."""
    rows = len(datasets["time"])
    shapes = {
        "time": (rows,),
        "position": (rows, count, 3),
        "velocity": (rows, count, 3),
        "attitude": (rows, count, 3, 3),
        "spin": (rows, count, 3),
        "potential_energy": (rows,),
        "work": (rows,),
        "impulse": (rows, 3),
        "angular_impulse": (rows, 3),
    }
    datasets = nothing_given(rows) | datasets  # as in the file of a run without perturbations
    arrays = {name: np.asarray(datasets[name], dtype=np.float64) for name in shapes}
    return TrajectoryFloats(*(checked(arrays[name], name, shape) for name, shape in shapes.items()))


def _occurrences(datasets: dict[str, Any], values: dict[str, Any]) -> OccurrenceFloats:
    """Return what happened of a file, nothing where it does not say."""
    count = len(values["system"].bodies)
    if "events_time" not in datasets:
        return OccurrenceFloats.none(count)
    number = len(datasets["events_time"])
    vectors = (number, count, 3)
    shapes = ((number,), (number,), (number,), vectors, vectors, (*vectors, 3), vectors)
    arrays = {name: np.asarray(datasets[f"events_{name}"], dtype=np.float64) for name in OCCURRENCE_UNITS}
    found = (checked(array, name, shape) for (name, array), shape in zip(arrays.items(), shapes, strict=True))
    return OccurrenceFloats(*found)
