"""Two polyhedra by surface integrals: rules, exact derivatives, values known otherwise, bad input, runs, files."""

import pickle
from math import factorial

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast import clusters
from binaryast.errors import InputError, ScenarioError
from binaryast.gravity import Gravity
from binaryast.scenario import loads
from tests.solids import Solid, box, icosphere
from tests.test_polyhedron import SHAPES, with_shapes

X = np.array([9.0, 1.5, -1.0])  # m
R = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()


def rough(divisions: int, axes: tuple[float, float, float], seed: int) -> Solid:
    """Return a body that nothing is symmetric about, of these semi-axes [m]."""
    vertices, faces = icosphere(divisions)
    lumps = 1 + 0.05 * np.random.default_rng(seed).normal(size=(len(vertices), 1))
    return vertices * lumps * axes, faces


def body(name: str, solid: Solid, **mass: u.Quantity) -> ba.RigidBody:
    vertices, faces = solid
    return ba.RigidBody(name, ba.Polyhedron(vertices * u.m, faces), **(mass or {"density": 2000 * u.kg / u.m**3}))


PRIMARY = body("A", rough(1, (5.0, 4.0, 3.0), 1))
SECONDARY = body("B", rough(1, (3.0, 2.5, 2.0), 2))


def values(gravity: Gravity, x: np.ndarray = X, r: np.ndarray = R) -> np.ndarray:
    return np.array(ba.System([PRIMARY, SECONDARY], gravity).attraction(x, r))


def apart(one: np.ndarray, two: np.ndarray, x: np.ndarray = X) -> float:
    """Return the largest difference of U, dU/dX and M, as `PolyhedronPair` measures them."""
    force = np.linalg.norm(two[1:4])
    moment = np.linalg.norm(one[4:] - two[4:]) / force / np.linalg.norm(x)
    return max(abs(one[0] / two[0] - 1), np.linalg.norm(one[1:4] - two[1:4]) / force, moment)


@pytest.mark.parametrize("degree", clusters.ORBITS)
def test_the_order_conditions_of_the_rules(degree: int) -> None:
    """The integrals of s^i t^j over the triangle, over its area, are 2 i! j!/(i + j + 2)!."""
    weights, s, t = clusters.face_rule(degree).T
    assert np.all(weights > 0)
    assert np.all((s > 0) & (t > 0) & (s + t < 1))
    for i in range(degree + 2):
        for j in range(degree + 2 - i):
            error = weights @ (s**i * t**j) - 2 * factorial(i) * factorial(j) / factorial(i + j + 2)
            assert abs(error) < 1e-16 or i + j > degree
    powers = [(i, degree + 1 - i) for i in range(degree + 2)]
    left = [weights @ (s**i * t**j) - 2 * factorial(i) * factorial(j) / factorial(degree + 3) for i, j in powers]
    assert np.abs(left).max() > 1e-8


@pytest.mark.parametrize("degree", clusters.ORBITS)
def test_a_reduced_rule_keeps_the_integrals(degree: int) -> None:
    random = np.random.default_rng(3)
    for nodes in (random.normal(size=(400, 3)), random.normal(size=(400, 3)) * [1, 1, 0]):  # in space, in a plane
        rule = clusters.Rule(nodes, random.normal(size=(400, 3)))
        small = clusters.reduced(rule, degree)
        assert len(small.nodes) == (degree + 1) * (degree + 2) // 2 * ((degree + 3) / 3 if nodes[:, 2].any() else 1)
        for power in ((0, 0, 0), (degree, 0, 0), (1, degree - 1, 0), (2, 2, degree - 4)):
            one, two = (np.prod(part.nodes**power, axis=1) @ part.weights for part in (rule, small))
            scale = np.abs(np.prod(nodes**power, axis=1)).sum()
            np.testing.assert_allclose(two, one, atol=1e-11 * scale + 1e-13)


def test_near_contact_as_the_sum_of_point_masses() -> None:
    """Of mascons on a grid, whose error falls with the square of its cells, or nearly."""
    x = 0.8 * X  # 3 % from contact
    exact = values(ba.PolyhedronPair(1e-8), x)
    errors = []
    for count in (1000, 8000):
        filled = [ba.RigidBody(b.name, ba.mascons(b.shape, count=count), mass=b.mass) for b in (PRIMARY, SECONDARY)]
        assert all(np.allclose(f.turn, b.turn, atol=1e-9) for f, b in zip(filled, (PRIMARY, SECONDARY), strict=True))
        errors.append(apart(np.array(ba.System(filled, ba.PointPairs()).attraction(x, R)), exact, x))
    assert errors[0] < 4e-3
    assert errors[0] / errors[1] > 2.5


