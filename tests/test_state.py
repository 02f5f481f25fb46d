"""States: circular orbits in the pair's own field, elements, the paper's reduced variables both ways."""

import pickle

import astropy.units as u
import numpy as np
import pytest
from astropy.time import Time
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.errors import InputError
from binaryast.orbits import pole_axes


def test_a_doubly_synchronous_orbit_has_the_closed_form_rate() -> None:
    """n^2 = G(m1+m2)/r^3 {1 + 3/(2 r^2) sum_i (B + C - 2 A)_i/m_i}."""
    system = ba.System(ba.catalogue.load("patroclus")[0].bodies, ba.SecondDegree())
    state = ba.State.circular_orbit(system, separation=692.5 * u.km, spins=["synchronous", "synchronous"])
    r = 692.5e3
    shapes = sum((b + c - 2 * a) / body.si.mass for body in system.bodies for a, b, c in [body.si.moments])
    gm = sum(body.si.gm for body in system.bodies)
    rate = np.sqrt(gm / r**3 * (1 + 1.5 / r**2 * shapes))
    assert state.spin[0, 2].value == pytest.approx(rate, rel=1e-14)
    assert np.linalg.norm(state.velocity[1] - state.velocity[0]).value == pytest.approx(rate * r, rel=1e-14)


def test_a_doubly_synchronous_pair_stays_so() -> None:
    system, state = ba.catalogue.load("patroclus")
    run = ba.propagate(system, state, duration=50 * u.day, integrator=ba.LGVI(step=30 * u.s))
    assert np.ptp(run.separation.value) < 1e-6 * state.separation.value
    assert abs(ba.analysis.libration_angle(run)).max().to_value("deg") < 1e-3


