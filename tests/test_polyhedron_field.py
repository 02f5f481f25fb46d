"""The field of polyhedra: closed forms, symmetry, what is on edges and far away; the pair with a point."""

import pickle
from itertools import product
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.constants import G
from binaryast.errors import EndWarning, InputError, UnitError
from tests import solids

DENSITY = 2000 * u.kg / u.m**3
HALF = np.array([300.0, 200.0, 150.0])


def body(solid: solids.Solid, scale: float = 1.0, name: str = "rock") -> ba.RigidBody:
    vertices, faces = solid
    return ba.RigidBody(name, ba.Polyhedron(vertices * scale * u.m, faces), density=DENSITY)


def brick() -> ba.RigidBody:
    return body(solids.box(-HALF, HALF))


def prism(x: np.ndarray) -> tuple[float, np.ndarray]:
    """U and dU/dx (3,) of the brick by the closed form of a prism, at a point in no plane of its faces."""
    energy, gradient = 0.0, np.zeros(3)
    for signs in product((-1, 1), repeat=3):
        d = signs * HALF - x
        r, sign = np.linalg.norm(d), np.prod(signs)
        for i in range(3):
            a, b, c = d[i], d[(i + 1) % 3], d[(i + 2) % 3]
            logarithm, angle = np.log(a + r), np.arctan(b * c / (a * r))
            energy -= sign * (b * c * logarithm - a * a / 2 * angle)
            gradient[(i + 1) % 3] += sign * c * logarithm
            gradient[(i + 2) % 3] += sign * b * logarithm
            gradient[i] -= sign * a * angle
    return G * 2000 * energy, G * 2000 * gradient


def test_a_brick_has_the_closed_form_of_a_prism_inside_and_outside() -> None:
    random = np.random.default_rng(2)
    points = random.uniform(-2, 2, (200, 3)) * HALF
    field = ba.polyhedron_field(brick(), points * u.m)
    for i, x in enumerate(points):
        energy, gradient = prism(x)
        assert field.potential[i].value == pytest.approx(energy, rel=1e-13)
        np.testing.assert_allclose(-field.attraction[i].value, gradient, atol=1e-13 * np.linalg.norm(gradient))


def test_the_laplacian_is_that_of_the_density() -> None:
    """4 pi G rho inside, 0 outside, half of it on a face, a quarter on an edge of a brick, an eighth at a corner."""
    inside, outside, face, edge, corner = 0.5 * HALF, 1.5 * HALF, HALF * [1, 0.3, 0.2], HALF * [1, 1, 0.2], HALF
    points = np.array([inside, outside, face, edge, corner])
    field = ba.polyhedron_field(brick(), points * u.m)
    full = 4 * np.pi * G * 2000
    np.testing.assert_allclose(field.laplacian.value / full, [1, 0, 1 / 2, 1 / 4, 1 / 8], atol=1e-14)
    trace = np.trace(field.hessian.value[:3], axis1=1, axis2=2)
    np.testing.assert_allclose(trace / full, [1, 0, 1 / 2], atol=1e-14)


def test_the_second_derivatives_are_those_of_the_attraction() -> None:
    rock = body(solids.icosphere(1), 300)
    random = np.random.default_rng(4)
    points = random.uniform(-500, 500, (20, 3))
    field = ba.polyhedron_field(rock, points * u.m)
    for i, e in enumerate(np.eye(3)):
        at = [ba.polyhedron_field(rock, (points + s * 0.01 * e) * u.m).attraction.value for s in (1, -1)]
        np.testing.assert_allclose(-(at[0] - at[1]) / 0.02, field.hessian.value[:, i], rtol=0, atol=2e-13)


def test_it_is_continuous_and_finite_on_faces_edges_and_vertices() -> None:
    rock = body(solids.torus(), 100)
    mesh = (rock.shape.vertices.value - rock.shape.centre) @ rock.turn
    triangles = mesh[rock.shape.faces][::7]
    for places in (triangles.mean(axis=1), triangles[:, :2].mean(axis=1), triangles[:, 0]):
        field = ba.polyhedron_field(rock, places * u.m)
        near = ba.polyhedron_field(rock, (places + 1e-9) * u.m)
        np.testing.assert_allclose(near.potential, field.potential, rtol=1e-11)
        size = np.linalg.norm(field.attraction, axis=1).max().value
        np.testing.assert_allclose(near.attraction.value, field.attraction.value, atol=1e-9 * size)
        assert np.all(np.isfinite(field.hessian))
        assert np.all(np.isfinite(field.laplacian))