@pytest.mark.parametrize("accuracy", [1e-2, 1e-4, 1e-6, 1e-8])
@pytest.mark.parametrize("distance", [0.8, 0.9, 1.5, 4.0])
def test_the_accuracy_is_kept(accuracy: float, distance: float) -> None:
    x = X * distance
    assert apart(values(ba.PolyhedronPair(accuracy), x), values(ba.PolyhedronPair(1e-10), x), x) < accuracy


@pytest.mark.parametrize("accuracy", [1e-2, 1e-3, 1e-5])
def test_gradient_and_moment_are_exact_derivatives_whatever_the_accuracy(accuracy: float) -> None:
    """Where rules give way to others too: along a line that crosses many such places."""
    system = ba.System([PRIMARY, SECONDARY], ba.PolyhedronPair(accuracy))
    h = 1e-4
    for distance in np.linspace(0.8, 1.6, 12):
        x = X * distance
        exact = np.array(system.attraction(x, R))
        for i, e in enumerate(np.eye(3)):
            far, near = (
                system.attraction(x + k * h * e, R)[0] - system.attraction(x - k * h * e, R)[0] for k in (2, 1)
            )
            assert (8 * near - far) / (12 * h) == pytest.approx(exact[1 + i], abs=1e-8 * np.linalg.norm(exact[1:4]))
            turns = [Rotation.from_rotvec(k * h * e).as_matrix() @ R for k in (2, 1, -1, -2)]
            u2, u1, v1, v2 = (system.attraction(x, turn)[0] for turn in turns)
            slope = (8 * (u1 - v1) - (u2 - v2)) / (12 * h)
            assert slope == pytest.approx(exact[4 + i], abs=1e-8 * np.linalg.norm(exact[1:4]) * np.linalg.norm(x))


@pytest.mark.parametrize("degree", [2, 4, 8])
def test_the_multipole_comes_near_with_distance(degree: int) -> None:
    errors = []
    for distance in (3.0, 5.0):
        x = X * distance
        two, one = (values(gravity, x)[1:4] for gravity in (ba.PolyhedronPair(1e-11), ba.Multipole(degree)))
        errors.append(np.linalg.norm(one - two) / np.linalg.norm(two))
    assert np.log(errors[0] / errors[1]) / np.log(5 / 3) == pytest.approx(degree + 1, abs=0.7)


def test_layers_are_added_up() -> None:
    """A hollow is the outer body less the inner one; the masses make the sum."""
    outer, inner = (ba.Polyhedron(v * u.m, f) for v, f in (box((-5, -4, -3), (5, 4, 3)), box((-2, -2, -1), (3, 1, 2))))
    body = ba.RigidBody("shell", ba.Layered(outer, inner, density_ratio=0), mass=1e6 * u.kg)
    x, r = np.array([9.0, 2.0, 1.0]), np.eye(3)
    whole = np.array(ba.System([body, SECONDARY], ba.PolyhedronPair(1e-10)).attraction(x, r))
    solid = [ba.RigidBody("p", s, density=2000 * u.kg / u.m**3) for s in (outer, inner)]
    u1, u2 = (
        ba.System([p, SECONDARY], ba.PolyhedronPair(1e-10)).attraction(
            p.turn.T @ (body.offset.value + body.turn @ x - p.offset.value), p.turn.T @ body.turn @ r
        )[0]
        for p in solid
    )
    assert whole[0] == pytest.approx((u1 - u2) * 500 / (outer.volume - inner.volume), rel=1e-9)


def test_on_several_cores_it_is_the_same() -> None:
    for distance in (0.8, 1.5, 10.0):
        x = X * distance
        one, two = (values(ba.PolyhedronPair(1e-5, parallel=parallel), x) for parallel in (False, True))
        assert apart(two, one, x) < 1e-12


def test_a_run_conserves_energy_with_the_square_of_the_step() -> None:
    """At an accuracy so low that a potential with jumps would show them."""
    system = ba.System([PRIMARY, SECONDARY], ba.PolyhedronPair(1e-2))
    state = ba.State.from_elements(
        system, semi_major_axis=12 * u.m, eccentricity=0.2, spins=[4 * u.h, [1e-4, 2e-4, 6e-4] * u.rad / u.s]
    )
    errors = []
    for step in (40, 20):
        run = ba.propagate(system, state, duration=4 * u.h, integrator=ba.LGVI(step * u.s))
        assert run.status == "completed"
        assert run.max_relative_angular_momentum_error < 1e-13
        errors.append(run.max_energy_error_over_potential)
    assert errors[1] < 1e-5
    assert errors[0] / errors[1] == pytest.approx(4, rel=0.1)


