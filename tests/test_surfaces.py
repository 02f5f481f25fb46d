"""What lies on a surface, against closed forms and against a motion followed in inertial axes; its picture."""

import pickle

import astropy.units as u
import numpy as np
import pytest
from matplotlib.figure import Figure
from scipy.special import elliprd

import binaryast as ba
from binaryast.constants import G
from binaryast.errors import InputError
from tests import solids

DENSITY = 2000.0
FASTEST = np.sqrt(4 / 3 * np.pi * G * DENSITY)  # spin at which the equator of a sphere loses its weight

BALL = ba.Polyhedron(solids.icosphere(2)[0] * 120 * u.m, solids.icosphere(2)[1])
CORE = ba.Polyhedron(solids.icosphere(2)[0] * 60 * u.m, solids.icosphere(2)[1])


def alone(axes: tuple[float, float, float], divisions: int, spin: float) -> ba.Surface:
    """Return the surface of an ellipsoid as a mesh that turns about z, with next to nothing far away."""
    vertices, faces = solids.icosphere(divisions)
    shape = ba.Polyhedron(vertices * axes * u.m, faces)
    body = ba.RigidBody("rock", shape, density=DENSITY * u.kg / u.m**3)
    system = ba.System([body, ba.RigidBody("grain", ba.Point(), mass=1e-6 * u.kg)], gravity=ba.PolyhedronPoint())
    state = ba.State(
        position=[[0, 0, 0], [1e3, 0, 0]] * u.km,
        velocity=np.zeros((2, 3)) * u.m / u.s,
        attitude=[body.turn, np.eye(3)],
        spin=[[0, 0, spin], [0, 0, 0]] * u.rad / u.s,
    )
    return ba.surface(system, state)


def expected(axes: tuple[float, float, float], points: np.ndarray, spin: float) -> np.ndarray:
    """Return the slopes [deg] of a homogeneous ellipsoid, whose field inside is linear, below points near it."""
    squares = np.square(axes)
    on = points / np.sqrt(np.sum(points**2 / squares, axis=1))[:, None]
    gm = G * DENSITY * 4 / 3 * np.pi * np.prod(axes)
    rates = [gm * elliprd(squares[(i + 1) % 3], squares[(i + 2) % 3], squares[i]) for i in range(3)]
    acceleration = -np.array(rates) * on + spin**2 * on * [1, 1, 0]
    normals = on / squares
    cosine = -np.sum(acceleration * normals, axis=1)
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(acceleration, normals), axis=1), cosine))


@pytest.mark.parametrize(
    ("axes", "spin"), [((500, 500, 500), 0), ((500, 500, 500), 0.7), ((600, 450, 350), 0), ((600, 450, 350), 0.6)]
)
def test_slopes_of_ellipsoids_are_closed_forms(axes: tuple, spin: float) -> None:
    """The mean error falls as the edges: a face is not tangent above its centre."""
    errors = []
    for divisions in (2, 3, 4):
        found = alone(axes, divisions, spin * FASTEST)
        difference = found.slope.value - expected(axes, found.centres.value, spin * FASTEST)
        errors.append(np.sqrt(np.mean(difference**2)))
    assert errors[-1] < 0.11
    assert np.log2(errors[1] / errors[2]) == pytest.approx(1, abs=0.1)


def test_potential_and_escape_speed_of_a_spinning_sphere() -> None:
    radius, spin = 500.0, 0.7 * FASTEST
    found = alone((radius,) * 3, 4, spin)
    gm = G * DENSITY * 4 / 3 * np.pi * radius**3
    across = np.sum(found.centres.value[:, :2] ** 2, axis=1)
    np.testing.assert_allclose(found.effective_potential.value, -gm / radius - spin**2 * across / 2, rtol=5e-3)
    np.testing.assert_allclose(found.escape_speed.value, np.sqrt(2 * gm / radius - spin**2 * across), rtol=5e-3)
    assert found.areas.sum().value == pytest.approx(4 * np.pi * radius**2, rel=5e-3)
    assert found.gravity.unit == found.acceleration.unit == u.m / u.s**2


def test_a_grain_at_rest_on_too_fast_a_spin() -> None:
    """Beyond the spin at which the equator is weightless slopes exceed 90 deg; beyond sqrt(2) times it, all escapes."""
    found = alone((500, 500, 500), 2, 1.6 * FASTEST)
    equator = np.abs(found.centres.value[:, 2]) < 60
    assert np.all(found.slope.value[equator] > 90)
    assert np.all(found.escape_speed.value[equator] == 0)
    assert np.all(found.escape_speed.value[found.centres.value[:, 2] > 450] > 0)


def tumbling_pair() -> tuple[ba.System, ba.State]:
    vertices, faces = solids.box((-300.0, -200.0, -150.0), (300.0, 200.0, 150.0))
    vertices[4:, 1:] *= 0.6
    rock = ba.RigidBody("rock", ba.Polyhedron(vertices * u.m, faces), density=DENSITY * u.kg / u.m**3)
    moon = ba.RigidBody("moon", ba.Sphere(120 * u.m), density=DENSITY * u.kg / u.m**3)
    system = ba.System([rock, moon], gravity=ba.PolyhedronPoint())
    state = ba.State.circular_orbit(system, separation=700 * u.m, spins=[5 * u.h, "synchronous"])
    spin = state.spin.value.copy()
    spin[0] = [2e-4, -1e-4, 3e-4]
    return system, ba.State(**state.arguments() | {"spin": spin * u.rad / u.s})


