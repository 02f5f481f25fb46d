"""Systems of three bodies and more, as a user meets them: gravity by pairs, points, orbits, runs, files, pictures."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from validation.systems import four_bodies

import binaryast as ba
from binaryast.errors import ContactError, EndWarning, GravityWarning, InputError, StorageError

OF_PAIRS = ("roll_pitch_yaw", "spectrum", "poincare_section")  # pictures of two bodies


def spheres(count: int, radius: float = 10) -> list[ba.RigidBody]:
    return [ba.RigidBody(name, ba.Sphere(radius * u.m), mass=1e9 * u.kg) for name in "ABCDEFGH"[:count]]


def at(*places: tuple, speeds: tuple = ()) -> ba.State:
    count = len(places)
    velocity = np.array(speeds) if speeds else np.zeros((count, 3))
    zero = np.zeros((count, 3))
    return ba.State(np.array(places) * u.m, velocity * u.m / u.s, [np.eye(3)] * count, zero * u.rad / u.s)


@pytest.fixture(scope="module")
def triple() -> ba.Trajectory:
    system, state = ba.catalogue.load("sn263")
    return ba.propagate(system, state, duration=20 * u.day, integrator=ba.LGVI(60 * u.s), save_every=2 * u.h)


def test_each_pair_has_its_own_gravity() -> None:
    system, _ = four_bodies()
    named = {(system.names[p.primary], system.names[p.secondary]): type(p.gravity).__name__ for p in system.pairs}
    assert named == {
        ("A", "B"): "SecondDegree",
        ("A", "rod"): "SecondDegree",
        ("A", "dust"): "PointMass",
        ("B", "rod"): "SecondDegree",
        ("B", "dust"): "SecondDegree",
        ("rod", "dust"): "PointPairs",
    }
    assert isinstance(system.pair("rod", "dust").gravity, ba.PointPairs)
    turned = ba.System(system.bodies, gravity={("dust", "rod"): ba.PointPairs(), "others": ba.PointMass()})
    assert isinstance(turned.pairs[-1].gravity, ba.PointPairs)
    assert [type(pair.gravity) for pair in ba.System(spheres(3)).pairs] == 3 * [ba.SecondDegree]


def test_the_pull_on_each_body_is_the_sum_over_its_pairs() -> None:
    """Accelerations of the first step against Newton's law written out."""
    system = ba.System(spheres(4), gravity=ba.PointMass())
    places = ((0, 0, 0), (1000, 200, 0), (-300, 900, 50), (400, -700, 600))
    h = 1.0
    run = ba.propagate(system, at(*places), duration=h * u.s, integrator=ba.LGVI(h * u.s), save_every=h * u.s)
    x = np.array(places, dtype=float)
    for i in range(4):
        pull = sum(ba.constants.G * 1e9 * (x[j] - x[i]) / np.linalg.norm(x[j] - x[i]) ** 3 for j in range(4) if j != i)
        moved = run.si.position[1, i] - x[i] - (run.si.position[1] - x).mean(axis=0)
        np.testing.assert_allclose(moved, h**2 / 2 * pull, atol=3e-13)


@pytest.mark.parametrize(
    ("gravity", "says"),
    [
        ({("A", "B"): ba.PointMass()}, "nothing is said of"),
        ({("A", "X"): ba.PointMass(), "others": ba.PointMass()}, "is no pair"),
        ({"A": ba.PointMass(), "others": ba.PointMass()}, "is no pair"),
        ({("A", "B"): ba.PointMass(), ("B", "A"): ba.PointMass(), "others": ba.PointMass()}, "twice"),
        ({("A", "B"): "PointMass", "others": ba.PointMass()}, "expected a model"),
        ([ba.PointMass()], "3 pairs, got 1"),
        ("PointMass", "expected a model"),
        (None, "expected a model"),
    ],
)
def test_wrong_gravity(gravity: object, says: str) -> None:
    with pytest.raises(InputError, match=says):
        ba.System(spheres(3), gravity=gravity)


def test_what_is_of_a_pair_says_so() -> None:
    system, state = four_bodies()
    run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(20 * u.s))
    for call in (
        lambda: system.mutual_gravity([1, 0, 0] * u.km),
        lambda: system.secondary,
        lambda: system.parameters,
        lambda: state.separation,
        state.relative,
        lambda: run.relative,
        lambda: run.separation,
        lambda: ba.analysis.mutual_period(run),
        lambda: ba.State.circular_orbit(system, separation=1 * u.km, spins=[1 * u.h, 1 * u.h]),
        lambda: ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(20 * u.s, frame="relative")),
    ):
        with pytest.raises(InputError, match=r"pair|bodies"):
            call()
    with pytest.raises(InputError, match="did you mean 'dust'"):
        run.distance("A", "dst")


