"""How the secondary keeps its face to the primary: its libration, how far it goes, and when it is lost."""

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.pairs import Bodies, often_enough, orbit_frames, orbit_rate, relative_motion, turning
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, quantity


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
    secondary = turning(run, bodies, "libration_angle")
    frames = orbit_frames(run, bodies)
    rate = orbit_rate(*relative_motion(run, bodies))
    often_enough(run, rate + np.linalg.norm(run.si.spin[:, secondary], axis=1), 2 * np.pi)
    along, across, _ = np.einsum("nij,ni->jn", frames, run.si.attitude[:, secondary, :, 0])
    return quantity(np.unwrap(np.arctan2(across, along)), "rad")


def libration_amplitude(run: Trajectory, bodies: Bodies = None) -> Quantity:
    """Return how far the secondary's x axis, either end of it, swings from the line of centres in the orbit plane.

    Parameters
    ----------
    run, bodies
        As for `libration_angle`.

    Returns
    -------
    Quantity
        Largest distance of the libration angle from the middle of its swing, the whole number of half turns that its
        rows lie about [deg]; above 90 deg the secondary is not, or not all the time, synchronous.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> scenario = ba.catalogue.entry("dart")
    >>> run = ba.propagate(
    ...     scenario.system, scenario.state, duration=60 * u.day, accuracy=1e-7, impulses=scenario.impulses)
    >>> before, after = run.legs
    >>> bool(17 < ba.analysis.libration_amplitude(after).to_value("deg") < 18)
    True
    """
    angle = libration_angle(run, bodies).value
    return quantity(np.abs(angle - np.pi * np.round(np.median(angle) / np.pi)).max(), "rad").to("deg")


def loss_of_synchrony(run: Trajectory, bodies: Bodies = None) -> Quantity:
    """Return when the secondary's x axis is for the first time across the line of centres.

    Parameters
    ----------
    run, bodies
        As for `libration_angle`.

    Returns
    -------
    Quantity
        Since the start of the run [d], on a straight line between two rows: when the libration angle has gone 90 deg
        from the half turn that it started nearest to. Infinite where it never does.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=2 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> print(ba.analysis.loss_of_synchrony(run))
    inf d
    """
    angle = libration_angle(run, bodies).value
    return first_time(run.si.time, np.abs(angle - np.pi * np.round(angle[0] / np.pi)), np.pi / 2)


def first_time(time: Floats, values: Floats, bound: float) -> Quantity:
    """Return when values first pass a bound [d], on a straight line between rows; infinite if they never do."""
    above = np.flatnonzero(values > bound)
    if not len(above):
        return quantity(np.inf, "s").to("d")
    k = int(above[0])
    if k == 0:
        return quantity(time[0], "s").to("d")
    share = (bound - values[k - 1]) / (values[k] - values[k - 1])
    return quantity(time[k - 1] + share * (time[k] - time[k - 1]), "s").to("d")