def test_joined_to_a_multipole_far_away() -> None:
    near, gravity = (
        ba.PolyhedronPair(1e-6),
        ba.Adaptive(accuracy=1e-5, near=ba.PolyhedronPair(1e-6), far=ba.Multipole(6)),
    )
    begin, end = gravity.interval(PRIMARY, SECONDARY).value
    for distance, model in ((0.9 * begin, near), (1.1 * end, ba.Multipole(6))):
        x = X * distance / np.linalg.norm(X)
        np.testing.assert_array_equal(values(gravity, x), values(model, x))
    x = X * (begin + end) / 2 / np.linalg.norm(X)
    assert apart(values(gravity, x), values(near, x), x) < 1e-4
    with pytest.raises(InputError, match="the surfaces of A and B meet"):
        ba.System([PRIMARY, SECONDARY], gravity).mutual_gravity([7, 0, 0] * u.m)


def test_bodies_that_meet_are_refused() -> None:
    system = ba.System([PRIMARY, SECONDARY], ba.PolyhedronPair())
    for x in ([7.0, 0, 0], [0.1, 0, 0]):
        with pytest.raises(InputError, match=r"PolyhedronPair: at X = .* m the surfaces of A and B meet"):
            system.mutual_gravity(x * u.m)
    assert system.mutual_gravity([8.9, 0, 0] * u.m).energy.value < 0


@pytest.mark.parametrize("accuracy", [0, 1e-13, 0.1, -1, np.nan, "fine", [1e-3]])
def test_other_accuracies_are_refused(accuracy: object) -> None:
    with pytest.raises(InputError, match="PolyhedronPair: accuracy: expected"):
        ba.PolyhedronPair(accuracy)


def test_other_bodies_and_options_are_refused() -> None:
    ball = ba.RigidBody("ball", ba.Sphere(1 * u.m), mass=1 * u.kg)
    with pytest.raises(InputError, match="PolyhedronPair: ball is not made of polyhedra but of a Sphere: expected"):
        ba.System([PRIMARY, ball], ba.PolyhedronPair())
    core = ba.Layered(PRIMARY.shape, ba.Sphere(0.5 * u.m), density_ratio=2)
    with pytest.raises(InputError, match="PolyhedronPair: core is not made of polyhedra but of a Layered"):
        ba.System([PRIMARY, ba.RigidBody("core", core, mass=1e6 * u.kg)], ba.PolyhedronPair())
    with pytest.raises(InputError, match="PolyhedronPair: parallel: expected True or False, got 2"):
        ba.PolyhedronPair(parallel=2)


SCENARIO = """
[[bodies]]
name = "A"
shape = { type = "Polyhedron", file = "rock.obj", unit = "m" }
density = "2000 kg / m3"

[[bodies]]
name = "B"
shape = { type = "Polyhedron", file = "rock.obj", unit = "m" }
density = "2000 kg / m3"

[gravity]
type = "PolyhedronPair"
accuracy = 1e-4

[state]
type = "circular_orbit"
separation = "16 m"
spins = ["4 h", "synchronous"]

[run]
duration = "10 min"
step = "30 s"
"""


def test_scenarios_files_and_pickles(tmp_path) -> None:
    vertices, faces = rough(0, (5.0, 4.0, 3.0), 1)
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    (tmp_path / "rock.obj").write_text("\n".join(lines))
    entry = loads(SCENARIO, name="x", where="x", folder=tmp_path)
    assert repr(entry.system.gravity) == "PolyhedronPair(accuracy=0.0001, parallel=False)"
    run = ba.propagate(entry.system, entry.state, duration=entry.duration, integrator=entry.integrator)
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    assert repr(again.system.gravity) == repr(pickle.loads(pickle.dumps(entry.system.gravity)))
    x = np.array([16.0, 0, 0])
    assert again.system.attraction(x, np.eye(3)) == entry.system.attraction(x, np.eye(3))
    with pytest.raises(ScenarioError, match="gravity: PolyhedronPair: accuracy: expected a relative error"):
        loads(SCENARIO.replace("1e-4", "1e4"), name="x", where="x", folder=tmp_path)


@with_shapes
def test_real_shapes_against_the_multipole() -> None:
    """1999 KW4 with all its faces at its distance, where degree 12 leaves little."""
    alpha, beta = (
        ba.RigidBody(name, ba.Polyhedron.read(SHAPES / f"a66391_1999kw4_{file}.obj", u.km), density=2 * u.g / u.cm**3)
        for name, file in (("Alpha", "primary"), ("Beta", "secondary"))
    )
    x = np.array([2540.0, 100, 50])
    two, one = (
        np.array(ba.System([alpha, beta], g).attraction(x, R)) for g in (ba.PolyhedronPair(1e-5), ba.Multipole(12))
    )
    assert apart(two, one, x) < 1e-6
