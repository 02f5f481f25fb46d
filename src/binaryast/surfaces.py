"""What lies on the surface of a polyhedron: gravity, slope, effective potential and escape speed on each face."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.fields import checked_threads, evaluated
from binaryast.gravity import Gravity, Multipole, PointPairs, SecondDegree
from binaryast.polyhedron_table import Layer, layers_of, normals_of, table_of
from binaryast.shapes import Ellipsoid, Point
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, Indices, brief, quantity
from binaryast.values import Value

ELLIPSOID_DEGREE = 8  # of an ellipsoid's field at the other body's surface


@dataclass(frozen=True, eq=False)
class Surface(Value):
    """What a grain feels at the centre of each face of a polyhedron; vectors are in its body frame.

    Attributes
    ----------
    body : str
        Whose surface it is.
    vertices, faces : Quantity, ndarray
        The mesh (V, 3) about the mass centre [m], and the vertices of each face (F, 3).
    centres, normals, areas : Quantity, ndarray, Quantity
        Centres of the faces (F, 3) [m], outward unit normals (F, 3), areas (F,) [m2].
    acceleration : Quantity
        Effective acceleration (F, 3) [m / s2]: what a grain at rest on the face is accelerated with, seen in the body
        frame: its gravity, the tide of the other bodies, and the inertial accelerations of that frame.
    gravity : Quantity
        Size of the effective acceleration (F,) [m / s2].
    slope : Quantity
        Angle (F,) between the effective acceleration and the inward normal [deg]; above 90 a grain takes off.
    effective_potential : Quantity
        U + tide - |spin x r|^2/2 (F,) [m2 / s2].
    escape_speed : Quantity
        Speed along the outward normal (F,) with which a grain leaves the body for good [m / s].
    """

    body: str
    vertices: Quantity = field(repr=False)
    faces: Indices = field(repr=False)
    centres: Quantity = field(repr=False)
    normals: Floats = field(repr=False)
    areas: Quantity = field(repr=False)
    acceleration: Quantity = field(repr=False)
    slope: Quantity = field(repr=False)
    effective_potential: Quantity = field(repr=False)
    escape_speed: Quantity = field(repr=False)

    def __post_init__(self) -> None:
        self._set(**self.arguments())  # read-only

    @property
    def gravity(self) -> Quantity:
        """Size of the effective acceleration (F,) [m / s2]."""
        return np.linalg.norm(self.acceleration, axis=1)


class Tide(NamedTuple):
    """The potential (F,) and acceleration (F, 3) of other bodies, less those that the mass centre has."""

    potential: Floats
    acceleration: Floats
    torque: Floats  # on the body, in its frame


def surface(system: System, state: State, body: str | int = 0, *, threads: int = 1) -> Surface:
    """Return gravity, slope, effective potential and escape speed on the faces of a body that rotates among others.

    Parameters
    ----------
    system : System
        The bodies.
    state : State
        Where they are and how they turn; a row of a run is one, such as ``run[-1]``.
    body : str or int
        Whose surface: a `binaryast.Polyhedron`, or a `binaryast.Layered` with two of them; the primary by default.
    threads : int
        How many threads share the work: that of F faces takes F^2 times some 25 ns.

    Returns
    -------
    Surface

    Raises
    ------
    InputError
        For a body that has no faces, a state of another number of bodies, or a number of threads below 1.

    Notes
    -----
    In the body frame, with spin w and r from the mass centre, the effective acceleration is

        -dU/dr + tide - w x (w x r) - (dw/dt) x r.

    U is the exact field of the polyhedron. The tide of another body is its acceleration at r less that of the mass
    centre, which is the one of the system's gravity. The field at r of another Polyhedron is exact, that of points and
    spheres that of points, of an `Ellipsoid` that of its moments to degree 8, and of all others MacCullagh's. The last
    term, Euler's, has dw/dt by the equations of rigid rotation with the torque of the system's gravity. It has no
    potential, so that it is in the acceleration and the slope only. The tide's potential is zero at the mass centre.

    The escape speed is that of D. J. Scheeres et al., Icarus 121 (1996) 67 and Scheeres, Orbital Motion in Strongly
    Perturbed Environments (Springer 2012), of the body alone, without the others: a
    grain leaves along the normal n and has the velocity v n + w x r, whose energy is to be that of rest far away,

        v = -n.(w x r) + sqrt((n.(w x r))^2 + 2 max(-U, GM/r) - |w x r|^2),

    and 0 where a grain at rest on the face is faster than that. Gravity and slope are taken at the centre of a face,
    which is not quite where a curved surface is parallel to it: for a mesh of such a surface the error of the slope
    falls as the length of the edges.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]] * u.km
    >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    >>> rock = ba.RigidBody("rock", ba.Polyhedron(corners, faces), density=2000 * u.kg / u.m**3)
    >>> moon = ba.RigidBody("moon", ba.Sphere(100 * u.m), density=2000 * u.kg / u.m**3)
    >>> system = ba.System([rock, moon], gravity=ba.PolyhedronPoint())
    >>> state = ba.State.circular_orbit(system, separation=4 * u.km, spins=[5 * u.h, "synchronous"])
    >>> found = ba.surface(system, state)
    >>> print(found.slope[:2].round(1), found.escape_speed[:2].round(3))
    [5.6 5.6] deg [0.768 0.768] m / s
    """
    index, layers = _checked(system, state, body)
    own = system.bodies[index]
    mesh = layers[0].shape
    vertices = (mesh.vertices.value - own.shape.centre) @ own.turn
    triangles = vertices[mesh.faces]
    normals, areas2 = normals_of(triangles)
    centres, spin = triangles.mean(axis=1), state.si.spin[index]
    rows = evaluated(table_of(own, layers), centres, checked_threads(threads, "surface"))
    tide = _tide(system, state, index, centres)
    velocity = np.cross(spin, centres)
    acceleration = tide.acceleration - rows[:, 1:4] - np.cross(spin, velocity)
    acceleration -= np.cross(_spin_rate(own, spin, tide.torque), centres)
    return Surface(
        body=own.name,
        vertices=quantity(vertices, "m"),
        faces=mesh.faces,
        centres=quantity(centres, "m"),
        normals=normals,
        areas=quantity(areas2 / 2, "m2"),
        acceleration=quantity(acceleration, "m / s2"),
        slope=quantity(_slope(acceleration, normals), "deg"),
        effective_potential=quantity(rows[:, 0] + tide.potential - np.sum(velocity**2, axis=1) / 2, "m2 / s2"),
        escape_speed=quantity(_escape_speed(rows[:, 0], own.si.gm, centres, normals, velocity), "m / s"),
    )


def _checked(system: Any, state: Any, body: str | int) -> tuple[int, list[Layer]]:
    """Return the index of the body and its layers, after a look at what was given."""
    if not isinstance(system, System):
        raise InputError(f"surface: system: expected a ba.System, got {brief(system)}")
    if not isinstance(state, State):
        raise InputError(f"surface: state: expected a ba.State, such as a row run[-1] of a run, got {brief(state)}")
    if len(state.si.position) != len(system.bodies):
        raise InputError(f"surface: state: it has {len(state.si.position)} bodies, the system {len(system.bodies)}")
    index = system.index(body)
    own = system.bodies[index]
    layers = layers_of(own)
    if layers is None:
        raise InputError(
            f"surface: {own.name} is a {type(own.shape).__name__}: expected a Polyhedron, or a Layered of two"
        )
    return index, layers


def _tide(system: System, state: State, index: int, centres: Floats) -> Tide:
    """Return the tide of all other bodies at points (F, 3) of the body frame, and their torque."""
    position, _, attitude, _ = state.si
    potential, acceleration, torque = np.zeros(len(centres)), np.zeros_like(centres), np.zeros(3)
    own = system.bodies[index]
    for pair in system.pairs:
        if index not in pair[:2]:
            continue
        other = pair.secondary if pair.primary == index else pair.primary
        to_other = attitude[other].T @ attitude[index]  # body frame -> the other's
        origin = attitude[other].T @ (position[index] - position[other])
        u, slope = _field_of(system.bodies[other], origin + centres @ to_other.T)
        centre_u, _ = _field_of(system.bodies[other], origin[None])
        force, turning = _force_and_torque(system, state, pair, index)
        pull = force / own.si.mass  # of the mass centre
        acceleration += -slope @ to_other - pull
        potential += u - centre_u[0] + centres @ pull
        torque += turning
    return Tide(potential, acceleration, torque)


def _force_and_torque(system: System, state: State, pair: Any, index: int) -> tuple[Floats, Floats]:
    """Return the force and the torque of a pair's gravity on one of its bodies, in that body's frame."""
    position, _, attitude, _ = state.si
    to_primary = attitude[pair.primary].T
    x = to_primary @ (position[pair.secondary] - position[pair.primary])
    r = to_primary @ attitude[pair.secondary]
    values = np.array(system.attraction(x, r, pair))
    gradient, moment = values[1:4], values[4:]
    if index == pair.primary:
        return gradient, np.cross(x, gradient) + moment
    return -gradient @ r, -moment @ r


def _field_of(body: RigidBody, points: Floats) -> tuple[Floats, Floats]:
    """Return a body's potential (P,) and its gradient (P, 3) at points (P, 3) of its frame, outside of it."""
    layers = layers_of(body)
    if layers is not None:
        rows = evaluated(table_of(body, layers), points)
        return rows[:, 0], rows[:, 1:4]
    grain = RigidBody("grain", Point(), mass=Quantity(1, "kg"))
    gravity = _model_for(body)
    parameters = gravity.parameters(grain, body)
    potential = gravity.potential_for(parameters)
    values = np.array([potential(parameters, *point, 1, 0, 0, 0, 1, 0, 0, 0, 1) for point in points])
    return values[:, 0], values[:, 1:4]