def test_energy_and_momenta_of_the_rows_are_those_that_were_watched(triple: ba.Trajectory) -> None:
    triple.check(energy=1e-8, momentum=5e-15, rotation=2e-15)
    energy = triple.energy.value
    assert np.abs(energy / energy[0] - 1).max() <= 1.001 * triple.max_relative_energy_error
    momentum = triple.angular_momentum.value
    assert np.linalg.norm(momentum - momentum[0], axis=1).max() < 5e-15 * np.linalg.norm(momentum[0])


def test_a_barycentre_that_moves_goes_on_doing_so() -> None:
    system, state = four_bodies()
    shift, drift = [3e5, -2e5, 1e5] * u.m, [3, -2, 5] * u.m / u.s
    moved = ba.State(state.position + shift, state.velocity + drift, state.attitude, state.spin)
    one, two = (
        ba.propagate(system, s, duration=10 * u.h, integrator=ba.LGVI(20 * u.s), save_every=1 * u.h)
        for s in (state, moved)
    )
    expected = one.position + shift + drift * two.time[:, None, None]
    assert np.abs(two.position - expected).max() < 1e-6 * u.m


def test_a_file_brings_everything_back(triple: ba.Trajectory, tmp_path: Path) -> None:
    again = ba.Trajectory.read(triple.write(tmp_path / "triple.h5"))
    for one, two in zip(triple.si, again.si, strict=True):
        np.testing.assert_array_equal(one, two)
    assert again.system.names == triple.system.names
    system, state = four_bodies()
    run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(20 * u.s))
    again = ba.Trajectory.read(run.write(tmp_path / "four.h5"))
    assert [type(pair.gravity) for pair in again.system.pairs] == [type(pair.gravity) for pair in system.pairs]
    assert again.system.bodies[3].is_point
    on = ba.propagate(again.system, again[-1], duration=1 * u.h, integrator=again.integrator)
    assert on.status == "completed"


def test_a_file_of_another_number_of_bodies_is_refused(triple: ba.Trajectory, tmp_path: Path) -> None:
    import h5py

    path = triple.write(tmp_path / "triple.h5")
    with h5py.File(path, "a") as file:
        spin = file["spin"][:, :2]
        del file["spin"]
        file.create_dataset("spin", data=spin).attrs["unit"] = "rad / s"
    with pytest.raises(StorageError, match="spin"):
        ba.Trajectory.read(path, verify=False)


def test_table_summary_and_pictures(triple: ba.Trajectory, tmp_path: Path) -> None:
    table = triple.to_table()
    assert "Beta.spin_z" in table.colnames
    assert "separation of Beta from Alpha" in triple.summary()
    for kind in (None, *ba.plotting.KINDS):
        path = tmp_path / f"{kind}.png"
        if kind in OF_PAIRS:
            with pytest.raises(InputError, match="expected primary and secondary"):
                ba.plotting.save(triple, path, kind=kind)
        else:
            assert ba.plotting.save(triple, path, kind=kind).stat().st_size > 10_000
    system, state = four_bodies()
    run = ba.propagate(system, state, duration=10 * u.h, integrator=ba.LGVI(20 * u.s))
    assert ba.plotting.save(run, tmp_path / "four.png").stat().st_size > 10_000


def test_periods_of_two_moons(triple: ba.Trajectory) -> None:
    assert ba.analysis.mutual_period(triple, ("Alpha", "Gamma")).value == pytest.approx(16.46, rel=0.01)
    assert ba.analysis.mutual_period(triple, (0, 2)).value == pytest.approx(149.4, rel=0.02)
    assert abs(ba.analysis.libration_angle(triple, ("Alpha", "Gamma"))).max() < 20 * u.deg
    for wrong in (("Alpha",), ("Alpha", "Alpha"), ("Alpha", "Delta"), (0, 7), "Alpha"):
        with pytest.raises(InputError):
            ba.analysis.mutual_period(triple, wrong)


