"""How a secondary lies in the orbit frame: roll, pitch and yaw, and which of its axes turn over."""

from dataclasses import dataclass

import numpy as np
from astropy.units import Quantity

from binaryast.analysis.libration import first_time
from binaryast.analysis.pairs import Bodies, orbit_frames, turning
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, quantity
from binaryast.values import Value

LOCKED = 1e-9  # cosine of the pitch below which roll and yaw are turns about one axis
TURNED_OVER = np.pi / 2
KINDS = {  # by which of the axes x, y, z turn over
    (False, False, False): "synchronous",
    (False, True, True): "rolling",
    (True, False, True): "pitching",
    (True, True, False): "yawing",
}


@dataclass(frozen=True, eq=False)
class RollPitchYaw(Value):
    """Angles of a body against the orbit frame, of which `roll_pitch_yaw` says more.

    Attributes
    ----------
    time : Quantity
        Since the start (N,) [s].
    roll, pitch, yaw : Quantity
        (N,) [deg]; roll and yaw from -180 to 180 deg, pitch from -90 to 90 deg.
    """

    time: Quantity
    roll: Quantity
    pitch: Quantity
    yaw: Quantity


@dataclass(frozen=True, eq=False)
class Tumbling(Value):
    """How far the axes of a body go from those of the orbit frame, of which `tumbling` says more.

    Attributes
    ----------
    time : Quantity
        Since the start (N,) [s].
    angles : Quantity
        Of the body's x, y and z axis from where synchronous rotation has them (N, 3) [deg].
    turned_over : Quantity
        When each is for the first time more than 90 deg from there (3,) [d]; infinite for one that never is.
    kind : str
        ``"synchronous"``, where none turns over; ``"rolling"``, where all but x do, the long axis still pointing at the
        primary; ``"pitching"``, all but y; ``"yawing"``, all but z, the pole still up; else ``"tumbling"``.
    """

    time: Quantity
    angles: Quantity
    turned_over: Quantity
    kind: str


def roll_pitch_yaw(run: Trajectory, bodies: Bodies = None) -> RollPitchYaw:
    """Return roll, pitch and yaw of the secondary: Euler angles 1-2-3 from the orbit frame to the body frame.

    The orbit frame has x along the line of centres, from primary to secondary, z along the orbit's pole of that moment,
    and y across, in which the secondary moves. The body frame is the orbit frame turned by roll about its x axis, then
    by pitch about the new y axis, then by yaw about the new z axis. A synchronous body whose x axis leads away from the
    primary has zero of each; for small ones, yaw is the libration angle.

    Parameters
    ----------
    run : Trajectory
        With rows as far apart as you like.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    RollPitchYaw
        At a pitch of 90 deg, where roll and yaw are turns about one axis, that turn is roll, and yaw is zero.

    Raises
    ------
    InputError
        For a secondary that is a point, or a pair that moves on a line.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=2 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> bool(abs(ba.analysis.roll_pitch_yaw(run).yaw).max().to_value("deg") < 0.1)
    True
    """
    a = _in_orbit_frame(run, bodies, "roll_pitch_yaw")
    sine, cosine = a[:, 0, 2], np.hypot(a[:, 0, 0], a[:, 0, 1])
    free = cosine > LOCKED
    angles = {
        "roll": np.where(free, np.arctan2(-a[:, 1, 2], a[:, 2, 2]), np.arctan2(a[:, 2, 1], a[:, 1, 1])),
        "pitch": np.arctan2(sine, cosine),
        "yaw": np.where(free, np.arctan2(-a[:, 0, 1], a[:, 0, 0]), 0.0),
    }
    return RollPitchYaw(run.time, **{name: quantity(angle, "rad").to("deg") for name, angle in angles.items()})


def tumbling(run: Trajectory, bodies: Bodies = None) -> Tumbling:
    """Return how far each axis of the secondary goes from where synchronous rotation has it, and which turn over.

    A body looks the same to second degree after half a turn about an axis: angles are counted from that of the four
    positions which it starts nearest to.

    Parameters
    ----------
    run : Trajectory
        With rows so near that nothing turns over and back between them.
    bodies : tuple of two, optional
        As for `orbit_angle`.

    Returns
    -------
    Tumbling

    Raises
    ------
    InputError
        As for `roll_pitch_yaw`.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=2 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> ba.analysis.tumbling(run).kind
    'synchronous'
    """
    a = _in_orbit_frame(run, bodies, "tumbling")
    halves = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
    start = halves[np.argmax(halves @ np.diagonal(a[0]))]
    cosines = start * np.diagonal(a, axis1=1, axis2=2)
    angles = np.arccos(np.clip(cosines, -1.0, 1.0))
    first = Quantity([first_time(run.si.time, angle, TURNED_OVER) for angle in angles.T])
    x, y, z = np.isfinite(first.value).tolist()
    return Tumbling(run.time, quantity(angles, "rad").to("deg"), first, KINDS.get((x, y, z), "tumbling"))


def _in_orbit_frame(run: Trajectory, bodies: Bodies, what: str) -> Floats:
    """Return the attitudes of the secondary, body frame -> orbit frame (N, 3, 3)."""
    secondary = turning(run, bodies, what)
    return np.asarray(np.swapaxes(orbit_frames(run, bodies), -1, -2) @ run.si.attitude[:, secondary])
