"""What every gravity model must pass. To add a model, add a line to `MODELS`."""

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from tests import solids


@ba.pair_potential
def repelled(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
    """A user's own: a monopole with an inverse cube besides."""
    r = (x * x + y * y + z * z) ** 0.5
    w = p[0] / r**3 + 3 * p[1] / r**5
    return -p[0] / r - p[1] / r**3, w * x, w * y, w * z, 0.0, 0.0, 0.0


def ellipsoids() -> list[ba.RigidBody]:
    return [
        ba.RigidBody("A", ba.Ellipsoid(420 * u.m, 400 * u.m, 330 * u.m), density=2400 * u.kg / u.m**3),
        ba.RigidBody("B", ba.Ellipsoid(250 * u.m, 180 * u.m, 120 * u.m), density=2000 * u.kg / u.m**3),
    ]


def clouds() -> list[ba.RigidBody]:
    random = np.random.default_rng(8)
    return [
        ba.RigidBody(n, ba.PointCloud(random.normal(size=(k, 3)) * 150 * u.m, random.uniform(1, 2, k)), mass=m * u.kg)
        for n, k, m in (("A", 17, 6e11), ("B", 9, 7e10))
    ]


def dumbbells() -> list[ba.RigidBody]:
    return [
        ba.RigidBody("A", ba.Dumbbell(500 * u.m, 100 * u.m), mass=6e11 * u.kg),
        ba.RigidBody("B", ba.Dumbbell(300 * u.m, 60 * u.m), mass=6e10 * u.kg),
    ]


def polyhedra() -> list[ba.RigidBody]:
    random = np.random.default_rng(4)
    bodies = []
    for name, size, mass in (("A", [420, 400, 330], 6e11), ("B", [250, 180, 120], 6e10)):
        vertices, faces = solids.icosphere(0)
        lumps = vertices * (1 + 0.05 * random.normal(size=(len(vertices), 1))) * size
        bodies.append(ba.RigidBody(name, ba.Polyhedron(lumps * u.m, faces), mass=mass * u.kg))
    return bodies


def stone() -> ba.RigidBody:
    """A box that is heavier at one end, so that it looks like itself from nowhere else."""
    vertices, faces = solids.box((-300.0, -200.0, -150.0), (300.0, 200.0, 150.0))
    vertices[4:, 1:] *= 0.6
    return ba.RigidBody("A", ba.Polyhedron(vertices * u.m, faces), density=2400 * u.kg / u.m**3)


def ball() -> ba.RigidBody:
    return ba.RigidBody("B", ba.Sphere(100 * u.m), density=2000 * u.kg / u.m**3)


MODELS = {
    "PointMass": lambda: ba.System(ellipsoids(), gravity=ba.PointMass()),
    "SecondDegree": lambda: ba.System(ellipsoids(), gravity=ba.SecondDegree()),
    "Multipole 4 ellipsoids": lambda: ba.System(ellipsoids(), gravity=ba.Multipole(4)),
    "Multipole 3 clouds": lambda: ba.System(clouds(), gravity=ba.Multipole(3)),
    "Multipole 8 clouds": lambda: ba.System(clouds(), gravity=ba.Multipole(8)),
    "PointPairs clouds": lambda: ba.System(clouds(), gravity=ba.PointPairs()),
    "PointPairs dumbbells": lambda: ba.System(dumbbells(), gravity=ba.PointPairs()),
    "PolyhedronPair": lambda: ba.System(polyhedra(), gravity=ba.PolyhedronPair(1e-10)),
    "PolyhedronPoint": lambda: ba.System([stone(), ball()], gravity=ba.PolyhedronPoint()),
    "PolyhedronPoint, the point first": lambda: ba.System([ball(), stone()], gravity=ba.PolyhedronPoint()),
    "EllipsoidPair": lambda: ba.System(ellipsoids(), gravity=ba.EllipsoidPair()),
    "EllipsoidPair reversed": lambda: ba.System(ellipsoids()[::-1], gravity=ba.EllipsoidPair()),
    # the distance of the configurations lies in the interval, near neither end
    "Adaptive": lambda: ba.System(ellipsoids(), gravity=ba.Adaptive(accuracy=3e-4, far=ba.SecondDegree())),
    "PairPotential": lambda: ba.System(ellipsoids(), gravity=ba.PairPotential(repelled, [3e12, 4e15])),
}
ROUNDOFF = {"PolyhedronPair": 1e-13}  # of U at 1500 m, where it is more than a few roundings: as the square of distance
SWAPPABLE = [name for name in MODELS if name != "PairPotential"]


@pytest.fixture(params=MODELS)
def system(request: pytest.FixtureRequest) -> ba.System:
    return MODELS[request.param]()


def configurations(count: int = 20) -> list[tuple[np.ndarray, np.ndarray]]:
    random = np.random.default_rng(3)
    positions = random.normal(size=(count, 3))
    positions *= 1500 / np.linalg.norm(positions, axis=1, keepdims=True)
    turns = Rotation.from_rotvec(random.normal(size=(count, 3)) * 2).as_matrix()
    return list(zip(positions, turns, strict=True))


def energy(system: ba.System, x: np.ndarray, r: np.ndarray) -> float:
    return system.mutual_gravity(x * u.m, r).energy.value


def derivative(function, step: float) -> float:
    """Central difference of order six."""
    h = step
    return (
        45 * (function(h) - function(-h))
        - 9 * (function(2 * h) - function(-2 * h))
        + function(3 * h)
        - function(-3 * h)
    ) / (60 * h)


def test_gradient_and_moment_are_derivatives_of_the_energy(system: ba.System) -> None:
    for x, r in configurations():
        gravity = system.mutual_gravity(x * u.m, r)
        force = np.linalg.norm(gravity.gradient.value)
        for i, e in enumerate(np.eye(3)):
            slope = derivative(lambda s, x=x, r=r, e=e: energy(system, x + s * e, r), 8.0)
            assert slope == pytest.approx(gravity.gradient.value[i], abs=1e-10 * force)
            # dU for R -> exp(s S(e)) R is M.e, for the torque on the secondary is -M
            turn = derivative(
                lambda s, x=x, r=r, e=e: energy(system, x, Rotation.from_rotvec(s * e).as_matrix() @ r), 0.02
            )
            assert turn == pytest.approx(gravity.moment.value[i], abs=1e-10 * force * 1500)


@pytest.mark.parametrize("name", ["SecondDegree", "Multipole 4 ellipsoids", "EllipsoidPair", "PointPairs dumbbells"])
@pytest.mark.parametrize("signs", [(1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
def test_half_a_turn_about_a_principal_axis_changes_nothing(name: str, signs: tuple) -> None:
    """These bodies look the same after it: once the primary is turned, once the secondary."""
    system, d = MODELS[name](), np.diag(signs).astype(float)
    for x, r in configurations(5):
        one = system.mutual_gravity(x * u.m, r)
        scale = np.linalg.norm(one.gradient.value)
        for turned, back in (
            (system.mutual_gravity(d @ x * u.m, d @ r), d),
            (system.mutual_gravity(x * u.m, r @ d), np.eye(3)),
        ):
            assert turned.energy.value == pytest.approx(one.energy.value, rel=1e-14)
            np.testing.assert_allclose(back @ turned.gradient.value, one.gradient.value, atol=1e-13 * scale)
            np.testing.assert_allclose(back @ turned.moment.value, one.moment.value, atol=1e-13 * scale * 1500)


@pytest.mark.parametrize("name", SWAPPABLE)
def test_swapping_the_bodies(name: str) -> None:
    system = MODELS[name]()
    swapped = ba.System(system.bodies[::-1], gravity=system.gravity)
    for x, r in configurations(5):
        one = system.mutual_gravity(x * u.m, r)
        two = swapped.mutual_gravity(-(r.T @ x) * u.m, r.T)
        roundoff = ROUNDOFF.get(name, 1e-14)
        assert two.energy.value == pytest.approx(one.energy.value, rel=roundoff)
        scale = 10 * roundoff * np.linalg.norm(one.gradient.value)
        np.testing.assert_allclose(r @ two.gradient.value, -one.gradient.value, atol=scale)
        np.testing.assert_allclose(r @ two.torque_on_primary.value, one.torque_on_secondary.value, atol=scale * 1500)


@pytest.mark.parametrize("name", SWAPPABLE)
def test_far_away_it_is_a_point_mass(name: str) -> None:
    system = MODELS[name]()
    point = ba.System(system.bodies, gravity=ba.PointMass())
    x, r = configurations(1)[0]
    errors = [energy(system, x * far, r) / energy(point, x * far, r) - 1 for far in (10.0, 100.0)]
    assert abs(errors[0]) < 1e-2
    assert errors[1] == pytest.approx(errors[0] / 100, rel=0.1, abs=1e4 * ROUNDOFF.get(name, 1e-18))


def test_second_degree_is_the_limit_of_point_pairs() -> None:
    """The error of truncation at degree 2 falls as r^-3 (a cloud has degree 3) against the pair sum."""
    system = MODELS["PointPairs clouds"]()
    truncated = ba.System(system.bodies, gravity=ba.SecondDegree())
    x, r = configurations(1)[0]
    errors = [abs(energy(truncated, x * far, r) / energy(system, x * far, r) - 1) for far in (4.0, 8.0)]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(3, abs=0.4)


def test_a_sphere_is_a_point() -> None:
    sphere = ba.RigidBody("S", ba.Sphere(300 * u.m), mass=1e12 * u.kg)
    cloud = clouds()[1]
    gravity = ba.System([sphere, cloud], gravity=ba.PointPairs()).mutual_gravity([900, 0, 0] * u.m)
    assert np.linalg.norm(gravity.torque_on_primary.value) < 1e-9 * np.linalg.norm(gravity.torque_on_secondary.value)


def test_many_pairs_against_a_plain_sum() -> None:
    """The compiled sum is reassociated; it stays within round-off of NumPy's."""
    system = MODELS["PointPairs clouds"]()
    (p1, f1), (p2, f2) = system.secondary.points, system.primary.points
    for x, r in configurations(5):
        gravity = system.mutual_gravity(x * u.m, r)
        d = (x + p1 @ r.T)[:, None, :] - p2[None, :, :]
        weights = np.outer(f1 * system.secondary.si.gm, f2 * system.primary.si.mass)
        distance = np.linalg.norm(d, axis=-1)
        pull = (weights / distance**3)[..., None] * d
        assert gravity.energy.value == pytest.approx(-(weights / distance).sum(), rel=1e-14)
        np.testing.assert_allclose(gravity.gradient.value, pull.sum(axis=(0, 1)), rtol=1e-12)
        moment = np.cross((p1 @ r.T)[:, None, :], pull).sum(axis=(0, 1))
        np.testing.assert_allclose(gravity.moment.value, moment, atol=1e-13 * np.abs(pull).sum() * 300)