def test_contact_names_the_pair() -> None:
    system = ba.System(spheres(3))
    state = at((0, 0, 0), (1000, 0, 0), (0, 1000, 0), speeds=((0, 0, 0), (0, 0, 0), (1, -1, 0)))
    falling = at((0, 0, 0), (1000, 0, 0), (500, 500, 0), speeds=((0, 0, 0), (0, 0, 0), (1, -1, 0)))
    with pytest.warns(EndWarning, match="C touched B"):
        run = ba.propagate(system, falling, duration=1 * u.h, integrator=ba.LGVI(1 * u.s))
    assert run.status == "contact"
    assert run.distance("B", "C")[-1] < 20.5 * u.m
    assert run.closest_approach.value == pytest.approx(run.distance("B", "C")[-1].value, rel=1e-12)
    assert ba.propagate(system, state, duration=1 * u.min, integrator=ba.LGVI(1 * u.s)).status == "completed"
    with pytest.raises(ContactError, match="A and C overlap"):
        ba.propagate(system, at((0, 0, 0), (90, 0, 0), (0, 5, 0)), duration=1 * u.h, integrator=ba.LGVI(1 * u.s))


def test_a_point_lands() -> None:
    bodies = [ba.RigidBody("A", ba.Ellipsoid(100 * u.m, 80 * u.m, 60 * u.m), mass=1e10 * u.kg)]
    bodies += [ba.RigidBody("lander", ba.Point(), mass=100 * u.kg)]
    for frame in ("relative", "inertial"):
        with pytest.warns(EndWarning, match="lander touched A"), pytest.warns(GravityWarning, match="leaves out"):
            run = ba.propagate(
                ba.System(bodies),
                at((0, 0, 0), (0, 0, 300), speeds=((0, 0, 0), (0, 0, -0.1))),
                duration=1 * u.day,
                integrator=ba.LGVI(1 * u.s, frame=frame),
            )
        assert run.separation[-1].value == pytest.approx(60, rel=1e-14)


def test_points_do_not_turn_and_do_not_touch_each_other() -> None:
    points = [ba.RigidBody(name, ba.Point(), mass=1e9 * u.kg) for name in "AB"]
    state = at((0, 0, 0), (100, 0, 0), speeds=((0, 0, 0), (0, 0.02, 0)))
    run = ba.propagate(ba.System(points), state, duration=1 * u.day, integrator=ba.LGVI(10 * u.s))
    assert run.status == "completed"
    run.check(momentum=1e-14, rotation=1e-15)
    turning = ba.State(state.position, state.velocity, state.attitude, [[0, 0, 0], [0, 0, 1e-3]] * u.rad / u.s)
    with pytest.raises(InputError, match="B is a point, which does not turn"):
        ba.propagate(ba.System(points), turning, duration=1 * u.day, integrator=ba.LGVI(10 * u.s))
    with pytest.raises(InputError, match="is a point, which has no axes"):
        ba.analysis.libration_angle(run)


def test_too_long_a_step_names_the_body() -> None:
    system, state = four_bodies()
    with pytest.raises(ba.errors.StepError, match="A spins at"):
        ba.propagate(system, state, duration=10 * u.h, integrator=ba.LGVI(2000 * u.s))


def test_orbits_about_the_primary_and_about_the_inner_bodies() -> None:
    bodies = [ba.RigidBody(n, ba.Sphere(10 * u.m), mass=m * u.kg) for n, m in (("A", 3e12), ("B", 1e12), ("C", 2e11))]
    system = ba.System(bodies)
    for about in ("primary", "inner"):
        orbits = [ba.Orbit(2 * u.km, 0.1), ba.Orbit(9 * u.km, 0.2, 30 * u.deg, mean_anomaly=1 * u.rad, about=about)]
        state = ba.State.from_orbits(system, orbits, spins=["synchronous", 5 * u.h, 1e-4 * u.rad / u.s])
        m, x, v = np.array([3e12, 1e12, 2e11]), state.position.value, state.velocity.value
        np.testing.assert_allclose(m @ x / m.sum(), 0, atol=1e-9)
        np.testing.assert_allclose(m @ v / m.sum(), 0, atol=1e-15)
        count = 1 if about == "primary" else 2
        d = x[2] - m[:count] @ x[:count] / m[:count].sum()
        w = v[2] - m[:count] @ v[:count] / m[:count].sum()
        gm = ba.constants.G * (m[:count].sum() + m[2])
        assert 1 / (2 / np.linalg.norm(d) - w @ w / gm) == pytest.approx(9000, rel=1e-12)
        momentum = np.cross(d, w)
        assert np.degrees(np.arccos(momentum[2] / np.linalg.norm(momentum))) == pytest.approx(30)
        np.testing.assert_allclose(state.attitude[2][:, 2], momentum / np.linalg.norm(momentum), atol=1e-12)
        np.testing.assert_allclose(state.attitude[2][:, 0], d / np.linalg.norm(d), atol=1e-12)