def _model_for(body: RigidBody) -> Gravity:
    """Return the gravity by which a body that is no polyhedron attracts a grain."""
    if body.points is not None:
        return PointPairs()
    return Multipole(ELLIPSOID_DEGREE) if isinstance(body.shape, Ellipsoid) else SecondDegree()


def _spin_rate(body: RigidBody, spin: Floats, torque: Floats) -> Floats:
    """Return dw/dt by Euler's equations: I dw/dt = torque + (I w) x w."""
    moments = body.si.moments
    return np.asarray((torque + np.cross(moments * spin, spin)) / moments)


def _slope(acceleration: Floats, normals: Floats) -> Floats:
    """Return the angle between -acceleration and the normal [deg], to round-off also near 0; 0 where it vanishes."""
    across = np.linalg.norm(np.cross(acceleration, normals), axis=1)
    return np.asarray(np.degrees(np.arctan2(across, -np.sum(acceleration * normals, axis=1))))


def _escape_speed(u: Floats, gm: float, centres: Floats, normals: Floats, velocity: Floats) -> Floats:
    """Return the speed along the normal with which a grain escapes; velocity is w x r."""
    depth = 2 * np.maximum(-u, gm / np.linalg.norm(centres, axis=1)) - np.sum(velocity**2, axis=1)
    along = np.sum(normals * velocity, axis=1)
    return np.asarray(np.where(depth > 0, np.sqrt(along**2 + np.maximum(depth, 0)) - along, 0.0))
