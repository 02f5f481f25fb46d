"""Where everything is between the rows of a run, by interpolation."""

import warnings
from functools import cached_property
from typing import Any, Literal, Self

import numpy as np
from astropy.units import Quantity

from binaryast import dense
from binaryast.conserved import Conserved
from binaryast.errors import InputError, InterpolationWarning
from binaryast.rows import TrajectoryFloats
from binaryast.state import State
from binaryast.units import Floats, as_quantity, brief, span, to_si

DOUBTFUL_INTERPOLATION = 1e-5


class Between(Conserved):
    """The interpolant of a run, leg by leg."""

    def at(self, time: Quantity, *, side: Literal["before", "after"] = "after") -> State | Self:
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
        result: Any = self.with_rows(rows)
        return result[0] if single else result  # type: ignore[no-any-return]

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
        result = self.with_rows(TrajectoryFloats(*found, np.zeros(len(times)), *given))
        energy = np.interp(times, self.si.time, self.energy.value)
        known = np.isin(times, self.si.time)
        potential = energy - result.energy.value
        potential[known] = self.si.potential_energy[np.searchsorted(self.si.time, times[known])]
        return TrajectoryFloats(*found, potential, *given)

    @property
    def _dense_rows(self) -> dense.Rows:
        position, velocity, _, spin = self.si[1:5]
        return dense.Rows(self.si.time, position, velocity, self.rotations, spin)

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


def _linear(times: Floats, of_rows: Floats, values: Floats) -> Floats:
    """Return values (N, ...) of rows at times between these."""
    columns = values.reshape(len(values), -1).T
    return np.stack([np.interp(times, of_rows, column) for column in columns], axis=-1).reshape(-1, *values.shape[1:])
