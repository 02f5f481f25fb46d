"""What a run should keep, row by row: how far it is from the start, or from the impulse before."""

from typing import NamedTuple

import numpy as np

from binaryast.trajectory import Trajectory
from binaryast.units import Floats


class Kept(NamedTuple):
    """A quantity that should stay as it is.

    Attributes
    ----------
    name, unit : str
    values : ndarray
        Itself (N,), of a vector its size.
    errors : ndarray
        How far it is from what it should be (N,), over ``scale``.
    scale : str
        What the errors are relative to.
    """

    name: str
    unit: str
    values: Floats
    errors: Floats
    scale: str


def kept(run: Trajectory) -> list[Kept]:
    """Return energy, momenta and what makes attitudes rotations; what came from outside is taken off before."""
    masses = np.array([body.si.mass * body.pulls for body in run.system.bodies])
    energy = run.energy.value
    linear, angular = run.linear_momentum.value, run.angular_momentum.value
    moving = float(np.linalg.norm(run.si.velocity[0], axis=-1) @ masses)
    return [
        Kept("energy", "J", energy, _errors(run, energy - run.si.work), "|E0|"),
        Kept("angular momentum", "kg m²/s", _size(angular), _errors(run, angular - run.si.angular_impulse), "its size"),
        Kept("linear momentum", "kg m/s", _size(linear), _errors(run, linear - run.si.impulse, moving), "Σ m|v|"),
        Kept("rotation", "", np.ones(len(run)), run.rotation_error, "‖I - RᵀR‖, as it is"),
    ]


def _size(vectors: Floats) -> Floats:
    return np.asarray(np.linalg.norm(vectors, axis=-1))


def _errors(run: Trajectory, values: Floats, scale: float | None = None) -> Floats:
    """Return the distances (N,) of values (N,) or (N, 3) from the first of each leg, over it or a scale."""
    columns = values.reshape(len(run), -1)
    begins = np.flatnonzero(np.diff(run.si.time, prepend=-np.inf) == 0)
    parts = np.split(columns, begins)
    return np.concatenate([_of_leg(part, scale) for part in parts])


def _of_leg(values: Floats, scale: float | None) -> Floats:
    size = _size(values[0]) if scale is None else scale
    return np.asarray(_size(values - values[0]) / (size if size > 0 else 1.0))
