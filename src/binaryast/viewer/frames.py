"""Where bodies are at each row, as the page's script reads it: single precision, about the barycentre."""

from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast import analysis
from binaryast.errors import InputError
from binaryast.perturbations import Sun
from binaryast.perturbations.base import Span
from binaryast.rows import rotations_of
from binaryast.trajectory import Trajectory
from binaryast.units import Floats
from binaryast.viewer.packing import packed

LARGEST = 6_000_000  # bytes of motion, before they become text
FEWEST_TURNS = 20.0  # without an orbit's period, the run takes so many times what stands for one


def chosen_rows(run: Trajectory, most: int) -> Any:
    """Return indices of rows, evenly chosen where there are more than ``most`` or than the page can hold."""
    each = 24 * len(run.system.bodies) + 28 * len(turning(run))
    count = min(len(run), most, max(2, LARGEST // each))
    return np.unique(np.linspace(0, len(run) - 1, count).round().astype(int))


def turning(run: Trajectory) -> list[int]:
    """Return the indices of the bodies that have an attitude."""
    return [i for i, body in enumerate(run.system.bodies) if not body.is_point]


def about_barycentre(run: Trajectory, rows: Any = slice(None)) -> tuple[Floats, Floats]:
    """Return positions and velocities (N, n, 3) relative to the barycentre."""
    masses = np.array([body.si.mass * body.pulls for body in run.system.bodies])
    shares = masses / masses.sum()
    both = (run.si.position[rows], run.si.velocity[rows])
    position, velocity = (x - np.einsum("i,nij->nj", shares, x)[:, None] for x in both)
    return position, velocity


def period(run: Trajectory) -> float:
    """Return what a turn takes [s]: that of the fastest orbit, or a part of the run where there is none."""
    periods = []
    for i in range(1, min(len(run.system.bodies), 20)):
        try:
            periods.append(float(analysis.mutual_period(run.legs[-1], (0, i)).to_value("s")))
        except InputError:  # less than one turn, or too few rows to count turns
            continue
    length = float(run.si.time[-1] - run.si.time[0])
    return min(periods) if periods else length / FEWEST_TURNS or 1.0


def pole(run: Trajectory) -> Floats:
    """Return the direction of the orbits' angular momentum at the start, inertial; z where there is none."""
    masses = np.array([body.si.mass for body in run.system.bodies])
    position, velocity = about_barycentre(run, slice(1))
    momentum = masses @ np.cross(position[0], velocity[0])
    size = float(masses @ (np.linalg.norm(position[0], axis=1) * np.linalg.norm(velocity[0], axis=1)))
    length = float(np.linalg.norm(momentum))
    return np.asarray(momentum / length if length > 1e-9 * size else [0.0, 0.0, 1.0])


def motion(run: Trajectory, rows: Any, unit: float) -> dict[str, Any]:
    """Return times [s], places and velocities over ``unit`` [m] (N, n, 3), quaternions and spins (N, k, 4 and 3).

    Quaternions are scalar last, body frame -> inertial, of the bodies that turn; spins are in the body frame [rad/s].
    """
    position, velocity = about_barycentre(run, rows)
    bodies = turning(run)
    attitude = rotations_of(run.si.attitude[rows][:, bodies])
    quaternion = Rotation.from_matrix(attitude.reshape(-1, 3, 3).copy()).as_quat() if bodies else np.zeros(0)
    return {
        "time": packed(run.si.time[rows], np.float64),
        "position": packed(position / unit, np.float32),
        "velocity": packed(velocity / unit, np.float32),
        "turning": bodies,
        "quaternion": packed(quaternion, np.float32),
        "spin": packed(run.si.spin[rows][:, bodies], np.float32),
    }


def sunlight(run: Trajectory, times: Floats) -> Floats | None:
    """Return the directions to the Sun (N, 3), inertial, at times [s] of a run that it acts on; None of others."""
    suns = [one for one in run.system.perturbations if isinstance(one, Sun)]
    if not suns:
        return None
    from binaryast.kernels.external.paths import place_at

    span = Span(float(times[0]), float(times[-1]), run.epoch, run.frame)
    path = suns[0].path(run.system.bodies, span)
    places: Floats = np.array([place_at(path, 0, float(t))[0] for t in times])
    return np.asarray(places / np.linalg.norm(places, axis=1, keepdims=True))
