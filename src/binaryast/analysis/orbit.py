"""The mutual orbit as a whole: how far it has gone, its mean plane and period."""

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.pairs import Bodies, often_enough, orbit_rate, relative_motion
from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, quantity


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
    x, v = relative_motion(run, bodies)
    often_enough(run, orbit_rate(x, v), np.pi)
    first, second, _ = mean_orbit_axes(run, bodies)
    angle = np.unwrap(np.arctan2(x @ second, x @ first))
    return quantity(angle - angle[0], "rad")


def mean_orbit_axes(run: Trajectory, bodies: Bodies = None) -> Floats:
    """Return inertial unit vectors (3, 3): two in the mean orbit plane, the first along the start, and its pole.

    Where the pair moves on a line, the plane is one through it.
    """
    x, v = relative_motion(run, bodies)
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
    often_enough(run, orbit_rate(*relative_motion(run, bodies)), np.pi / 2)
    slope = float(np.polyfit(run.si.time, angle, 1)[0])
    return quantity(2 * np.pi / slope, "s").to("h")