def test_period_and_separation_are_each_others_inverse(didymos: ba.System) -> None:
    by_period = ba.State.circular_orbit(didymos, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    again = ba.State.circular_orbit(didymos, separation=by_period.separation, spins=[2.26 * u.h, "synchronous"])
    np.testing.assert_allclose(again.velocity.value, by_period.velocity.value, atol=1e-15)
    assert by_period.separation.to_value("m") == pytest.approx(1184.2, abs=0.1)


def test_the_mean_over_a_turn_is_that_of_the_axisymmetric_body(didymos: ba.System) -> None:
    """At second degree, to which a given inertia belongs."""
    moments = didymos.primary.si.moments.copy()
    moments[:2] = moments[:2].mean()
    primary = ba.RigidBody("round", didymos.primary.shape, gm=didymos.primary.gm, inertia=moments * u.kg * u.m**2)
    round_pair = ba.System([primary, didymos.secondary])
    pair = ba.System(didymos.bodies, ba.SecondDegree())
    one = ba.State.circular_orbit(pair, separation=1200 * u.m, spins=[2.26 * u.h, "synchronous"])
    two = ba.State.circular_orbit(round_pair, separation=1200 * u.m, spins=["synchronous", "synchronous"])
    np.testing.assert_allclose(one.velocity.value, two.velocity.value, rtol=0, atol=1e-15)


def test_the_pole_is_where_it_should_be(didymos: ba.System) -> None:
    pole = [69.3, -72.7] * u.deg
    state = ba.State.circular_orbit(didymos, separation=1.2 * u.km, pole=pole, spins=[2 * u.h, "synchronous"])
    momentum = np.cross(state.si.position[1] - state.si.position[0], state.si.velocity[1] - state.si.velocity[0])
    momentum /= np.linalg.norm(momentum)
    assert np.degrees(np.arcsin(momentum[2])) == pytest.approx(-72.7)
    assert np.degrees(np.arctan2(momentum[1], momentum[0])) == pytest.approx(69.3)
    assert state.frame == "ICRF"
    np.testing.assert_allclose(state.attitude[0] @ [0, 0, 1], momentum, atol=1e-15)


@pytest.mark.parametrize("pole", [None, [0, 0, 1], [0, 0, -2], [1, 2, 3], [1e-14, 0, 1]])
def test_orbit_axes_are_a_rotation(pole: list | None) -> None:
    axes = pole_axes(pole)
    np.testing.assert_allclose(axes.T @ axes, np.eye(3), atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1)
    if pole is not None:
        np.testing.assert_allclose(axes[:, 2], np.array(pole) / np.linalg.norm(pole), atol=1e-13)


def test_elements_come_back(didymos: ba.System) -> None:
    a, e, i, node, apse, nu = 1300.0, 0.2, 0.5, 1.1, 2.3, 0.9
    state = ba.State.from_elements(
        didymos,
        semi_major_axis=a * u.m,
        eccentricity=e,
        inclination=i * u.rad,
        longitude_of_ascending_node=node * u.rad,
        argument_of_periapsis=apse * u.rad,
        true_anomaly=nu * u.rad,
        spins=[2.26 * u.h, "synchronous"],
    )
    gm = sum(body.si.gm for body in didymos.bodies)
    x, v = (array[1] - array[0] for array in state.si[:2])
    h = np.cross(x, v)
    eccentricity = np.cross(v, h) / gm - x / np.linalg.norm(x)
    n = np.array([-h[1], h[0], 0])
    assert 1 / (2 / np.linalg.norm(x) - v @ v / gm) == pytest.approx(a)
    assert np.linalg.norm(eccentricity) == pytest.approx(e)
    assert np.arccos(h[2] / np.linalg.norm(h)) == pytest.approx(i)
    assert np.arctan2(n[1], n[0]) == pytest.approx(node)
    assert np.arccos(n @ eccentricity / np.linalg.norm(n) / e) == pytest.approx(apse)
    assert np.arccos(x @ eccentricity / np.linalg.norm(x) / e) == pytest.approx(nu)
    assert state.spin[1, 2].value == pytest.approx(np.sqrt(gm / a**3))


def test_mean_anomaly_obeys_kepler(didymos: ba.System) -> None:
    orbit = {"semi_major_axis": 1300 * u.m, "eccentricity": 0.7, "spins": [2.26 * u.h, 5 * u.h]}
    half = ba.State.from_elements(didymos, mean_anomaly=180 * u.deg, **orbit)
    assert half.separation.value == pytest.approx(1300 * 1.7)
    for mean in (-3.0, 0.01, 1.0, 6.0):
        state = ba.State.from_elements(didymos, mean_anomaly=mean * u.rad, **orbit)
        cosine = (1 - state.separation.value / 1300) / 0.7
        eccentric = np.arccos(cosine) if np.sin(mean) >= 0 else 2 * np.pi - np.arccos(cosine)
        assert (eccentric - 0.7 * np.sin(eccentric) - mean + np.pi) % (2 * np.pi) == pytest.approx(np.pi, abs=1e-9)


def test_spins_in_every_way(didymos: ba.System) -> None:
    def spin(value) -> np.ndarray:
        return ba.State.circular_orbit(didymos, separation=1.2 * u.km, spins=[value, "synchronous"]).si.spin[0]

    np.testing.assert_allclose(spin(2 * u.h), [0, 0, 2 * np.pi / 7200])
    np.testing.assert_allclose(spin(-1e-4 * u.rad / u.s), [0, 0, -1e-4])
    np.testing.assert_allclose(spin(90 * u.deg / u.h), [0, 0, np.pi / 2 / 3600])
    np.testing.assert_allclose(spin([1, 2, 3] * u.deg / u.s), np.radians([1, 2, 3]))


def random_state() -> ba.State:
    random = np.random.default_rng(4)
    return ba.State(
        random.normal(size=(2, 3)) * u.km,
        random.normal(size=(2, 3)) * u.m / u.s,
        Rotation.from_rotvec(random.normal(size=(2, 3))).as_matrix(),
        random.normal(size=(2, 3)) * u.rad / u.h,
        Time("2022-09-26T23:14:24.184", scale="utc"),
        "ICRF",
    )


def test_the_reduction_and_back() -> None:
    """(33)-(39), against homogeneous matrices as in (33), and its inverse."""
    state = random_state()
    relative = state.relative()

    def homogeneous(i: int) -> np.ndarray:
        return np.block([[state.attitude[i], state.si.position[i][:, None]], [np.zeros(3), 1]])

    reduced = np.linalg.inv(homogeneous(0)) @ homogeneous(1)
    np.testing.assert_allclose(relative.R, reduced[:3, :3], atol=1e-15)
    np.testing.assert_allclose(relative.X.value, reduced[:3, 3], rtol=1e-13)
    np.testing.assert_allclose(relative.Omega.value, relative.R @ state.si.spin[1])
    back = relative.to_state()
    for one, two in zip(back.si, state.si, strict=True):
        np.testing.assert_allclose(one, two, rtol=1e-13, atol=1e-13)
    assert back.epoch == state.epoch
    assert back.frame == state.frame


def test_without_x2_the_barycentre_is_at_rest(didymos: ba.System) -> None:
    zero = [0, 0, 1e-4] * u.rad / u.s
    relative = ba.RelativeState([1200, 0, 30] * u.m, [0, 0.17, 0] * u.m / u.s, np.eye(3), zero, zero)
    state = relative.to_state(didymos)
    masses = np.array([body.si.mass for body in didymos.bodies])
    np.testing.assert_allclose(masses @ state.si.position, 0, atol=1e-2)
    np.testing.assert_allclose(masses @ state.si.velocity, 0, atol=1e-5)
    with pytest.raises(InputError, match="give system="):
        relative.to_state()


def test_states_pickle_and_keep_tdb() -> None:
    state = random_state()
    assert state.epoch.scale == "tdb"
    again = pickle.loads(pickle.dumps(state))
    np.testing.assert_array_equal(again.attitude, state.attitude)
    assert again.epoch == state.epoch
    relative = pickle.loads(pickle.dumps(state.relative()))
    np.testing.assert_array_equal(relative.X, state.relative().X)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"position": [[0, 0, 0], [1, 0, 0]]}, "no unit"),
        ({"position": [[0, 0, 0], [np.nan, 0, 0]] * u.m}, "finite"),
        ({"velocity": [[0, 0, 0]] * u.m / u.s}, "shape"),
        ({"spin": [[0, 0, 0], [1, 0, 0]] * u.m}, "angular rate"),
        ({"attitude": [np.eye(3), 2 * np.eye(3)]}, "not a rotation"),
        ({"attitude": [np.eye(3), np.diag([1, 1, -1])]}, "reflection"),
        ({"frame": "B1950"}, "frame"),
        ({"epoch": "2022-09-26"}, "epoch"),
    ],
)
def test_what_cannot_be(change: dict, says: str) -> None:
    arguments = random_state().arguments() | change
    with pytest.raises(InputError, match=says):
        ba.State(**arguments)


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ({"separation": None}, "exactly one"),
        ({"period": 10 * u.h}, "exactly one"),
        ({"separation": None, "period": 10 * u.m}, "time"),
        ({"spins": ["synchronous"]}, "one for each body"),
        ({"spins": ["sinchronous", 1 * u.h]}, "expected a period"),
        ({"spins": [1e-4, 1 * u.h]}, "expected a period"),
        ({"spins": [-2 * u.h, 1 * u.h]}, "positive"),
        ({"pole": [0, 0, 0]}, "not zero"),
    ],
)
def test_orbits_that_cannot_be(didymos: ba.System, change: dict, says: str) -> None:
    arguments = {"separation": 1.2 * u.km, "spins": ["synchronous", 2 * u.h]} | change
    with pytest.raises(InputError, match=says):
        ba.State.circular_orbit(didymos, **arguments)


def test_elements_that_cannot_be(didymos: ba.System) -> None:
    spins = ["synchronous", "synchronous"]
    with pytest.raises(InputError, match="0 <= e < 1"):
        ba.State.from_elements(didymos, semi_major_axis=1 * u.km, eccentricity=1.2, spins=spins)
    with pytest.raises(InputError, match="at most one"):
        ba.State.from_elements(
            didymos, semi_major_axis=1 * u.km, true_anomaly=1 * u.deg, mean_anomaly=1 * u.deg, spins=spins
        )
