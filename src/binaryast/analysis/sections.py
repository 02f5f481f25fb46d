"""Where a motion crosses something: rows at passages, Poincare sections, and the period that eclipses show."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.orbit import mean_orbit_axes
from binaryast.analysis.pairs import Bodies, often_enough, orbit_frames, orbit_rate, pair_of, relative_motion, turning
from binaryast.errors import InputError, did_you_mean
from binaryast.orbits import pole_axes
from binaryast.rows import TrajectoryFloats
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief, quantity
from binaryast.values import Value

HALVINGS = 50
Crossing = str | Callable[[Trajectory], Any]
NAMED = ("periapsis", "apoapsis", "conjunction")


@dataclass(frozen=True, eq=False)
class PoincareSection(Value):
    """What `poincare_section` returns; one row for each passage.

    Attributes
    ----------
    rows : Trajectory
        Everything at the passages; its figures are those of the whole run.
    time : Quantity
        Of the passages, since the start (K,) [s].
    angle, rate : Quantity
        Of the libration, in the orbit plane, -180 to 180 deg, and its rate over the mean motion (K,).
    distance, radial_velocity : Quantity
        Of the mass centres (K,) [m], [m/s].
    """

    rows: Trajectory
    time: Quantity
    angle: Quantity
    rate: Quantity
    distance: Quantity
    radial_velocity: Quantity


@dataclass(frozen=True, eq=False)
class Passages(Value):
    """What `stroboscopic_period` returns.

    Attributes
    ----------
    time : Quantity
        When the secondary passes the direction, since the start (K,) [s].
    periods : Quantity
        From each passage to the next (K - 1,) [h].
    period : Quantity
        Their mean [h].
    spread : Quantity
        Their standard deviation [h].
    """

    time: Quantity
    periods: Quantity
    period: Quantity
    spread: Quantity


def crossings(run: Trajectory, crossing: Crossing, bodies: Bodies = None) -> Trajectory:
    """Return a run's rows at the passages through a surface, each found between two rows.

    Between rows the motion is that of `Trajectory.at`, whose errors fall with the eighth power of the time between
    them: with 32 rows a turn they are below 1e-9 of the distance.

    Parameters
    ----------
    run : Trajectory
    crossing : {"periapsis", "apoapsis", "conjunction"} or callable
        Where the distance is smallest or largest, where the secondary passes the direction, in the mean orbit plane, in
        which it began; or a function that takes a `Trajectory` and returns a number for each row: passages are where
        it changes from negative to positive.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    Trajectory
        With no row at an impulse.

    Raises
    ------
    InputError
        Where there is no passage, or rows are so far apart that some may be missed.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=5 * u.day, integrator=ba.LGVI(40 * u.s), save_every=15 * u.min)
    >>> rows = ba.analysis.crossings(run, lambda rows: rows.si.position[:, 1, 2])
    >>> len(rows)
    11
    """
    function = _function(run, crossing, bodies)
    often_enough(run, orbit_rate(*relative_motion(run, bodies)), np.pi / 3)
    parts = [_crossings(leg, function) for leg in run.legs if len(leg) > 1]
    found = [part for part in parts if part is not None]
    if not found:
        name = crossing if isinstance(crossing, str) else "a function of yours"
        raise InputError(f"crossings: the run passes nowhere through {name}: expected at least one passage")
    arrays = [np.concatenate(group) for group in zip(*(part.si for part in found), strict=True)]
    return replace(run, si=TrajectoryFloats(*arrays))


def _between(leg: Trajectory, times: Floats) -> Trajectory:
    """Return rows at other times (K,) [s] within a leg."""
    return replace(leg, si=leg.interpolated(times))


def poincare_section(run: Trajectory, crossing: Crossing = "periapsis", bodies: Bodies = None) -> PoincareSection:
    """Return libration and distance, and their rates, at each passage through a surface.

    In regular motion the points lie on curves, and in chaotic motion they fill an area.

    Parameters
    ----------
    run, crossing, bodies
        As for `crossings`.

    Returns
    -------
    PoincareSection

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, _ = ba.catalogue.load("didymos")
    >>> start = ba.State.from_elements(
    ...     system, semi_major_axis=1.2 * u.km, eccentricity=0.03, spins=[2.26 * u.h, "synchronous"])
    >>> run = ba.propagate(system, start, duration=10 * u.day, accuracy=1e-7)
    >>> section = ba.analysis.poincare_section(run)
    >>> len(section.time) > 15
    True
    """
    secondary = turning(run, bodies, "poincare_section")
    rows = crossings(run, crossing, bodies)
    x, v = relative_motion(rows, bodies)
    frames = orbit_frames(rows, bodies)
    r = np.linalg.norm(x, axis=1)
    along, across, _ = np.einsum("nij,ni->jn", frames, rows.si.attitude[:, secondary, :, 0])
    spin = np.einsum("nij,nj->ni", rows.si.attitude[:, secondary], rows.si.spin[:, secondary])
    orbit = orbit_rate(x, v)
    mean = float(orbit_rate(*relative_motion(run, bodies)).mean())
    return PoincareSection(
        rows=rows,
        time=rows.time,
        angle=quantity(np.arctan2(across, along), "rad").to("deg"),
        rate=quantity((np.einsum("ni,ni->n", spin, frames[:, :, 2]) - orbit) / mean, ""),
        distance=quantity(r, "m"),
        radial_velocity=quantity(np.sum(x * v, axis=1) / r, "m / s"),
    )


def stroboscopic_period(run: Trajectory, bodies: Bodies = None, *, pole: Any = None) -> Passages:
    """Return the times at which the secondary passes one direction, and the periods between: what eclipses show.

    They vary from turn to turn, with the eccentricity and the libration, about the mean sidereal period.

    Parameters
    ----------
    run : Trajectory
        Without impulses: else take one of ``run.legs``.
    bodies : tuple of two, optional
        As for `orbit_angle`.
    pole : array-like or Quantity, optional
        A direction to look from, as a pole for `binaryast.State.from_elements`; passages are where the secondary is
        before the primary, or behind it, seen from there, in its component along the mean orbit plane. By default the
        direction in which the secondary began.

    Returns
    -------
    Passages

    Raises
    ------
    InputError
        For fewer than two passages, a direction along the orbit's pole, impulses, or rows too far apart.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=20 * u.day, integrator=ba.LGVI(40 * u.s), save_every=15 * u.min)
    >>> print(ba.analysis.stroboscopic_period(run).period.round(2))
    11.92 h
    """
    if pair_of(run, bodies) and len(run.legs) > 1:
        raise InputError("stroboscopic_period: the run has impulses, which change it: take one of run.legs")
    function: Crossing = "conjunction"
    if pole is not None:
        function = _passing(_across(run, pole_axes(pole)[:, 2], bodies), bodies)
    time = crossings(run, function, bodies).si.time
    if len(time) < 2:
        raise InputError(f"stroboscopic_period: expected at least two passages, got {len(time)}: run longer")
    periods = quantity(np.diff(time), "s").to("h")
    return Passages(quantity(time, "s"), periods, periods.mean(), periods.std())


def _function(run: Trajectory, crossing: Crossing, bodies: Bodies) -> Callable[[Trajectory], Floats]:
    """Return what changes sign at a passage."""
    pair_of(run, bodies)
    if callable(crossing):
        return _checked(crossing)
    if crossing in ("periapsis", "apoapsis"):
        sign = 1.0 if crossing == "periapsis" else -1.0
        return lambda rows: np.asarray(sign * np.sum(np.multiply(*relative_motion(rows, bodies)), axis=1))
    if crossing == "conjunction":
        return _passing(mean_orbit_axes(run, bodies)[1], bodies)
    near = did_you_mean(crossing, NAMED) if isinstance(crossing, str) else ""
    raise InputError(
        f"crossing={brief(repr(crossing))}{near}: expected one of {', '.join(NAMED)}, or a function of a trajectory"
    )


def _checked(function: Callable[[Trajectory], Any]) -> Callable[[Trajectory], Floats]:
    """Return a user's function, whose values are looked at."""

    def values(rows: Trajectory) -> Floats:
        found = np.asarray(getattr(result := function(rows), "value", result), dtype=float)
        if found.shape != (len(rows),) or not np.all(np.isfinite(found)):
            raise InputError(f"crossing: expected a finite number for each of {len(rows)} rows, got {brief(found)}")
        return found

    return values


def _passing(across: Floats, bodies: Bodies) -> Callable[[Trajectory], Floats]:
    """Return how far the secondary is beyond a direction, given the one across it (3,)."""
    return lambda rows: np.asarray(relative_motion(rows, bodies)[0] @ across)


def _across(run: Trajectory, direction: Floats, bodies: Bodies) -> Floats:
    """Return the direction in the mean orbit plane across one that is looked from."""
    across = np.cross(mean_orbit_axes(run, bodies)[2], direction)
    if np.linalg.norm(across) < 1e-6:
        raise InputError("stroboscopic_period: pole: the direction is along the orbit's pole: expected one across it")
    return np.asarray(across / np.linalg.norm(across))


def _crossings(leg: Trajectory, function: Callable[[Trajectory], Floats]) -> Trajectory | None:
    """Return the rows of a leg at which a function rises through zero, by halving the time between two rows."""
    values = function(leg)
    before = np.flatnonzero((values[:-1] < 0) & (values[1:] >= 0))
    if not len(before):
        return None
    low, high = leg.si.time[before].copy(), leg.si.time[before + 1].copy()
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        negative = function(_between(leg, middle)) < 0
        low, high = np.where(negative, middle, low), np.where(negative, high, middle)
    return _between(leg, high)