def test_far_away_it_keeps_its_digits() -> None:
    """A cube's quadrupole vanishes, so at r it is a point but for (size/r)^4; round-off grows as r/size only."""
    cube = body(solids.box((-1, -1, -1), (1, 1, 1)))
    direction = np.array([0.48, -0.6, 0.64])
    for far, tolerance in ((1e4, 3e-12), (1e6, 3e-10)):
        field = ba.polyhedron_field(cube, direction * far * u.m)
        assert field.potential.value == pytest.approx(-cube.gm.value / far, rel=tolerance)
        np.testing.assert_allclose(
            field.attraction.value, -cube.gm.value / far**2 * direction, atol=tolerance * cube.gm.value / far**2
        )
        tensor = cube.gm.value / far**3 * (np.eye(3) - 3 * np.outer(direction, direction))
        np.testing.assert_allclose(field.hessian.value, tensor, atol=tolerance * cube.gm.value / far**3)


def test_spheres_converge_to_a_point_with_the_order_of_the_mesh() -> None:
    """Of icospheres of equal mass: what the mesh has beside a monopole falls with the square of its edges."""
    at = 1.5 * np.array([0.36, 0.48, 0.8])
    errors = []
    for divisions in (3, 4, 5):
        vertices, faces = solids.icosphere(divisions)
        sphere = ba.RigidBody("s", ba.Polyhedron(vertices * u.m, faces), mass=8000 * u.kg)
        errors.append(abs(ba.polyhedron_field(sphere, at * u.m).potential.value * 1.5 / sphere.gm.value + 1))
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.1)
    assert np.log2(errors[1] / errors[2]) == pytest.approx(2, abs=0.03)


def test_layers_are_superposed() -> None:
    outer, inner = ba.Polyhedron(*_mesh(solids.box(-HALF, HALF))), ba.Polyhedron(*_mesh(solids.icosphere(1), 100))
    layered = ba.RigidBody("both", ba.Layered(outer, inner, density_ratio=2.5), mass=1e11 * u.kg)
    around = 1e11 / (outer.volume + 1.5 * inner.volume)
    parts = [
        ba.RigidBody("outer", outer, density=around * u.kg / u.m**3),
        ba.RigidBody("inner", inner, density=1.5 * around * u.kg / u.m**3),
    ]
    points = np.array([[0, 0, 20], [120, 130, 10], [500, 0, 100.0]])
    field = ba.polyhedron_field(layered, points * u.m)
    one, two = (
        ba.polyhedron_field(part, (points @ layered.turn.T + layered.offset.value - part.offset.value) * u.m)
        for part in parts
    )
    np.testing.assert_allclose(field.potential, one.potential + two.potential, rtol=1e-13)
    np.testing.assert_allclose(field.laplacian.value / (4 * np.pi * G * around), [2.5, 1, 0], atol=1e-13)


def _mesh(solid: solids.Solid, scale: float = 1.0) -> tuple:
    return solid[0] * scale * u.m, solid[1]


def test_threads_change_nothing() -> None:
    rock = body(solids.icosphere(2), 300)
    points = np.random.default_rng(5).uniform(-500, 500, (101, 3)) * u.m
    one, three = ba.polyhedron_field(rock, points), ba.polyhedron_field(rock, points, threads=3)
    np.testing.assert_array_equal(one.hessian, three.hessian)
    np.testing.assert_array_equal(one.attraction, three.attraction)


def test_one_point_none_and_wrong_ones() -> None:
    rock = brick()
    assert ba.polyhedron_field(rock, [1, 2, 3] * u.km).attraction.shape == (3,)
    assert ba.polyhedron_field(rock, [1, 2, 3] * u.km).hessian.shape == (3, 3)
    assert ba.polyhedron_field(rock, np.zeros((0, 3)) * u.km).potential.shape == (0,)
    assert pickle.loads(pickle.dumps(ba.polyhedron_field(rock, [1, 2, 3] * u.km))).potential.unit == "m2 / s2"
    with pytest.raises(InputError, match="points: expected an array of shape"):
        ba.polyhedron_field(rock, [1, 2] * u.m)
    with pytest.raises(UnitError, match="no unit"):
        ba.polyhedron_field(rock, [1, 2, 3])
    with pytest.raises(InputError, match="threads: expected a whole number"):
        ba.polyhedron_field(rock, [1, 2, 3] * u.m, threads=0)
    ball = ba.RigidBody("ball", ba.Sphere(1 * u.m), density=DENSITY)
    with pytest.raises(InputError, match="got ball, a Sphere"):
        ba.polyhedron_field(ball, [1, 2, 3] * u.m)
    with pytest.raises(InputError, match="expected a body of a Polyhedron"):
        ba.polyhedron_field(ball.shape, [1, 2, 3] * u.m)


def grain(mass: float = 1.0) -> ba.RigidBody:
    return ba.RigidBody("grain", ba.Point(), mass=mass * u.kg)


