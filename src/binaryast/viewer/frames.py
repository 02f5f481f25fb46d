"""Where bodies are at each row, as the page's script reads it: single precision, about the barycentre."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.perturbations import Sun
from binaryast.perturbations.base import Span
from binaryast.trajectory import Trajectory, nearest_rotations
from binaryast.units import Floats
from binaryast.viewer.packing import packed

LARGEST = 6_000_000  # bytes of motion, before they become text


def chosen_rows(run: Trajectory, most: int) -> Any:
    """Return indices of rows, evenly chosen where there are more than ``most`` or than the page can hold."""
    each = 24 * len(run.system.bodies) + 28 * len(turning(run))
    count = min(len(run), most, max(2, LARGEST // each))
    return np.unique(np.linspace(0, len(run) - 1, count).round().astype(int))


def turning(run: Trajectory) -> list[int]:
    """Return the indices of the bodies that have an attitude."""
    return [i for i, body in enumerate(run.system.bodies) if not body.is_point]


def motion(run: Trajectory, rows: Any, unit: float) -> dict[str, Any]:
    """Return times [s], places and velocities over ``unit`` [m] (N, n, 3), quaternions and spins (N, k, 4 and 3).

    Quaternions are scalar last, body frame -> inertial, of the bodies that turn; spins are in the body frame [rad/s].
    """
    masses = np.array([body.si.mass * body.pulls for body in run.system.bodies])
    shares = masses / masses.sum()
    position, velocity = run.si.position[rows], run.si.velocity[rows]
    about = position - np.einsum("i,nij->nj", shares, position)[:, None]
    drift = velocity - np.einsum("i,nij->nj", shares, velocity)[:, None]
    bodies = turning(run)
    attitude = nearest_rotations(run.si.attitude[rows][:, bodies])
    quaternion = Rotation.from_matrix(attitude.reshape(-1, 3, 3).copy()).as_quat() if bodies else np.zeros(0)
    return {
        "time": packed(run.si.time[rows], np.float64),
        "position": packed(about / unit, np.float32),
        "velocity": packed(drift / unit, np.float32),
        "turning": bodies,
        "quaternion": packed(quaternion, np.float32),
        "spin": packed(run.si.spin[rows][:, bodies], np.float32),
    }


def sunlight(run: Trajectory, rows: Any) -> str | None:
    """Return the directions to the Sun (N, 3), inertial, of a run that it acts on; None of others."""
    suns = [one for one in run.system.perturbations if isinstance(one, Sun)]
    if not suns:
        return None
    from binaryast.kernels.external.paths import place_at

    times = run.si.time[rows]
    span = Span(float(times[0]), float(times[-1]), run.epoch, run.frame)
    path = suns[0].path(run.system.bodies, span)
    places: Floats = np.array([place_at(path, 0, float(t))[0] for t in times])
    return packed(places / np.linalg.norm(places, axis=1, keepdims=True), np.float32)