def test_a_pair_by_orbits_is_the_pair_by_elements() -> None:
    system, _ = ba.catalogue.load("didymos")
    elements = {"eccentricity": 0.1, "inclination": 20 * u.deg, "true_anomaly": 50 * u.deg}
    one = ba.State.from_elements(system, semi_major_axis=1.2 * u.km, **elements, spins=[2.26 * u.h, "synchronous"])
    two = ba.State.from_orbits(system, [ba.Orbit(1.2 * u.km, **elements)], spins=[2.26 * u.h, "synchronous"])
    for a, b in zip(one.si, two.si, strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-14, atol=1e-15)


def test_poles_by_name() -> None:
    system, state = ba.catalogue.load("sn263")
    z = state.attitude[system.index("Alpha")][:, 2]
    assert np.degrees(np.arctan2(z[1], z[0])) == pytest.approx(67.81)
    assert np.degrees(np.arcsin(z[2])) == pytest.approx(-73.18)


@pytest.mark.parametrize(
    ("changes", "says"),
    [
        ({"orbits": []}, "orbits: expected a list of 2"),
        ({"orbits": [1, 2]}, "expected ba.Orbit"),
        ({"spins": ["synchronous"]}, "spins: expected a list of 3"),
        ({"spins": [None, None, None]}, r"spins\[0\]"),
        ({"spins": ["none", "synchronous", "synchronous"]}, r"spins\[0\]"),
        ({"poles": [1, 2]}, "poles: expected a table"),
        ({"poles": {"X": [0, 0, 1]}}, "is no body"),
    ],
)
def test_wrong_orbits(changes: dict, says: str) -> None:
    arguments = {"orbits": [ba.Orbit(2 * u.km), ba.Orbit(9 * u.km)], "spins": ["synchronous"] * 3} | changes
    with pytest.raises(InputError, match=says):
        ba.State.from_orbits(ba.System(spheres(3)), arguments.pop("orbits"), **arguments)


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"eccentricity": 1.0}, "0 <= e < 1"),
        ({"true_anomaly": 1 * u.rad, "mean_anomaly": 1 * u.rad}, "at most one"),
        ({"about": "Sun"}, "expected one of primary, inner"),
        ({"inclination": 1}, "no unit"),
    ],
)
def test_wrong_elements(arguments: dict, says: str) -> None:
    with pytest.raises(InputError, match=says):
        ba.Orbit(1 * u.km, **arguments)


def test_a_step_too_long_for_a_light_body_is_said() -> None:
    """Its error is not seen in the energy of all."""
    bodies = [ba.RigidBody("A", ba.Sphere(200 * u.m), mass=5e11 * u.kg), *spheres(1)]
    bodies[1] = ba.RigidBody("B", ba.Sphere(50 * u.m), mass=4e9 * u.kg)
    bodies.append(ba.RigidBody("craft", ba.Point(), mass=12 * u.kg))
    system = ba.System(bodies)
    state = ba.State.from_orbits(
        system, [ba.Orbit(20 * u.km), ba.Orbit(600 * u.m, 0.5)], spins=[1000 * u.h, 1000 * u.h, None]
    )
    with pytest.warns(ba.errors.StepWarning, match="craft would go once round A"):
        ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(1000 * u.s))
    ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(10 * u.s))


def test_mass_centres_in_one_place_are_named() -> None:
    for integrator in (ba.LGVI(1 * u.s), ba.RungeKutta()):
        with pytest.raises(ContactError, match="B and C overlap"):
            ba.propagate(
                ba.System(spheres(3)),
                at((0, 0, 0), (1000, 0, 0), (1000, 0, 0)),
                duration=1 * u.h,
                integrator=integrator,
            )


def test_what_was_given_cannot_be_changed_afterwards() -> None:
    length = 5 * u.km
    orbit = ba.Orbit(length)
    length *= -1
    assert orbit.semi_major_axis == 5 * u.km
    for array in (orbit.semi_major_axis, orbit.inclination, ba.Orbit(1 * u.km).inclination):
        with pytest.raises(ValueError, match="read-only"):
            array[...] = 1 * array.unit
    system = ba.System(spheres(2))
    with pytest.raises(ValueError, match="read-only"):
        system.pairs[0].parameters[0] = 1


def test_the_picture_does_not_depend_on_where_the_origin_is() -> None:
    from binaryast.plotting import _mean_plane

    system, state = ba.catalogue.load("sn263")
    moved = ba.State(state.position + 1e5 * u.m, state.velocity + [0, 0, 5] * u.m / u.s, state.attitude, state.spin)
    one, two = (
        _mean_plane(ba.propagate(system, s, duration=2 * u.day, integrator=ba.LGVI(60 * u.s))) for s in (state, moved)
    )
    np.testing.assert_allclose(one, two, atol=1e-9)
