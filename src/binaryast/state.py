"""Where everything is and how it moves at one moment: inertial, or relative as the paper reduces it."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from astropy.time import Time
from astropy.units import Quantity
from scipy.spatial.transform import Rotation

from binaryast import markup, orbits
from binaryast.elements import ZERO, Orbit
from binaryast.errors import InputError
from binaryast.orbits import from_orbits, is_celestial
from binaryast.rotations import rotation
from binaryast.system import System
from binaryast.units import Floats, as_quantity, brief, quantity, to_si
from binaryast.values import Value


class StateFloats(NamedTuple):
    """A state as plain SI floats: (n, 3), (n, 3), (n, 3, 3), (n, 3)."""

    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats


@dataclass(frozen=True, eq=False)
class State(Value):
    """Positions, velocities, attitudes and spins of all bodies, in the order of the system.

    Parameters
    ----------
    position, velocity : Quantity
        Of the mass centres (n, 3), inertial. Give the origin near the barycentre: digits are lost otherwise.
    attitude : array-like or scipy Rotation
        Rotation matrices (n, 3, 3), body frame -> inertial.
    spin : Quantity
        Angular velocities (n, 3), each in its own body's frame (angle over time).
    epoch : astropy.time.Time, optional
        Of this state; kept in TDB.
    frame : str
        Name of the inertial axes: ``"local"`` or ``"ICRF"``.

    Raises
    ------
    UnitError, InputError
        For a wrong unit or shape, values that are not finite, or an attitude that is not a rotation.

    Examples
    --------
    >>> import astropy.units as u, numpy as np
    >>> import binaryast as ba
    >>> state = ba.State(
    ...     position=[[0, 0, 0], [1, 0, 0]] * u.km,
    ...     velocity=[[0, 0, 0], [0, 10, 0]] * u.cm / u.s,
    ...     attitude=[np.eye(3), np.eye(3)],
    ...     spin=[[0, 0, 1e-4], [0, 0, 1e-4]] * u.rad / u.s,
    ... )
    >>> print(state.velocity[1])
    [0.  0.1 0. ] m / s
    """

    position: Quantity
    velocity: Quantity
    attitude: Any
    spin: Quantity
    epoch: Time | None = None
    frame: str = "local"
    si: StateFloats = field(init=False, repr=False)

    def __post_init__(self) -> None:
        given = as_quantity(self.position, "m", "position")
        count = len(given) if given.ndim == 2 and len(given) > 1 else 2
        position = to_si(self.position, "m", "position", shape=(count, 3))
        velocity = to_si(self.velocity, "m / s", "velocity", shape=(count, 3))
        attitude = rotation(self.attitude, "attitude", (count,))
        spin = to_si(self.spin, "rad / s", "spin", shape=(count, 3))
        if self.frame not in ("local", "ICRF"):
            raise InputError(f"frame: expected 'local' or 'ICRF', got {self.frame!r}")
        self._set(
            position=quantity(position, "m"),
            velocity=quantity(velocity, "m / s"),
            attitude=attitude,
            spin=quantity(spin, "rad / s"),
            epoch=_tdb(self.epoch),
            si=StateFloats(position, velocity, attitude, spin),
        )

    @classmethod
    def circular_orbit(
        cls,
        system: System,
        *,
        separation: Quantity | None = None,
        period: Quantity | None = None,
        pole: Any = None,
        spins: Sequence[Any],
        epoch: Time | None = None,
        frame: str | None = None,
    ) -> "State":
        """Return a pair on a circular orbit about its barycentre, in its own field.

        The rate is that of the system's gravity, not Kepler's: n^2 = (dU/dr)/(m r), with the mean over a turn for each
        body that is not synchronous. Both bodies start with z along the orbit's pole and x along the line of centres.

        Parameters
        ----------
        system : System
            The pair.
        separation, period : Quantity
            Exactly one: distance of the mass centres (length), or sidereal period of the orbit (time).
        pole : array-like or Quantity, optional
            Of the orbit: three numbers, right ascension and declination (two angles), or a ``SkyCoord``; the inertial z
            by default.
        spins : sequence
            For each body, primary first: a period (time) or a rate (angle over time) about its z axis, a vector of
            three rates in the body's frame, or ``"synchronous"``; for a point None, or ``"none"``.
        epoch : astropy.time.Time, optional
            Of the state.
        frame : str, optional
            ``"ICRF"`` where the pole is given by right ascension and declination, else ``"local"``.

        Returns
        -------
        State

        Raises
        ------
        InputError
            For both or neither of separation and period, or a field without such an orbit.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, _ = ba.catalogue.load("didymos")
        >>> start = ba.State.circular_orbit(system, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
        >>> print(start.separation.round(1))
        1184.2 m
        """
        _check_system(system, "circular_orbit")
        motion = orbits.circular_orbit(system, separation, period, pole, spins)
        return cls._from_motion(motion, epoch, frame, pole)

    @classmethod
    def from_elements(
        cls,
        system: System,
        *,
        semi_major_axis: Quantity,
        eccentricity: float = 0.0,
        inclination: Quantity = ZERO,
        longitude_of_ascending_node: Quantity = ZERO,
        argument_of_periapsis: Quantity = ZERO,
        true_anomaly: Quantity | None = None,
        mean_anomaly: Quantity | None = None,
        pole: Any = None,
        spins: Sequence[Any],
        epoch: Time | None = None,
        frame: str | None = None,
    ) -> "State":
        """Return a pair on the orbit with these osculating Keplerian elements, of G (m1 + m2).

        Both bodies start with z along the orbit's pole and x from the primary to the secondary.

        Parameters
        ----------
        system : System
            The pair.
        semi_major_axis : Quantity
            Of the relative orbit (length).
        eccentricity : float
            At least 0 and below 1.
        inclination, longitude_of_ascending_node, argument_of_periapsis : Quantity
            Orientation of the orbit (angles), with respect to the inertial axes or the plane of ``pole``.
        true_anomaly, mean_anomaly : Quantity
            Place on the orbit (angle), at most one of the two; the periapsis by default.
        pole : array-like or Quantity, optional
            Of the plane that inclination is counted from; see `circular_orbit`.
        spins : sequence
            As for `circular_orbit`; ``"synchronous"`` is the mean motion.
        epoch, frame
            As for `circular_orbit`.

        Returns
        -------
        State

        Raises
        ------
        InputError
            For an eccentricity outside 0 <= e < 1, or both anomalies.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> system, _ = ba.catalogue.load("patroclus")
        >>> start = ba.State.from_elements(
        ...     system, semi_major_axis=692.5 * u.km, eccentricity=0.1, spins=["synchronous", "synchronous"])
        >>> print(start.separation.to(u.km).round(2))
        623.25 km
        """
        _check_system(system, "from_elements")
        orbit = Orbit(
            semi_major_axis,
            eccentricity,
            inclination,
            longitude_of_ascending_node,
            argument_of_periapsis,
            true_anomaly,
            mean_anomaly,
        )
        return cls._from_motion(from_orbits(system, [orbit], pole, spins, None), epoch, frame, pole)

    @classmethod
    def from_orbits(
        cls,
        system: System,
        orbits: Sequence[Orbit],
        *,
        pole: Any = None,
        spins: Sequence[Any],
        poles: Mapping[str, Any] | None = None,
        epoch: Time | None = None,
        frame: str | None = None,
    ) -> "State":
        """Return any number of bodies on osculating Keplerian orbits, the barycentre at rest in the origin.

        Each body starts with z along its orbit's pole and x from the orbit's centre to it, the primary as the first
        of the others.

        Parameters
        ----------
        system : System
            Two bodies or more.
        orbits : sequence of Orbit
            One for each body but the primary, in the order of the system.
        pole : array-like or Quantity, optional
            Of the plane that inclinations are counted from; see `circular_orbit`.
        spins : sequence
            As for `circular_orbit`, one for each body. ``"synchronous"`` is the mean motion.
        poles : mapping, optional
            Of bodies by name, each as ``pole``: such a body starts with z along it instead of its orbit's.
        epoch, frame
            As for `circular_orbit`.

        Returns
        -------
        State

        Raises
        ------
        InputError
            For another number of orbits or spins than the bodies need, or a pole of no body.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> bodies = [ba.RigidBody(n, ba.Sphere(r * u.m), mass=m * u.kg) for n, r, m in (
        ...     ("A", 500, 1e12), ("B", 50, 1e9), ("C", 60, 2e9))]
        >>> start = ba.State.from_orbits(
        ...     ba.System(bodies), [ba.Orbit(2 * u.km), ba.Orbit(7 * u.km, 0.1, about="inner")],
        ...     spins=[3 * u.h, "synchronous", "synchronous"])
        >>> start.position.shape
        (3, 3)
        """
        _check_kind(system)
        motion = from_orbits(system, orbits, pole, spins, poles)
        celestial = next((one for one in (pole, *(poles or {}).values()) if is_celestial(one)), pole)
        return cls._from_motion(motion, epoch, frame, celestial)

    @classmethod
    def _from_motion(cls, motion: orbits.Motion, epoch: Time | None, frame: str | None, pole: Any) -> "State":
        """Attach units, epoch and frame."""
        return cls(
            position=quantity(motion.position, "m"),
            velocity=quantity(motion.velocity, "m / s"),
            attitude=motion.attitude,
            spin=quantity(motion.spin, "rad / s"),
            epoch=epoch,
            frame=("ICRF" if orbits.is_celestial(pole) else "local") if frame is None else frame,
        )

    @property
    def rotation(self) -> Rotation:
        """The attitudes as SciPy rotations (n,), body frame -> inertial."""
        return Rotation.from_matrix(self.si.attitude.copy())

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        return markup.state(self)

    @property
    def separation(self) -> Quantity:
        """Distance of the mass centres of a pair [m]."""
        position = self.si.position
        if len(position) > 2:
            raise InputError(f"separation: of a pair; this state has {len(position)} bodies: see position")
        return quantity(np.linalg.norm(position[1] - position[0]), "m")

    def relative(self) -> "RelativeState":
        """Return the paper's variables (34)-(39) of a pair."""
        return RelativeState.from_state(self)


@dataclass(frozen=True, eq=False)
class RelativeState(Value):
    """The paper's reduced variables, all with components in the primary's frame; the secondary is its body 1.

    Each may have leading axes, such as time first for a trajectory.

    Parameters
    ----------
    X, V : Quantity
        Relative position R2^T (x1 - x2) (34) and velocity R2^T (v1 - v2) (36), (..., 3). V is not dX/dt: it is the
        inertial velocity in the primary's axes.
    R : array-like
        Relative attitude R2^T R1 (35), (..., 3, 3).
    Omega, Omega2 : Quantity
        Angular velocity of the secondary, R Omega1 (37), and of the primary, (..., 3).
    X2, V2 : Quantity, optional
        Position and velocity of the primary, R2^T x2 (38) and R2^T v2 (39).
    R2 : array-like, optional
        Attitude of the primary; the identity by default.
    epoch, frame
        As for `State`.

    Examples
    --------
    >>> import astropy.units as u, numpy as np
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> relative = state.relative()
    >>> back = relative.to_state(system)
    >>> bool(np.allclose(back.position.value, state.position.value, atol=1e-9))
    True
    """

    X: Quantity
    V: Quantity
    R: Any
    Omega: Quantity
    Omega2: Quantity
    X2: Quantity | None = None
    V2: Quantity | None = None
    R2: Any = None
    epoch: Time | None = None
    frame: str = "local"

    def __post_init__(self) -> None:
        leading = as_quantity(self.X, "m", "X").shape[:-1]
        units = {"X": "m", "V": "m / s", "Omega": "rad / s", "Omega2": "rad / s", "X2": "m", "V2": "m / s"}
        for name, unit in units.items():
            value = getattr(self, name)
            if value is not None or name in ("V", "Omega", "Omega2"):
                self._set(**{name: quantity(to_si(value, unit, name, shape=(*leading, 3)), unit)})
        attitude = np.broadcast_to(np.eye(3), (*leading, 3, 3)) if self.R2 is None else self.R2
        self._set(R=rotation(self.R, "R", leading), R2=rotation(attitude, "R2", leading))

    @classmethod
    def from_state(cls, state: State) -> "RelativeState":
        """Return (34)-(39) of a pair's state."""
        if len(state.si.position) != 2:
            raise InputError(f"relative: expected the state of a pair, got {len(state.si.position)} bodies")
        return cls.from_arrays(*state.si, epoch=state.epoch, frame=state.frame)

    @classmethod
    def from_arrays(
        cls,
        position: Floats,
        velocity: Floats,
        attitude: Floats,
        spin: Floats,
        *,
        epoch: Time | None = None,
        frame: str = "local",
    ) -> "RelativeState":
        """Return (34)-(39) of SI arrays (..., n, 3) and (..., n, 3, 3), primary first."""
        to_primary = np.swapaxes(attitude[..., 0, :, :], -1, -2)

        def turned(vector: Floats) -> Floats:
            return np.asarray(np.einsum("...ij,...j->...i", to_primary, vector))

        relative_attitude = to_primary @ attitude[..., 1, :, :]
        return cls(
            X=quantity(turned(position[..., 1, :] - position[..., 0, :]), "m"),  # (34)
            V=quantity(turned(velocity[..., 1, :] - velocity[..., 0, :]), "m / s"),  # (36)
            R=relative_attitude,  # (35)
            Omega=quantity(np.einsum("...ij,...j->...i", relative_attitude, spin[..., 1, :]), "rad / s"),  # (37)
            Omega2=quantity(spin[..., 0, :], "rad / s"),
            X2=quantity(turned(position[..., 0, :]), "m"),  # (38)
            V2=quantity(turned(velocity[..., 0, :]), "m / s"),  # (39)
            R2=attitude[..., 0, :, :],
            epoch=epoch,
            frame=frame,
        )

    def to_state(self, system: System | None = None) -> State:
        """Return the inertial state.

        Parameters
        ----------
        system : System, optional
            Needed where X2 or V2 is missing: the barycentre is then at rest in the origin.

        Returns
        -------
        State

        Raises
        ------
        InputError
            Where X2 or V2 is missing and no system is given.
        """
        if self.X.ndim != 1:
            raise InputError(f"to_state: expected one moment, got {self.X.shape[:-1]}: take one element first")
        X2, V2 = self.X2, self.V2
        if X2 is None or V2 is None:
            if not isinstance(system, System):
                raise InputError(
                    "to_state: X2 and V2 are not known: give system=, and the barycentre is at rest in the origin"
                )
            share = -system.secondary.si.mass / (system.secondary.si.mass + system.primary.si.mass)
            X2, V2 = X2 if X2 is not None else share * self.X, V2 if V2 is not None else share * self.V
        return State(
            position=Quantity([self.R2 @ X2, self.R2 @ (X2 + self.X)]),
            velocity=Quantity([self.R2 @ V2, self.R2 @ (V2 + self.V)]),
            attitude=np.array([self.R2, self.R2 @ self.R]),
            spin=Quantity([self.Omega2, self.R.T @ self.Omega]),
            epoch=self.epoch,
            frame=self.frame,
        )


def _tdb(epoch: Any) -> Time | None:
    """Return an epoch in TDB."""
    if epoch is None:
        return None
    if not isinstance(epoch, Time) or not epoch.isscalar or np.any(epoch.mask):
        raise InputError(f"epoch: expected one astropy.time.Time, got {brief(epoch)}")
    try:
        return epoch.tdb
    except Exception as error:  # a local time, or a date outside of astropy's tables
        raise InputError(f"epoch: {brief(epoch)} has no TDB: {brief(error)}") from None


def _check_kind(system: Any) -> None:
    """Raise where a system is something else."""
    if not isinstance(system, System):
        raise InputError(f"system: expected a ba.System, got {brief(system)}")


def _check_system(system: Any, what: str) -> None:
    """Raise where a system is something else than a pair."""
    _check_kind(system)
    if len(system.bodies) > 2:
        raise InputError(f"{what}: of a pair; this system has {len(system.bodies)} bodies: use ba.State.from_orbits")
