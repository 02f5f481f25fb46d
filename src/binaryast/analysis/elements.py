"""Keplerian elements of two bodies along a run: osculating, and their means over a turn."""

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.kepler import Orbits, orbits_of, unwrapped
from binaryast.analysis.means import running_mean
from binaryast.analysis.orbit import mutual_period
from binaryast.analysis.pairs import Bodies, pair_of, relative_motion
from binaryast.errors import InputError
from binaryast.orbits import pole_axes
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, quantity
from binaryast.values import Value

if TYPE_CHECKING:
    from astropy.table import QTable


@dataclass(frozen=True, eq=False)
class Elements(Value):
    """Keplerian elements along a run, all (N,) and finite; angles are without jumps.

    Attributes
    ----------
    time : Quantity
        Since the start [s].
    semi_major_axis : Quantity
        [m]; negative of an unbound orbit.
    eccentricity : ndarray
        At least 0.
    inclination : Quantity
        0 to 180 deg [deg].
    longitude_of_ascending_node, argument_of_periapsis : Quantity
        [deg]; the node is put on the x axis of the reference plane where `planar`, and the periapsis on the node where
        `circular`.
    true_anomaly, mean_anomaly : Quantity
        From the periapsis [deg]. Of an unbound orbit, the mean anomaly is e sinh H - H.
    mean_longitude : Quantity
        Node, argument of periapsis and mean anomaly together [deg].
    mean_motion : Quantity
        Of the semi-major axis and G (m1 + m2) [deg / d].
    circular, planar : ndarray of bool
        Where the eccentricity, or the sine of the inclination, is so near zero that its direction is round-off.
    """

    time: Quantity
    semi_major_axis: Quantity
    eccentricity: Floats
    inclination: Quantity
    longitude_of_ascending_node: Quantity
    argument_of_periapsis: Quantity
    true_anomaly: Quantity
    mean_anomaly: Quantity
    mean_longitude: Quantity
    mean_motion: Quantity
    circular: Any
    planar: Any

    def __len__(self) -> int:
        return len(self.time)

    def to_table(self) -> "QTable":
        """Return the elements as a table with units, which `astropy` writes in any format."""
        from astropy.table import QTable

        return QTable({field.name: getattr(self, field.name) for field in fields(self)})


def osculating_elements(run: Trajectory, bodies: Bodies = None, *, pole: Any = None) -> Elements:
    """Return the elements of the Kepler orbit of G (m1 + m2) that each row would go on with.

    Parameters
    ----------
    run : Trajectory
    bodies : tuple of two, optional
        As for `orbit_angle`.
    pole : array-like or Quantity, optional
        Of the plane that angles are counted from, as for `binaryast.State.from_elements`; the inertial z by default.

    Returns
    -------
    Elements
        Of a body near an oblate one, these are not those of its mean orbit: on a circle it has an eccentricity of about
        3/2 J2 (R/r)^2 and stays at the periapsis. `mean_elements` takes that off.

    Raises
    ------
    InputError
        Where the pair moves on a line.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, _ = ba.catalogue.load("patroclus")
    >>> start = ba.State.from_elements(system, semi_major_axis=692.5 * u.km, eccentricity=0.1,
    ...     inclination=20 * u.deg, spins=["synchronous", "synchronous"])
    >>> run = ba.propagate(system, start, duration=1 * u.day, integrator=ba.LGVI(1 * u.min))
    >>> elements = ba.analysis.osculating_elements(run)
    >>> print(elements.semi_major_axis[0].to(u.km).round(1), elements.inclination[0].round(3))
    692.5 km 20.0 deg
    """
    gm = _gm(run, bodies)
    return _elements(run.si.time, orbits_of(*relative_motion(run, bodies), gm), gm, pole_axes(pole))


def mean_elements(run: Trajectory, bodies: Bodies = None, *, pole: Any = None) -> Elements:
    """Return the osculating elements without what changes within a turn: their running means over two turns.

    Means are taken of the semi-major axis, of the vectors of eccentricity and of angular momentum, so that circular and
    planar orbits are no special cases, and of the mean longitude, with triangular weights.

    Parameters
    ----------
    run : Trajectory
        Of at least three turns, without impulses: else take one of ``run.legs``.
    bodies, pole
        As for `osculating_elements`.

    Returns
    -------
    Elements
        At the rows that have a turn before and one after them. The mean motion is that of the mean semi-major axis; the
        mean rate is the slope of the mean longitude.

    Raises
    ------
    InputError
        For a run that is too short, has impulses, or too few rows a turn.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=20 * u.day, integrator=ba.LGVI(40 * u.s), save_every=30 * u.min)
    >>> before = ba.analysis.osculating_elements(run).eccentricity.mean()
    >>> bool(before > 0.01 > 1e-4 > ba.analysis.mean_elements(run).eccentricity.max())
    True
    """
    gm, axes, time = _gm(run, bodies), pole_axes(pole), run.si.time
    if len(run.legs) > 1:
        raise InputError("mean_elements: the run has impulses, across which there are no means: take one of run.legs")
    period = float(mutual_period(run, bodies).to_value("s"))
    if time[-1] - time[0] < 3 * period:
        raise InputError(
            f"mean_elements: the run covers {(time[-1] - time[0]) / period:.3g} turns: expected at least three"
        )
    osculating = orbits_of(*relative_motion(run, bodies), gm)
    longitude = np.radians(_elements(time, osculating, gm, axes).mean_longitude.value)

    def mean(values: Floats) -> Floats:
        return running_mean(time, values, period)

    inside = (time >= time[0] + period) & (time <= time[-1] - period)
    averaged = Orbits(mean(osculating.axis), mean(osculating.eccentricity), mean(osculating.momentum), np.zeros(0))
    return _elements(time[inside], averaged, gm, axes, mean(longitude))


def _gm(run: Trajectory, bodies: Bodies) -> float:
    """Return G (m1 + m2) [m3/s2]."""
    return float(sum(run.system.bodies[i].si.gm for i in pair_of(run, bodies)))


def _elements(time: Floats, orbits: Orbits, gm: float, axes: Floats, longitude: Floats | None = None) -> Elements:
    """Return the elements of orbits against a reference plane; of means, whose place is given by a mean longitude."""
    angles = orbits.angles(axes, longitude)
    rate = np.sqrt(gm / np.abs(orbits.axis) ** 3)

    def degrees(values: Floats) -> Quantity:
        return quantity(values, "rad").to("deg")

    return Elements(
        time=quantity(time, "s"),
        semi_major_axis=quantity(orbits.axis, "m"),
        eccentricity=orbits.size,
        inclination=degrees(angles.inclination),
        longitude_of_ascending_node=degrees(np.unwrap(angles.node)),
        argument_of_periapsis=degrees(np.unwrap(angles.periapsis)),
        true_anomaly=degrees(unwrapped(time, angles.true_anomaly, rate)),
        mean_anomaly=degrees(unwrapped(time, angles.mean_anomaly, rate)),
        mean_longitude=degrees(unwrapped(time, angles.mean_longitude, rate)),
        mean_motion=quantity(rate, "rad / s").to("deg / d"),
        circular=angles.circular,
        planar=angles.planar,
    )
