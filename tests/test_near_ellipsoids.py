"""Two ellipsoids up to contact, and gravity that is chosen by distance."""

import pickle
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast import scenario
from binaryast.errors import InputError
from binaryast.kernels.mutual import blend, ellipsoid_parameters
from binaryast.kernels.mutual.ellipsoids import potential

TURN = Rotation.from_euler("ZXZ", [30, 20, 10], degrees=True).as_matrix()
PAIRS = {  # semi-axes of A and B
    "alike": ([400, 395, 340], [85, 73, 63]),
    "long": ([1, 0.5, 0.3], [0.7, 0.4, 0.25]),
    "needle and disc": ([1, 0.3, 0.3], [1, 1, 0.3]),
    "flat": ([1, 0.9, 0.5], [0.5, 0.9, 1]),
    "sphere": ([1, 0.9, 0.5], [0.5, 0.5, 0.5]),
    "spheres": ([1, 1, 1], [0.5, 0.5, 0.5]),
}


def pair(a: list, b: list, gravity: object = None) -> ba.System:
    """Ellipsoids with G mA mB = 1."""
    one = ba.RigidBody("A", ba.Ellipsoid(*(np.array(a) * u.m)), gm=1 * u.m**3 / u.s**2)
    two = ba.RigidBody("B", ba.Ellipsoid(*(np.array(b) * u.m)), mass=1 * u.kg)
    return ba.System([one, two], gravity or ba.EllipsoidPair())


def at_contact(a: list, b: list, direction: np.ndarray, r: np.ndarray) -> np.ndarray:
    """X along a direction where the surfaces touch, by the function of Perram and Wertheim."""
    s = np.linspace(0, 1, 20001)[1:-1, None, None]
    matrices = (1 - s) * np.diag(np.square(a)) + s * (r @ np.diag(np.square(b)) @ r.T)
    f = s[:, 0, 0] * (1 - s[:, 0, 0]) * (np.linalg.inv(matrices) @ direction @ direction)
    return direction / np.sqrt(f.max())


@pytest.mark.parametrize(
    ("a", "b", "x", "r", "value"),
    [
        ([400, 395, 340], [85, 73, 63], [1195, 0, 0], np.eye(3), -8.39992172639902e-4),
        ([1, 0.5, 0.3], [0.7, 0.4, 0.25], [6, 2, 1], TURN, -1.56938569657589e-1),
    ],
)
def test_known_values(a: list, b: list, x: list, r: np.ndarray, value: float) -> None:
    assert pair(a, b).mutual_gravity(x * u.m, r).energy.value == pytest.approx(value, rel=3e-15)


def test_spheres_are_points() -> None:
    gravity = pair(*PAIRS["spheres"]).mutual_gravity([1.2, 0.9, 0.3] * u.m, TURN)
    assert gravity.energy.value == pytest.approx(-1 / np.sqrt(2.34), rel=1e-15)
    assert np.abs(gravity.moment.value).max() < 1e-16


