"""The rows of a run as plain arrays."""

from dataclasses import replace
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, Self

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.rotations import ROTATION_TOLERANCE
from binaryast.run_file import pieces_of
from binaryast.system import System
from binaryast.units import Floats, checked
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


class Rows:
    """The rows of a run.

    Attributes
    ----------
    system : System
        Whose they are.
    si : TrajectoryFloats
        The arrays as plain floats.
    """

    system: System
    si: TrajectoryFloats

    def __len__(self) -> int:
        return len(self.si.time)

    @cached_property
    def rotations(self) -> Floats:
        """The attitudes, or the rotations nearest to them where they are none (N, n, 3, 3)."""
        return rotations_of(self.si.attitude)

    def with_rows(self, si: TrajectoryFloats) -> Self:
        """Return the run with other rows; its figures remain."""
        return replace(self, si=si)  # type: ignore[type-var]

    def _rows(self, index: slice) -> Self:
        """Return some of the rows; the figures remain those of the whole run."""
        if index.step is not None and index.step <= 0:
            raise ValueError
        if not len(self.si.time[index]):
            raise IndexError(f"run[{index.start}:{index.stop}] has no rows: there are {len(self)}")
        return self.with_rows(TrajectoryFloats(*(array[index] for array in self.si)))

    @property
    def legs(self) -> tuple[Self, ...]:
        """The rows between impulses, where the same time comes twice; their figures remain those of the whole run."""
        begins = [0, *(np.flatnonzero(np.diff(self.si.time) == 0) + 1).tolist(), len(self)]
        return tuple(self._rows(slice(begin, end)) for begin, end in pairwise(begins))


def rotations_of(r: Floats) -> Floats:
    """Return attitudes (.., 3, 3) as they are, or the rotations nearest to them where one of them is none."""
    return nearest_rotations(r) if np.any(rotation_errors(r) > ROTATION_TOLERANCE) else r


def nearest_rotations(r: Floats) -> Floats:
    """Return the rotations nearest to matrices (..., 3, 3)."""
    matrices = r.reshape(-1, 3, 3).copy()  # SciPy below 1.15 takes no read-only array
    return np.asarray(Rotation.from_matrix(matrices).as_matrix().reshape(r.shape))


def rotation_errors(r: Floats) -> Floats:
    """Return ||I - R^T R|| of matrices (..., 3, 3)."""
    return np.asarray(np.linalg.norm(np.eye(3) - np.swapaxes(r, -1, -2) @ r, axis=(-2, -1)))


def floats_of(datasets: dict[str, Any], count: int) -> TrajectoryFloats:
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
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            checked(arrays[name], name, shape)
        for begin, end in pieces_of(rows):
            checked(arrays[name][begin:end], name, (end - begin, *shape[1:]))
    return TrajectoryFloats(**arrays)
