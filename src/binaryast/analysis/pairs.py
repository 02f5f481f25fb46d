"""Which two bodies of a run are looked at, how they move about each other, and whether rows lie near enough."""

from typing import TypeAlias

import numpy as np

from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief

Bodies: TypeAlias = tuple[str | int, str | int] | None


def orbit_rate(x: Floats, v: Floats) -> Floats:
    """Return the rate (N,) at which the line of centres turns [rad/s]."""
    return np.asarray(np.linalg.norm(np.cross(x, v), axis=1) / np.sum(x * x, axis=1))


def often_enough(run: Trajectory, rate: Floats, most: float) -> None:
    """Raise where something that turns at a rate may go round further than ``most`` [rad] between two rows."""
    turn = float((np.maximum(rate[1:], rate[:-1]) * np.abs(np.diff(run.si.time))).max(initial=0.0))
    if turn > most:
        raise InputError(
            f"rows are too far apart to follow the motion, {turn:.3g} rad of turn, expected at most {most:.3g}: "
            "save more often"
        )


def pair_of(run: Trajectory, bodies: Bodies) -> tuple[int, int]:
    """Return the indices of primary and secondary."""
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    names = run.system.names
    if bodies is None and len(names) == 2:
        return 0, 1
    if not isinstance(bodies, (tuple, list)) or len(bodies) != 2:
        raise InputError(f"bodies: expected primary and secondary, such as {names[:2]!r}, got {brief(bodies)}")
    primary, secondary = run.system.index(bodies[0]), run.system.index(bodies[1])
    if primary == secondary:
        raise InputError(f"bodies: {names[primary]} twice: expected two bodies, such as {names[:2]!r}")
    return primary, secondary


def relative_motion(run: Trajectory, bodies: Bodies) -> tuple[Floats, Floats]:
    """Return position and velocity of the secondary relative to the primary, inertial."""
    i, j = pair_of(run, bodies)
    return run.si.position[:, j] - run.si.position[:, i], run.si.velocity[:, j] - run.si.velocity[:, i]


def orbit_frames(run: Trajectory, bodies: Bodies) -> Floats:
    """Return the orbit frame of each row (N, 3, 3), orbit frame -> inertial.

    Its columns are the line of centres from primary to secondary, the direction across it in which the secondary moves,
    and the pole of the orbit of that moment.
    """
    x, v = relative_motion(run, bodies)
    pole = np.cross(x, v)
    length = np.linalg.norm(pole, axis=1, keepdims=True)
    if not np.all(length > 0):
        raise InputError("the pair moves on a line: there is no orbit plane")
    along, pole = x / np.linalg.norm(x, axis=1, keepdims=True), pole / length
    return np.stack([along, np.cross(pole, along), pole], axis=-1)


def turning(run: Trajectory, bodies: Bodies, what: str) -> int:
    """Return the index of a secondary that has axes."""
    _, secondary = pair_of(run, bodies)
    if run.system.bodies[secondary].is_point:
        raise InputError(f"{what}: {run.system.names[secondary]} is a point, which has no axes")
    return secondary