@pytest.mark.parametrize("swapped", [False, True])
def test_the_acceleration_is_that_of_a_grain_carried_along(swapped: bool) -> None:
    """In inertial axes: the pull of both bodies, less the acceleration of the place on the face, by differences."""
    system, start = tumbling_pair()
    if swapped:
        arguments = {k: v[::-1] if k in ("position", "velocity", "attitude", "spin") else v
                     for k, v in start.arguments().items()}  # fmt: skip
        system, start = ba.System(system.bodies[::-1], gravity=system.gravity), ba.State(**arguments)
    rock, moon = (1, 0) if swapped else (0, 1)
    run = ba.propagate(system, start, duration=2 * u.s, integrator=ba.LGVI(1 * u.s), save_every=1 * u.s)
    found = ba.surface(system, run[1], "rock")
    position, attitude = run.si.position, run.si.attitude[:, rock]
    places = position[:, rock, None] + np.einsum("nij,fj->nfi", attitude, found.centres.value)
    carried = places[0] - 2 * places[1] + places[2]
    d = places[1] - position[1, moon]
    pull = -system.bodies[moon].si.gm * d / np.linalg.norm(d, axis=1)[:, None] ** 3
    own = ba.polyhedron_field(system.bodies[rock], found.centres).attraction.value
    np.testing.assert_allclose(
        found.acceleration.value, own + (pull - carried) @ attitude[1], atol=1e-6 * np.abs(own).max()
    )


def test_the_tide_has_a_potential_that_vanishes_at_the_mass_centre() -> None:
    system, state = tumbling_pair()
    found = ba.surface(system, state)
    rock, gm = system.primary, system.secondary.si.gm
    x = state.si.attitude[0].T @ (state.si.position[1] - state.si.position[0])
    r = found.centres.value
    force = system.mutual_gravity(x * u.m, np.eye(3)).gradient.value / rock.si.mass
    tide = -gm / np.linalg.norm(r - x, axis=1) + gm / np.linalg.norm(x) + r @ force
    own = ba.polyhedron_field(rock, found.centres).potential.value
    spinning = np.sum(np.cross(state.si.spin[0], r) ** 2, axis=1) / 2
    np.testing.assert_allclose(found.effective_potential.value, own + tide - spinning, rtol=1e-13)


@pytest.mark.parametrize("shape", [ba.Ellipsoid(121 * u.m, 120 * u.m, 119 * u.m), BALL, ba.Layered(BALL, CORE, 2)])
def test_other_kinds_of_neighbours_pull_alike(shape: ba.Shape) -> None:
    """A neighbour that is nearly a sphere does nearly what a sphere does."""
    system, state = tumbling_pair()
    sphere = ba.surface(system, state)
    moon = ba.RigidBody("moon", shape, mass=system.secondary.mass)
    found = ba.surface(ba.System([system.primary, moon], gravity=ba.Multipole(4)), state)
    size = np.abs(sphere.acceleration.value).max()
    np.testing.assert_allclose(found.acceleration.value, sphere.acceleration.value, atol=1e-3 * size)


def test_wrong_input() -> None:
    system, state = tumbling_pair()
    with pytest.raises(InputError, match="moon is a Sphere: expected a Polyhedron"):
        ba.surface(system, state, "moon")
    with pytest.raises(InputError, match="run\\[-1\\]"):
        ba.surface(system, system)
    with pytest.raises(InputError, match=r"expected a ba\.System"):
        ba.surface(state, state)
    with pytest.raises(InputError, match="threads"):
        ba.surface(system, state, threads=1.5)
    third = ba.RigidBody("craft", ba.Point(), mass=1 * u.kg)
    with pytest.raises(InputError, match="it has 2 bodies, the system 3"):
        ba.surface(ba.System([*system.bodies, third], gravity=ba.SecondDegree()), state)


def test_the_picture() -> None:
    found = ba.surface(*tumbling_pair())
    for quantity in ("slope", "gravity", "effective_potential", "escape_speed"):
        figure = ba.plotting.surface(found, quantity, Figure(), views=["+x", "-x", "+y", "-y", "+z", "-z"])
        assert len(figure.axes) == 7
        figure.canvas.draw()
    with pytest.raises(InputError, match="quantity: 'slopes' is not known: did you mean 'slope'"):
        ba.plotting.surface(found, "slopes")
    with pytest.raises(InputError, match="views: 'x' is not known"):
        ba.plotting.surface(found, views=["x"])
    with pytest.raises(InputError, match="views: expected a list"):
        ba.plotting.surface(found, views="+x")
    with pytest.raises(InputError, match=r"expected a ba.Surface"):
        ba.plotting.surface(3)


def test_it_pickles() -> None:
    found = ba.surface(*tumbling_pair())
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.slope, found.slope)
    with pytest.raises(ValueError, match="read-only"):
        again.normals[0] = 0
