"""A distant mass on a path that nothing here changes: the Sun, a planet, one that flies by, one of an ephemeris.

Positions are from the barycentre of the system, which falls with it: only the tide is left, and a torque on each body.
"""

from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from math import sqrt
from typing import Any, ClassVar

import numpy as np
from astropy.time import Time
from astropy.units import Quantity
from numpy.polynomial import chebyshev
from scipy.spatial.transform import Rotation

from binaryast.bodies import RigidBody
from binaryast.elements import ZERO, Orbit
from binaryast.errors import InputError
from binaryast.kernels.external import paths
from binaryast.perturbations.base import Perturbation, Span
from binaryast.units import Floats, brief, quantity, to_si

GM_SUN = 1.3271244004127942e20  # m3/s2, DE440
OBLIQUITY = np.deg2rad(84381.406 / 3600)  # of the ecliptic of J2000
NODES = 12  # of Chebyshev, in a part of an ellipse
PARTS = (64, 256, 1024)  # of it
LEFT_OUT = 5e-15  # by the polynomials, of the distance: round-off alone is 2e-15
LEAST_ROWS = 6  # of a quintic spline


class Distant(Perturbation):
    """A mass far away, whatever its path."""

    conservative: ClassVar[bool] = True
    first_term_only: bool = False

    @property
    @abstractmethod
    def gm_si(self) -> float:
        """G times its mass [m3/s2]."""

    @abstractmethod
    def path(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return its path from the barycentre, as ``kernels/external/paths.py`` reads it."""

    @property
    @abstractmethod
    def nearest(self) -> float:
        """The smallest distance from the barycentre [m] on its path."""

    @property
    def kernel(self) -> Callable[..., Any]:
        """The compiled potential."""
        from binaryast.kernels.external.third_body import potential

        return potential

    def check(self, bodies: Sequence[RigidBody]) -> None:
        """Raise where it cannot act on these bodies: it always can."""

    def parameters(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return GM, what is wanted of the tide, the bodies' masses and moments, and the path."""
        each = [[body.si.mass, body.pulls, *body.si.moments] for body in bodies]
        head = [self.gm_si, self.first_term_only, 3 + sum(len(numbers) for numbers in each)]
        return np.concatenate([head, *each, self.path(bodies, span)]).astype(float)

    def check_start(self, bodies: Sequence[RigidBody], position: Floats, span: Span) -> None:
        """Raise where it would come among the bodies, which lie at positions (n, 3) [m] about their barycentre."""
        reach = float(max(np.linalg.norm(x) + body.bounding_radius for x, body in zip(position, bodies, strict=True)))
        nearest = self.nearest - self._size
        if nearest <= reach:
            raise InputError(
                f"{type(self).__name__}: it comes within {nearest:.4g} m of the barycentre, where the bodies are up to "
                f"{reach:.4g} m away: expected a mass that stays outside of the system"
            )

    @property
    def _size(self) -> float:
        """Its own radius [m], as far as it is known."""
        return 0.0


def kepler_path(place: Floats, velocity: Floats, gm: float, time: float) -> Floats:
    """Return the path of a place and a velocity at a time; that of an ellipse as polynomials, where not too many."""
    whole = np.concatenate([[paths.KEPLER], place, velocity, [gm, time]])
    energy = velocity @ velocity / 2 - gm / np.linalg.norm(place)
    if energy >= 0:
        return whole
    period = 2 * np.pi * gm / (-2 * energy) ** 1.5
    nodes = np.cos(np.pi * (np.arange(NODES) + 0.5) / NODES)
    for count in PARTS:
        times = period / count * (np.arange(count)[:, None] + (1 + nodes) / 2)
        places = np.array([_moved(place, velocity, gm, float(t)) for t in times.ravel()]).reshape(count, NODES, 3)
        series = chebyshev.chebfit(nodes, np.moveaxis(places, 1, 0).reshape(NODES, -1), NODES - 1)
        wanted = paths.DEGREE_OF_ELLIPSE + 1
        if np.abs(series[wanted:]).max() < LEFT_OUT * np.linalg.norm(place):
            to_powers = [
                np.pad(chebyshev.cheb2poly(row[: k + 1]), (0, wanted - 1 - k)) for k, row in enumerate(np.eye(wanted))
            ]
            powers = (np.transpose(to_powers) @ series[:wanted]).reshape(wanted, count, 3)
            coefficients = np.moveaxis(powers[::-1], 0, 1)  # part, power, axis: the highest power first
            return np.concatenate([[paths.ELLIPSE, time, period, count], coefficients.ravel()])
    return whole


def _moved(place: Floats, velocity: Floats, gm: float, time: float) -> Floats:
    """Return where a Kepler motion is after a time."""
    from binaryast.kernels.kepler import moved

    return np.asarray(place + np.array(moved(place, velocity, gm, time)))


class InOrbit(Distant):
    """A mass about which the system is in orbit."""

    orbit: Orbit
    epoch: Time | None
    ecliptic: bool

    def _check_orbit(self) -> None:
        """Raise for arguments of the wrong kind."""
        name = type(self).__name__
        if not isinstance(self.orbit, Orbit):
            raise InputError(f"{name}: orbit: expected a ba.Orbit, got {brief(repr(self.orbit))}")
        if self.epoch is not None and not isinstance(self.epoch, Time):
            raise InputError(f"{name}: epoch: expected an astropy Time, got {brief(repr(self.epoch))}")
        for key in ("ecliptic", "first_term_only"):
            if not isinstance(getattr(self, key), bool):
                raise InputError(f"{name}: {key}: expected True or False, got {brief(repr(getattr(self, key)))}")

    def _gm_of_both(self, bodies: Sequence[RigidBody]) -> float:
        return self.gm_si + sum(body.si.gm for body in bodies if body.pulls)

    def path(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return its path from the barycentre: the other end of the orbit."""
        axes = np.eye(3)
        if self.ecliptic:
            if span.frame != "ICRF":
                raise InputError(
                    f"{type(self).__name__}: ecliptic=True needs axes that are known: expected a state with "
                    f"frame='ICRF', got {span.frame!r}"
                )
            axes = Rotation.from_euler("x", OBLIQUITY).as_matrix()
        gm = self._gm_of_both(bodies)
        place, velocity, _ = self.orbit.place(gm, axes)
        return kepler_path(-place, -velocity, gm, span.time_of(self.epoch, type(self).__name__))

    @property
    def nearest(self) -> float:
        """The distance at the periapsis [m]."""
        return float(self.orbit.semi_major_axis.value) * (1 - self.orbit.eccentricity)


@dataclass(frozen=True, eq=False, repr=False)
class Sun(InOrbit):
    """The Sun, about which the system goes on a Keplerian orbit.

    It acts by its tide on the orbit of the bodies about each other and by a torque, to the second degree, on each body.
    The distance of a body is never taken as a difference of two distances from the Sun, so no digits are lost (Battin).

    Parameters
    ----------
    orbit : Orbit
        Of the system's barycentre about the Sun.
    epoch : Time, optional
        When the barycentre is at the orbit's anomaly; by default at the start of a run, and each run begins there anew.
    ecliptic : bool
        Whether the orbit's angles are counted in the ecliptic of J2000; the state must then be in ``"ICRF"``. By
        default they are counted in the axes of the state.
    first_term_only : bool
        Whether to take the first term of the tide alone, quadratic in the distance of the bodies from the barycentre,
        as Hill's equations have it.

    Raises
    ------
    InputError
        For arguments of the wrong kind; when a run begins, where the Sun comes among the bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> bodies = [ba.RigidBody(name, ba.Point(), mass=1e12 * u.kg) for name in ("one", "two")]
    >>> sun = ba.Sun(ba.Orbit(1.6442 * u.au, eccentricity=0.38385))
    >>> system = ba.System(bodies, gravity=ba.PointMass(), perturbations=[sun])
    """

    orbit: Orbit
    epoch: Time | None = None
    ecliptic: bool = False
    first_term_only: bool = False

    def __post_init__(self) -> None:
        self._check_orbit()

    @property
    def gm_si(self) -> float:
        """G times the mass of the Sun [m3/s2]."""
        return GM_SUN


@dataclass(frozen=True, eq=False, repr=False)
class Planet(InOrbit):
    """A planet, or any other mass, about which the system goes on a Keplerian orbit; see `binaryast.Sun`.

    Parameters
    ----------
    gm : Quantity
        G times its mass.
    orbit, epoch, ecliptic, first_term_only
        As for `binaryast.Sun`.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> earth = ba.Planet(398600.4355 * u.km**3 / u.s**2, ba.Orbit(6678 * u.km))
    """

    gm: Quantity
    orbit: Orbit
    epoch: Time | None = None
    ecliptic: bool = False
    first_term_only: bool = False

    def __post_init__(self) -> None:
        self._set(gm=quantity(to_si(self.gm, "m3 / s2", "Planet: gm", sign="positive"), "m3 / s2"))
        self._check_orbit()

    @property
    def gm_si(self) -> float:
        """G times its mass [m3/s2]."""
        return float(self.gm.value)


@dataclass(frozen=True, eq=False, repr=False)
class Flyby(Distant):
    """A planet past which the system flies on a hyperbola.

    Parameters
    ----------
    gm : Quantity
        G times the planet's mass.
    distance : Quantity
        Of the system's barycentre from its centre at the closest (length).
    speed : Quantity
        Of the system relative to it, far away (v at infinity).
    time : Quantity
        When it is closest, since the start of the run.
    inclination, longitude_of_ascending_node, argument_of_periapsis : Quantity
        How the hyperbola of the system about the planet lies in the axes of the state (angles).
    radius : Quantity, optional
        Of the planet (length): a flyby that would hit it is refused.

    Raises
    ------
    InputError
        For a distance, a speed or G m that is not positive; a flyby that hits; when a run begins, for a planet that
        comes among the bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> earth = ba.Flyby(398600.4355 * u.km**3 / u.s**2, 20000 * u.km, 8 * u.km / u.s, 1 * u.day, radius=6378 * u.km)
    """

    gm: Quantity
    distance: Quantity
    speed: Quantity
    time: Quantity
    inclination: Quantity = ZERO
    longitude_of_ascending_node: Quantity = ZERO
    argument_of_periapsis: Quantity = ZERO
    radius: Quantity | None = None

    def __post_init__(self) -> None:
        for key, unit in (("gm", "m3 / s2"), ("distance", "m"), ("speed", "m / s")):
            value = to_si(getattr(self, key), unit, f"Flyby: {key}", sign="positive")
            self._set(**{key: quantity(value, unit)})
        self._set(time=quantity(to_si(self.time, "s", "Flyby: time"), "s"))
        for key in ("inclination", "longitude_of_ascending_node", "argument_of_periapsis"):
            self._set(**{key: quantity(to_si(getattr(self, key), "rad", f"Flyby: {key}"), "rad")})
        if self.radius is not None:
            self._set(radius=quantity(to_si(self.radius, "m", "Flyby: radius", sign="positive"), "m"))
            if self.distance.value <= self.radius.value:
                raise InputError(
                    f"Flyby: it hits: the distance of {self.distance.value:.6g} m is within the radius of "
                    f"{self.radius.value:.6g} m; expected a larger one"
                )

    @property
    def gm_si(self) -> float:
        """G times its mass [m3/s2]."""
        return float(self.gm.value)

    @property
    def _size(self) -> float:
        return 0.0 if self.radius is None else float(self.radius.value)

    def path(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return its path from the barycentre."""
        gm = self.gm_si + sum(body.si.gm for body in bodies if body.pulls)
        angles = (self.longitude_of_ascending_node, self.inclination, self.argument_of_periapsis)
        plane = Rotation.from_euler("ZXZ", [float(angle.value) for angle in angles]).as_matrix()
        distance, speed = float(self.distance.value), float(self.speed.value)
        fastest = sqrt(speed**2 + 2 * gm / distance)
        return kepler_path(-distance * plane[:, 0], -fastest * plane[:, 1], gm, float(self.time.value))

    @property
    def nearest(self) -> float:
        """The closest distance [m], whether the run comes there or not."""
        return float(self.distance.value)


@dataclass(frozen=True, eq=False, repr=False)
class ThirdBody(Distant):
    """A distant mass whose places are in a table, of an ephemeris say; between them it is on a quintic spline.

    Parameters
    ----------
    gm : Quantity
        G times its mass.
    times : Quantity
        (N,), growing, at least six; since the epoch. They must cover a run.
    positions : Quantity
        (N, 3) from the system's barycentre, in the axes of the state.
    epoch : Time, optional
        When the times are zero; by default at the start of a run.
    first_term_only : bool
        As for `binaryast.Sun`.

    Raises
    ------
    InputError
        For fewer than six times, times that do not grow, other shapes; when a run begins, for a table that does not
        cover it, or a mass that comes among the bodies.

    Examples
    --------
    >>> import astropy.units as u
    >>> import numpy as np
    >>> import binaryast as ba
    >>> times = np.linspace(0, 10, 101) * u.day
    >>> places = np.outer(np.cos(times.value / 58), [1, 0, 0]) + np.outer(np.sin(times.value / 58), [0, 1, 0])
    >>> mass = ba.ThirdBody(1.327e11 * u.km**3 / u.s**2, times, -places * u.au)
    """

    gm: Quantity
    times: Quantity
    positions: Quantity
    epoch: Time | None = None
    first_term_only: bool = False

    def __post_init__(self) -> None:
        self._set(gm=quantity(to_si(self.gm, "m3 / s2", "ThirdBody: gm", sign="positive"), "m3 / s2"))
        count = len(self.times) if isinstance(self.times, Quantity) and self.times.ndim == 1 else 0
        times = to_si(self.times, "s", "ThirdBody: times", shape=(count,))
        if count < LEAST_ROWS or not np.all(np.diff(times) > 0):
            raise InputError(f"ThirdBody: times: expected at least {LEAST_ROWS} that grow, got {brief(self.times)}")
        positions = to_si(self.positions, "m", "ThirdBody: positions", shape=(count, 3))
        self._set(times=quantity(times, "s"), positions=quantity(positions, "m"))
        if self.epoch is not None and not isinstance(self.epoch, Time):
            raise InputError(f"ThirdBody: epoch: expected an astropy Time, got {brief(repr(self.epoch))}")

    @property
    def gm_si(self) -> float:
        """G times its mass [m3/s2]."""
        return float(self.gm.value)

    def _times(self, span: Span) -> Floats:
        """Return the times in that of the run [s]."""
        return np.asarray(self.times.value + span.time_of(self.epoch, "ThirdBody"))

    def path(self, bodies: Sequence[RigidBody], span: Span) -> Floats:
        """Return the spline's pieces."""
        from scipy.interpolate import PPoly, make_interp_spline

        times = self._times(span)
        if not times[0] <= span.begin <= span.end <= times[-1]:
            raise InputError(
                f"ThirdBody: its times go from {times[0]:g} s to {times[-1]:g} s of the run, which goes from "
                f"{span.begin:g} s to {span.end:g} s: expected a table that covers it"
            )
        axes = [PPoly.from_spline(make_interp_spline(times, places, k=5)) for places in self.positions.value.T]
        knots = axes[0].x
        real = np.diff(knots) > 0  # knots at the ends lie on each other
        ends = np.append(knots[:-1][real], knots[-1])
        coefficients = np.stack([axis.c[:, real].T for axis in axes], axis=-1)  # piece, power, axis
        return np.concatenate([[paths.SPLINE, real.sum()], ends, coefficients.ravel()])

    @property
    def nearest(self) -> float:
        """The smallest distance in the table [m]."""
        return float(np.linalg.norm(self.positions.value, axis=1).min())