@pytest.mark.parametrize("other", [grain(3), ba.RigidBody("s", ba.Sphere(1 * u.m), mass=3 * u.kg)])
def test_the_pair_has_the_field_of_the_polyhedron(other: ba.RigidBody) -> None:
    rock, at = body(solids.torus(), 100), np.array([310.0, -200.0, 150.0])
    field = ba.polyhedron_field(rock, at * u.m)
    pair = ba.System([rock, other], gravity=ba.PolyhedronPoint()).mutual_gravity(at * u.m)
    assert pair.energy.value == pytest.approx(3 * field.potential.value, rel=1e-15)
    np.testing.assert_allclose(pair.force_on_secondary.value, 3 * field.attraction.value, rtol=1e-15)
    assert not np.any(pair.torque_on_secondary.value)


def test_a_point_inside_is_named() -> None:
    for bodies in ([brick(), grain()], [grain(), brick()]):
        system = ba.System(bodies, gravity=ba.PolyhedronPoint())
        assert np.isfinite(system.mutual_gravity([300, 10, 10] * u.m).energy)  # on a face
        with pytest.raises(InputError, match="the point is inside the polyhedron"):
            system.mutual_gravity([290, 10, 10] * u.m)


def test_other_bodies_are_refused() -> None:
    two = [brick(), body(solids.icosphere(1), 50, "moon")]
    with pytest.raises(InputError, match=r"got rock, a Polyhedron, and moon, a Polyhedron: .*Multipole"):
        ba.System(two, gravity=ba.PolyhedronPoint())
    with pytest.raises(InputError, match="PolyhedronPoint: expected a Polyhedron"):
        ba.System([grain(), ba.RigidBody("s", ba.Sphere(1 * u.m), mass=1 * u.kg)], gravity=ba.PolyhedronPoint())


def test_a_grain_that_lands_on_a_corner_of_the_relief() -> None:
    """The brick's corners reach out of the ellipsoid that stands for its surface: the point enters them first."""
    system = ba.System([brick(), grain()], gravity=ba.PolyhedronPoint())
    start = 1.3 * HALF
    state = ba.RelativeState(
        X=start * u.m, V=-0.1 * HALF / 300 * u.m / u.s, R=np.eye(3), R2=np.eye(3), V2=[0, 0, 0] * u.m / u.s,
        Omega=[0, 0, 0] * u.rad / u.s, Omega2=[0, 0, 0] * u.rad / u.s,
    ).to_state(system)  # fmt: skip
    with pytest.warns(EndWarning, match="the point is inside the polyhedron"):
        run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(10 * u.s))
    assert run.status == "failed"
    assert np.all(np.abs(run.si.position[-1, 1] - run.si.position[-1, 0]) > HALF * 0.98)


def test_an_orbit_conserves_its_energy_and_is_kept_in_a_file(tmp_path: Path) -> None:
    moon = ba.RigidBody("moon", ba.Sphere(80 * u.m), density=DENSITY)
    system = ba.System([brick(), moon], gravity=ba.PolyhedronPoint())
    state = ba.State.circular_orbit(system, separation=1 * u.km, spins=[9 * u.h, "synchronous"])
    run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(20 * u.s), save_every=1 * u.h)
    assert run.status == "completed"
    run.write(tmp_path / "run.h5")
    again = ba.Trajectory.read(tmp_path / "run.h5")
    assert isinstance(again.system.gravity, ba.PolyhedronPoint)
    assert run.max_energy_error_over_potential < 1e-3
    half = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(10 * u.s))
    order = np.log2(run.max_energy_error.value / half.max_energy_error.value)
    assert order == pytest.approx(2, abs=0.1)


def test_a_scenario_can_ask_for_it(tmp_path: Path) -> None:
    vertices, faces = solids.box(-HALF, HALF)
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    (tmp_path / "brick.obj").write_text("\n".join(lines))
    (tmp_path / "mine.toml").write_text(
        """
        [[bodies]]
        name = "rock"
        shape = { type = "Polyhedron", file = "brick.obj", unit = "m" }
        density = "2000 kg / m3"

        [[bodies]]
        name = "moon"
        shape = { type = "Sphere", radius = "20 m" }
        density = "2000 kg / m3"

        [gravity]
        type = "PolyhedronPoint"

        [state]
        type = "circular_orbit"
        separation = "1 km"
        spins = ["9 h", "synchronous"]

        [run]
        duration = "1 d"
        step = "20 s"
        """
    )
    system = ba.scenario.load(tmp_path / "mine.toml").system
    assert isinstance(system.gravity, ba.PolyhedronPoint)
    assert np.isfinite(system.mutual_gravity([1, 0, 0] * u.km).energy)