@pytest.mark.parametrize("name", PAIRS)
def test_no_rule_leaves_more_than_round_off(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """From contact on, against rules of twice the nodes: so a change of rule is not seen in the energy."""
    a, b = (np.array(axes, dtype=float) for axes in PAIRS[name])
    usual = ellipsoid_parameters.parameters_of(1.0, b, a)
    monkeypatch.setattr(ellipsoid_parameters, "ROUNDOFF", 1e-28)
    monkeypatch.setattr(ellipsoid_parameters, "RIM", 1e-17)
    fine = ellipsoid_parameters.parameters_of(1.0, b, a)
    random = np.random.default_rng(1)
    for k in range(150):
        r, direction = Rotation.random(random_state=k).as_matrix(), random.normal(size=3)
        x = at_contact(a, b, direction, r) * (1 + random.uniform(0, 0.2) if k % 2 else random.uniform(1, 6))
        one, two = (np.array(potential(p, *x, *r.ravel())) for p in (usual, fine))
        assert one[0] == pytest.approx(two[0], rel=2e-14)
        assert np.linalg.norm(one[1:4] - two[1:4]) < 1e-12 * np.linalg.norm(two[1:4])


def test_what_it_cannot_take() -> None:
    with pytest.raises(InputError, match=r"A and B overlap at X = .* expected bodies that do not touch"):
        pair(*PAIRS["long"]).mutual_gravity([1.2, 0, 0] * u.m)
    with pytest.raises(InputError, match="A and B are too thin"):
        pair([1, 1, 1e-4], [1, 1, 1e-4])
    disc = ba.RigidBody("A", ba.Ellipsoid(1 * u.m, 1 * u.m, 0.5 * u.m), mass=1 * u.kg)
    rods = ba.RigidBody("rods", ba.Dumbbell(1 * u.m, 0.1 * u.m), mass=1 * u.kg)
    with pytest.raises(InputError, match="rods has the shape Dumbbell, which is no ellipsoid"):
        ba.System([disc, rods], ba.EllipsoidPair())
    heavy = ba.RigidBody("core", disc.shape, mass=1 * u.kg, inertia=[1, 1, 1.5] * u.kg * u.m**2)
    with pytest.raises(InputError, match="core was given an inertia of its own"):
        ba.System([disc, heavy], ba.EllipsoidPair())


def bodies() -> list[ba.RigidBody]:
    density = 2000 * u.kg / u.m**3
    return [
        ba.RigidBody("A", ba.Ellipsoid(500 * u.m, 350 * u.m, 300 * u.m), density=density),
        ba.RigidBody("B", ba.Ellipsoid(200 * u.m, 130 * u.m, 110 * u.m), density=density),
    ]


def test_adaptive_is_one_model_near_and_the_other_far() -> None:
    gravity = ba.Adaptive(accuracy=1e-6, far=ba.Multipole(4))
    inner, outer = gravity.interval(*bodies()).value
    system, near, far = (ba.System(bodies(), model) for model in (gravity, gravity.near, gravity.far))
    for r, same in ((0.999 * inner, near), (1.001 * outer, far)):
        x = r * np.array([0.6, 0.0, 0.8]) * u.m
        assert system.mutual_gravity(x, TURN).energy == same.mutual_gravity(x, TURN).energy
    x = inner * np.array([1.0, 0.0, 0.0])
    left = near.attraction(x, np.eye(3))[0] - far.attraction(x, np.eye(3))[0]
    assert 0.1e-6 < abs(left / far.attraction(x, np.eye(3))[0]) < 2e-6


def test_the_weight_has_four_continuous_derivatives() -> None:
    s = np.linspace(0, 1, 11)
    values = np.array([blend.falling(one) for one in s])
    assert values[0, 0] == 1
    assert values[-1, 0] == pytest.approx(0, abs=1e-13)
    h = 1e-3
    slopes = [(blend.falling(one + h)[0] - blend.falling(one - h)[0]) / (2 * h) for one in s]
    np.testing.assert_allclose(slopes, values[:, 1], atol=1e-4)
    assert blend.falling(h)[0] == pytest.approx(1 - 126 * h**5, abs=1e-12)


def test_what_adaptive_cannot_take() -> None:
    for arguments, message in (
        ({"accuracy": 1.0}, "accuracy: expected 1e-15 to 0.01, got 1"),
        ({"near": 3}, "near: expected a model"),
        ({"far": ba.PointMass()}, "far: expected a series"),
    ):
        with pytest.raises(InputError, match=message):
            ba.Adaptive(**arguments)
    with pytest.raises(InputError, match="overlap"):
        ba.System(bodies(), ba.Adaptive()).mutual_gravity([300, 0, 0] * u.m)


def eccentric(system: ba.System) -> ba.State:
    return ba.State.from_elements(
        system, semi_major_axis=1500 * u.m, eccentricity=0.4, spins=[5 * u.h, 7 * u.h], true_anomaly=180 * u.deg
    )


def test_energy_does_not_jump_where_models_are_joined() -> None:
    """Eccentric orbits that cross the interval: the error of energy falls with the step as without such a change."""
    errors = {}
    for name, model in (("joined", ba.Adaptive(accuracy=1e-2, far=ba.SecondDegree())), ("exact", ba.EllipsoidPair())):
        system = ba.System(bodies(), model)
        runs = [
            ba.propagate(system, eccentric(system), duration=3 * u.day, integrator=ba.LGVI(h * u.s)) for h in (40, 10)
        ]
        errors[name] = [run.max_energy_error_over_potential for run in runs]
    assert errors["joined"][0] / errors["joined"][1] == pytest.approx(16, rel=0.1)
    assert errors["joined"][1] < 2 * errors["exact"][1]


def test_they_are_kept_in_files_and_pickled(tmp_path: Path) -> None:
    gravity = ba.Adaptive(accuracy=1e-8, far=ba.Multipole(4))
    system = ba.System(bodies(), gravity)
    run = ba.propagate(system, eccentric(system), duration=10 * u.min, integrator=ba.LGVI(30 * u.s))
    run.write(tmp_path / "run.h5")
    again = ba.Trajectory.read(tmp_path / "run.h5").system
    for other in (again, pickle.loads(pickle.dumps(system))):
        assert repr(other.gravity) == repr(gravity)
        x = [1500, 200, 100] * u.m
        assert other.mutual_gravity(x).energy == system.mutual_gravity(x).energy


def test_in_a_scenario_file() -> None:
    text = """
bodies = [
    { name = "A", shape = { type = "Ellipsoid", a = "5 m", b = "4 m", c = "3 m" }, mass = "1e6 kg" },
    { name = "B", shape = { type = "Sphere", radius = "1 m" }, mass = "1e4 kg" },
]
gravity = { type = "Adaptive", accuracy = 1e-8, far = { type = "Multipole", degree = 6 } }
state = { type = "circular_orbit", separation = "30 m", spins = ["3 h", "synchronous"] }
run = { duration = "1 d", step = "20 s" }
"""
    system = scenario.loads(text, name="near", where="near.toml").system
    assert repr(system.gravity) == repr(ba.Adaptive(accuracy=1e-8, far=ba.Multipole(6)))
