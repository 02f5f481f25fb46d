"""What the built-in events watch: each g(p, t, position, velocity, attitude, spin), which is zero when it happens.

The parameters p begin with the bodies, by index; where the bodies are is about the barycentre, in inertial axes, spins
in the bodies' own. The value that is to be passed is the last of the parameters.
"""

from math import asin, atan2, pi, sqrt

from binaryast.kernels.clearance import clearance_of
from binaryast.kernels.events.places import apart, matrix_of
from binaryast.kernels.jit import EVENT, Array, Vector, jit
from binaryast.kernels.so3 import cross, dot, rotate, rotate_back

ROUNDING = 1e-14  # of a size: what is smaller is round-off, as the height above the plane of an orbit that stays in it


@jit()
def rounded(difference: float, size: float) -> float:
    """Return a difference of two numbers of a size, zero where it is their round-off: that would pass through zero."""
    return 0.0 if abs(difference) <= ROUNDING * size else difference


@jit()
def from_value(angle: float, value: float) -> float:
    """Return an angle less a value, within half a turn of zero."""
    difference = angle - value
    while difference > pi:
        difference -= 2.0 * pi
    while difference <= -pi:
        difference += 2.0 * pi
    return difference


@jit(EVENT)
def separation(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return |x1 - x2| - value; p: one, two, value [m]."""
    x = apart(position, int(p[0]), int(p[1]))
    value: float = rounded(sqrt(dot(x, x)) - p[2], p[2])
    return value


@jit(EVENT)
def radial_velocity(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return d|x1 - x2|/dt - value; p: one, two, value [m/s]."""
    x, v = apart(position, int(p[0]), int(p[1])), apart(velocity, int(p[0]), int(p[1]))
    value: float = rounded(dot(x, v) / sqrt(dot(x, x)) - p[2], sqrt(dot(v, v)))
    return value


@jit(EVENT)
def spin_rate(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return |Omega| - value; p: one, two (not used), value [rad/s]."""
    one = int(p[0])
    value: float = sqrt(spin[one, 0] ** 2 + spin[one, 1] ** 2 + spin[one, 2] ** 2) - p[2]
    return value


@jit(EVENT)
def contact(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the `clearance` of two bodies; p: surfaces, one, two."""
    value: float = clearance_of(position, attitude, p, int(p[p.size - 2]), int(p[p.size - 1]))
    return value


@jit(EVENT)
def plane(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return n.(x1 - x2) - offset, n inertial or a body's; p: one, two, that body or -1, n (3), offset [m]."""
    normal = (p[3], p[4], p[5])
    if p[2] >= 0.0:
        normal = rotate(matrix_of(attitude, int(p[2])), normal)
    x = apart(position, int(p[0]), int(p[1]))
    value: float = rounded(dot(normal, x) - p[6], sqrt(dot(x, x)))
    return value


@jit(EVENT)
def escape(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the smaller of r/distance - 1 and the square of v over the speed of escape, less 1.

    Both are relative to the barycentre of the other bodies; p: one, masses [kg] (n), G, distance [m].
    """
    one, n = int(p[0]), position.shape[0]
    total, share = 0.0, 0.0
    for k in range(n):
        total += p[1 + k]
    share = total / (total - p[1 + one])  # from the barycentre of all to that of the others
    x = (share * position[one, 0], share * position[one, 1], share * position[one, 2])
    v = (share * velocity[one, 0], share * velocity[one, 1], share * velocity[one, 2])
    r = sqrt(dot(x, x))
    value: float = min(r / p[n + 2] - 1.0, dot(v, v) * r / (2.0 * p[n + 1] * total) - 1.0)
    return value


@jit()
def in_orbit_frame(p: Array, position: Array, velocity: Array, attitude: Array) -> tuple[Vector, Vector, Vector]:
    """Return the axes of a body in the frame of its orbit: away from the other body, along the motion, and the pole."""
    one, two = int(p[0]), int(p[1])
    x, v = apart(position, one, two), apart(velocity, one, two)
    pole = cross(x, v)
    along = cross(pole, x)
    r = matrix_of(attitude, one)
    away, forward, up = rotate_back(r, x), rotate_back(r, along), rotate_back(r, pole)
    a, b, c = sqrt(dot(x, x)), sqrt(dot(along, along)), sqrt(dot(pole, pole))
    return (
        (away[0] / a, away[1] / a, away[2] / a),
        (forward[0] / b, forward[1] / b, forward[2] / b),
        (up[0] / c, up[1] / c, up[2] / c),
    )


@jit(EVENT)
def roll(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the roll, Euler angles 1-2-3 of the body in the frame of its orbit, less value; p: one, two, value."""
    _, forward, up = in_orbit_frame(p, position, velocity, attitude)
    value: float = from_value(atan2(-forward[2], up[2]), p[2])
    return value


@jit(EVENT)
def pitch(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the pitch, Euler angles 1-2-3 of the body in the frame of its orbit, less value; p: one, two, value."""
    away, _, _ = in_orbit_frame(p, position, velocity, attitude)
    value: float = asin(min(1.0, max(-1.0, away[2]))) - p[2]
    return value


@jit(EVENT)
def yaw(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the yaw, Euler angles 1-2-3 of the body in the frame of its orbit, less value; p: one, two, value."""
    away, _, _ = in_orbit_frame(p, position, velocity, attitude)
    value: float = from_value(atan2(-away[1], away[0]), p[2])
    return value


@jit(EVENT)
def longitude(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the longitude of body one in the axes of body two, less value; p: one, two, value [rad]."""
    x = rotate_back(matrix_of(attitude, int(p[1])), apart(position, int(p[0]), int(p[1])))
    value: float = from_value(atan2(x[1], x[0]), p[2])
    return value


@jit(EVENT)
def latitude(p: Array, t: float, position: Array, velocity: Array, attitude: Array, spin: Array) -> float:
    """Return the latitude of body one in the axes of body two, less value; p: one, two, value [rad]."""
    x = rotate_back(matrix_of(attitude, int(p[1])), apart(position, int(p[0]), int(p[1])))
    value: float = asin(min(1.0, max(-1.0, x[2] / sqrt(dot(x, x))))) - p[2]
    return value
