"""What is read off a trajectory: the mutual period, the libration of the secondary."""

from typing import TypeAlias

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief, quantity

Bodies: TypeAlias = tuple[str | int, str | int] | None


def orbit_angle(run: Trajectory, bodies: Bodies = None) -> Quantity:
    """Return the angle that the secondary has gone round the primary since the start, in the mean orbit plane.

    Parameters
    ----------
    run : Trajectory
        With a row at least every half turn.
    bodies : tuple of two, optional
        Primary and secondary, by names or indices; needed where there are more than two bodies.

    Returns
    -------
    Quantity
        (N,) [rad], growing.

    Raises
    ------
    InputError
        For a run of fewer than two rows, or rows half a turn or more apart.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("patroclus")
    >>> run = ba.propagate(system, state, duration=4.283 * u.day, integrator=ba.LGVI(1 * u.min))
    >>> print(ba.analysis.orbit_angle(run)[-1].to("deg").round(2))
    360.0 deg
    """
    x, v = _relative(run, bodies)
    _often_enough(run, _orbit_rate(x, v), np.pi)
    first, second, _ = mean_orbit_axes(run, bodies)
    angle = np.unwrap(np.arctan2(x @ second, x @ first))
    return quantity(angle - angle[0], "rad")


def mean_orbit_axes(run: Trajectory, bodies: Bodies = None) -> Floats:
    """Return inertial unit vectors (3, 3): two in the mean orbit plane, the first along the start, and its pole.

    Where the pair moves on a line, the plane is one through it.
    """
    x, v = _relative(run, bodies)
    if len(x) < 2:
        raise InputError(f"the run has one row only: expected at least 2, got {len(x)}")
    pole = np.cross(x, v).mean(axis=0)
    if not np.linalg.norm(pole) > 1e-12 * np.abs(x).max() * np.abs(v).max():  # on a line: any plane through it
        pole = np.cross(x[0], np.eye(3)[np.argmin(np.abs(x[0]))])
    pole = pole / np.linalg.norm(pole)
    first = x[0] - (x[0] @ pole) * pole
    first /= np.linalg.norm(first)
    return np.array([first, np.cross(pole, first), pole])


def mutual_period(run: Trajectory, bodies: Bodies = None) -> Quantity:
    """Return the mean sidereal period of the mutual orbit.

    It is the slope of a straight line through the angle, so oscillations within an orbit average out. Of a run with
    impulses, which change it, ask for that of each of ``run.legs``.

    Parameters
    ----------
    run : Trajectory
        Over at least one turn, with at least four rows a turn.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    Quantity
        [h]

    Raises
    ------
    InputError
        For less than one turn, or too few rows.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=20 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> print(ba.analysis.mutual_period(run).round(2))
    11.92 h
    """
    angle = orbit_angle(run, bodies).value
    turns = angle[-1] / (2 * np.pi)
    if turns < 1:
        raise InputError(f"mutual_period: the run covers {turns:.3g} turns: expected at least one")
    _often_enough(run, _orbit_rate(*_relative(run, bodies)), np.pi / 2)
    slope = float(np.polyfit(run.si.time, angle, 1)[0])
    return quantity(2 * np.pi / slope, "s").to("h")


def libration_angle(run: Trajectory, bodies: Bodies = None) -> Quantity:
    """Return the angle from the line of centres to the secondary's x axis, in the orbit plane of each moment.

    It starts near zero for a synchronous secondary, oscillates while that librates, and grows when it turns freely.

    Parameters
    ----------
    run : Trajectory
        With a row at least every half turn of the secondary against the line of centres.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    Quantity
        (N,) [rad], without jumps.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=2 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> bool(abs(ba.analysis.libration_angle(run)).max().to_value("deg") < 1)
    True
    """
    x, v = _relative(run, bodies)
    _, secondary = _pair(run, bodies)
    if run.system.bodies[secondary].is_point:
        raise InputError(f"libration_angle: {run.system.names[secondary]} is a point, which has no axes")
    along = x / np.linalg.norm(x, axis=1, keepdims=True)
    pole = np.cross(x, v)
    length = np.linalg.norm(pole, axis=1, keepdims=True)
    if not np.all(length > 0):
        raise InputError("the pair moves on a line: there is no orbit plane")
    _often_enough(run, _orbit_rate(x, v) + np.linalg.norm(run.si.spin[:, secondary], axis=1), 2 * np.pi)
    across = np.cross(pole / length, along)
    axis = run.si.attitude[:, secondary, :, 0]
    return quantity(np.unwrap(np.arctan2(np.sum(axis * across, axis=1), np.sum(axis * along, axis=1))), "rad")


def _orbit_rate(x: Floats, v: Floats) -> Floats:
    """Return the rate (N,) at which the line of centres turns [rad/s]."""
    return np.asarray(np.linalg.norm(np.cross(x, v), axis=1) / np.sum(x * x, axis=1))


def _often_enough(run: Trajectory, rate: Floats, most: float) -> None:
    """Raise where something that turns at a rate may go round further than ``most`` [rad] between two rows."""
    turn = float((np.maximum(rate[1:], rate[:-1]) * np.abs(np.diff(run.si.time))).max(initial=0.0))
    if turn > most:
        raise InputError(
            f"rows are too far apart to follow the motion, {turn:.3g} rad of turn, expected at most {most:.3g}: "
            "save more often"
        )


def _pair(run: Trajectory, bodies: Bodies) -> tuple[int, int]:
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


def _relative(run: Trajectory, bodies: Bodies) -> tuple[Floats, Floats]:
    """Return position and velocity of the secondary relative to the primary, inertial."""
    i, j = _pair(run, bodies)
    return run.si.position[:, j] - run.si.position[:, i], run.si.velocity[:, j] - run.si.velocity[:, i]
