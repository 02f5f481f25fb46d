"""What acts from outside: that it is balanced, and what is said where it cannot be."""

import pickle
from collections.abc import Callable
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from astropy.time import Time
from validation.systems import four_bodies

import binaryast as ba
from binaryast.errors import EndWarning, InputError
from binaryast.integrators import Stepping

EARTH = 398600.4355 * u.km**3 / u.s**2
SUN = ba.Sun(ba.Orbit(1.6442 * u.au, 0.38385, 3 * u.deg, 70 * u.deg, true_anomaly=10 * u.deg))
NEAR = ba.Flyby(EARTH, 30000 * u.km, 8 * u.km / u.s, 3 * u.h, 40 * u.deg, 110 * u.deg, radius=6378 * u.km)
FAR = ba.Flyby(EARTH, 60000 * u.km, 8 * u.km / u.s, 3 * u.h, 40 * u.deg, 110 * u.deg)
PLANET = ba.Planet(EARTH, ba.Orbit(60000 * u.km, 0.2, 30 * u.deg))  # strong, and over in four orbits of the pair
TIDE = ba.TidalTorque("A", raised_by="B", love_number=0.1, time_lag=100 * u.s)
STEPS: dict[str, Stepping] = {
    "LGVI": ba.LGVI(40 * u.s),
    "LGVI, inertial": ba.LGVI(40 * u.s, frame="inertial"),
    "LGVI of order 4": ba.LGVI(120 * u.s, order=4),
    "Splitting": ba.Splitting(300 * u.s),
    "Splitting, inertial": ba.Splitting(300 * u.s, frame="inertial"),
    "KeplerSplitting": ba.KeplerSplitting(600 * u.s),
}


def with_forces(given: ba.System, *perturbations: object) -> ba.System:
    """Return a system on which something acts."""
    return ba.System(given.bodies, gravity=given.gravity, perturbations=list(perturbations))


def elsewhere(state: ba.State) -> ba.State:
    """Return a state whose barycentre is not at the origin, and moves."""
    position = state.position + [300, -200, 100] * u.m
    return ba.State(position, state.velocity + [1, 2, -3] * u.mm / u.s, state.attitude, state.spin)


def same(one: ba.Trajectory, two: ba.Trajectory) -> bool:
    """Whether all rows are the same to the last bit."""
    return all(np.array_equal(a, b) for a, b in zip(one.si, two.si, strict=True))


@ba.force
def drag(p, t, position, velocity, attitude, spin, force, torque):
    """A drag on the translation and the spin of every body."""
    for i in range(len(position)):
        for k in range(3):
            force[i, k] -= p[0] * velocity[i, k]
            torque[i, k] -= p[1] * spin[i, k]


@ba.force
def pushed(p, t, position, velocity, attitude, spin, force, torque):
    """A steady force on body 1, not a number from a time on."""
    force[1, 0] += p[0] if t < p[1] else np.nan


@ba.external_potential
def spring(p, t, position, attitude, force, torque):
    """A spring between the origin and body 1 that grows stronger with time."""
    energy = 0.0
    for k in range(3):
        force[1, k] -= p[0] * (1.0 + p[1] * t) * position[1, k]
        energy += 0.5 * p[0] * position[1, k] ** 2
    return energy * (1.0 + p[1] * t), energy * p[1]


@pytest.mark.parametrize("name", STEPS)
@pytest.mark.parametrize(
    "acting", [(SUN,), (NEAR,), (PLANET,), (TIDE,), (SUN, NEAR, TIDE)], ids=["Sun", "flyby", "planet", "tide", "all"]
)
def test_momenta_and_energy_are_balanced(tumbling: tuple[ba.System, ba.State], name: str, acting: tuple) -> None:
    """About a barycentre that is elsewhere and moves: momenta to round-off, the energy to the order of the method."""
    given, state = tumbling
    method = STEPS[name]
    run = ba.propagate(with_forces(given, *acting), elsewhere(state), duration=6 * u.h, integrator=method)
    assert run.max_relative_angular_momentum_error < 4e-15
    assert run.max_relative_linear_momentum_error < 2e-15
    assert run.max_relative_energy_error < {2: 4e-6, 4: 1e-8}.get(method.order, 5e-10)
    gained = run.linear_momentum[-1] - run.linear_momentum[0]
    size = np.abs(run.linear_momentum.value).max()
    np.testing.assert_allclose((gained - run.impulse[-1]).value, 0, atol=1e-13 * size)
    turned = run.angular_momentum[-1] - run.angular_momentum[0]
    size = np.linalg.norm(run.angular_momentum[0].value)
    np.testing.assert_allclose((turned - run.angular_impulse[-1]).value, 0, atol=1e-13 * size)
    changed = float((run.energy[-1] - run.energy[0] - run.work[-1]).value)
    assert abs(changed) < 2 * run.max_energy_error.value + 1e-14 * abs(run.energy[0].value)


def test_where_nothing_moves_the_barycentre_does_not() -> None:
    """What acts is counted from the barycentre: where the state's origin lies does not matter."""
    given, state = ba.catalogue.load("didymos")
    system = with_forces(given, PLANET)
    method = ba.Splitting(10 * u.min)
    one, two = (
        ba.propagate(system, start, duration=1 * u.day, integrator=method) for start in (state, elsewhere(state))
    )
    shift = two.si.position - one.si.position
    expected = [300, -200, 100] + two.si.time[:, None] * [1e-3, 2e-3, -3e-3]
    np.testing.assert_allclose(shift, np.repeat(expected[:, None], 2, axis=1), atol=1e-8)
    np.testing.assert_allclose(two.si.attitude, one.si.attitude, atol=1e-12)


@pytest.mark.parametrize("name", [name for name in STEPS if name != "KeplerSplitting"])
def test_forces_without_size_change_nothing(tumbling: tuple[ba.System, ba.State], name: str) -> None:
    """No bit, but for sums that are rounded once where the compiler fuses them, which depends on what it sees."""
    given, state = tumbling
    nothing = (
        ba.TidalTorque("A", raised_by="B", love_number=0, quality_factor=10),
        ba.TidalTorque("B", raised_by="A", love_number=0, time_lag=1 * u.h),
        ba.Force(drag, [0.0, 0.0]),
        ba.Yorp("A", torque=0 * u.N * u.m),
        ba.Byorp("B", "A", 0 * u.N),
    )
    runs = [
        ba.propagate(system, state, duration=6 * u.h, integrator=STEPS[name])
        for system in (given, *(with_forces(given, one) for one in nothing), with_forces(given, *nothing))
    ]
    for run in runs[1:]:
        for one, other in zip(run.si, runs[0].si, strict=True):
            np.testing.assert_allclose(one, other, rtol=0, atol=1e-13 * np.abs(other).max())


def test_kepler_splitting_without_forces_is_the_same_to_round_off(tumbling: tuple[ba.System, ba.State]) -> None:
    given, state = tumbling
    systems = given, with_forces(given, ba.Force(drag, [0.0, 0.0]))
    ends = [ba.propagate(one, state, duration=6 * u.h, integrator=STEPS["KeplerSplitting"])[-1] for one in systems]
    for a, b in zip(*(end.si for end in ends), strict=True):
        np.testing.assert_allclose(a, b, atol=1e-13 * np.abs(a).max())


@pytest.mark.parametrize("scheme", ["kl8", "rkn6a", "ss10"])
def test_work_is_of_the_order_of_the_method(tumbling: tuple[ba.System, ba.State], scheme: str) -> None:
    """A drag works while gravity speeds up or slows down: its mean power in a kick is not that of the middle."""
    given, state = tumbling
    system = with_forces(given, ba.Force(drag, [2e4, 1e9]))
    family = ba.LGVI if scheme == "kl8" else ba.Splitting
    run = ba.propagate(system, state, duration=10 * u.h, integrator=family(150 * u.s, scheme=scheme))
    assert run.max_energy_error / abs(run.work[-1]) < 2e-8
    assert abs(run.work[-1] / run.energy[0]) > 1e-4


def test_a_potential_that_changes_with_time_is_balanced() -> None:
    given, state = ba.catalogue.load("didymos")
    system = with_forces(given, ba.ExternalPotential(spring, [3.0, 1e-6]))
    run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.Splitting(5 * u.min, scheme="ss10"))
    assert run.max_relative_energy_error < 1e-14
    assert abs(run.work[-1] / run.energy[0]) > 1e-5


def test_a_table_is_as_good_as_the_ellipse_it_is_of(tumbling: tuple[ba.System, ba.State]) -> None:
    given, state = tumbling
    radius, gm = 3e8, 4e14  # m, m3/s2
    times = np.linspace(-1.0, 3.0, 161) * u.day
    turned = np.sqrt((gm + sum(body.si.gm for body in given.bodies)) / radius**3) * times.to_value("s")
    places = -radius * np.stack([np.cos(turned), np.sin(turned), np.zeros_like(turned)], axis=1)
    ends = []
    for mass in (
        ba.ThirdBody(gm * u.m**3 / u.s**2, times, places * u.m),
        ba.Planet(gm * u.m**3 / u.s**2, ba.Orbit(radius * u.m)),
    ):
        system = ba.System(given.bodies, perturbations=[mass])
        ends.append(ba.propagate(system, state, duration=1 * u.day, integrator=ba.Splitting(10 * u.min))[-1])
    alone = ba.propagate(given, state, duration=1 * u.day, integrator=ba.Splitting(10 * u.min))[-1]
    moved = np.abs(ends[0].si.position - alone.si.position).max()
    assert np.abs(ends[0].si.position - ends[1].si.position).max() < 1e-9 * moved


@pytest.mark.parametrize(
    ("acting", "least"), [(PLANET, 1e-7), (FAR, 1e-9), (TIDE, 8e-12)], ids=["planet", "flyby", "tide"]
)
def test_legs_go_on_in_time(tumbling: tuple[ba.System, ba.State], acting: object, least: float) -> None:
    """An impulse of nothing changes nothing: the distant mass is where it would have been.

    But for what the tide has moved the barycentre by, 0.1 mm at most: each leg counts the mass's path from it anew.
    """
    given, state = tumbling
    system = with_forces(given, acting)
    kicks = [ba.Impulse(time * u.h, [0, 0, 0] * u.m / u.s, "B") for time in (2, 4)]
    for method in (STEPS["LGVI"], STEPS["LGVI, inertial"], STEPS["Splitting"], STEPS["KeplerSplitting"]):
        one, two = (
            ba.propagate(system, state, duration=6 * u.h, integrator=method, impulses=some, save_every=2 * u.h)
            for some in (kicks, [])
        )
        assert [len(leg) for leg in one.legs] == [2, 2, 2]
        rows = [0, 1, 3, 5]
        apart, expected = (run.si.position[:, 1] - run.si.position[:, 0] for run in (one, two))
        np.testing.assert_allclose(apart[rows], expected, rtol=0, atol=least)
        np.testing.assert_allclose(one.si.position[rows], two.si.position, rtol=0, atol=5e-4)
        np.testing.assert_allclose(one.si.attitude[rows], two.si.attitude, rtol=0, atol=8e-12)
        np.testing.assert_allclose(one.si.work[rows], two.si.work, rtol=1e-9)
        size = 1e-9 * np.abs(two.si.angular_impulse).max() + 1e-10
        np.testing.assert_allclose(one.si.angular_impulse[rows], two.si.angular_impulse, rtol=0, atol=size)


def test_an_epoch_says_where_the_sun_is() -> None:
    given, state = ba.catalogue.load("didymos")
    start = ba.State(**(state.arguments() | {"epoch": Time("2022-09-26T00:00:00", scale="tdb")}))
    later = ba.State(**(state.arguments() | {"epoch": Time("2022-09-26T06:00:00", scale="tdb")}))
    planet = ba.Planet(EARTH, ba.Orbit(60000 * u.km, 0.2), epoch=start.epoch)
    ends = [
        ba.propagate(with_forces(given, one), at, duration=3 * u.h, integrator=ba.Splitting(10 * u.min))[-1].si.position
        for one, at in ((planet, later), (planet, start), (ba.Planet(EARTH, ba.Orbit(60000 * u.km, 0.2)), later))
    ]
    assert np.abs(ends[0] - ends[1]).max() > 1e-2
    np.testing.assert_array_equal(ends[1], ends[2])  # without an epoch each run begins there


def test_angles_of_the_ecliptic() -> None:
    """A pole of the ecliptic seen in ICRF: an orbit in it is one that is inclined by the obliquity."""
    given, state = ba.catalogue.load("didymos")
    assert state.frame == "ICRF"
    tilted = ba.Orbit(60000 * u.km, 0.2, 84381.406 * u.arcsec, argument_of_periapsis=50 * u.deg)
    flat = ba.Orbit(60000 * u.km, 0.2, argument_of_periapsis=50 * u.deg)
    one, two = (
        ba.propagate(with_forces(given, planet), state, duration=6 * u.h, integrator=ba.Splitting(10 * u.min))[-1]
        for planet in (ba.Planet(EARTH, tilted), ba.Planet(EARTH, flat, ecliptic=True))
    )
    np.testing.assert_allclose(one.si.position, two.si.position, atol=1e-9)


def test_an_accuracy_with_the_sun(tumbling: tuple[ba.System, ba.State]) -> None:
    given, state = ba.catalogue.load("didymos")
    system = with_forces(given, SUN, ba.TidalTorque("Didymos", "Dimorphos", 0.01, time_lag=10 * u.s))
    run = ba.propagate(system, state, duration=5 * u.day, accuracy=1e-8)
    exact = ba.propagate(system, state, duration=5 * u.day, integrator=ba.Splitting(150 * u.s, scheme="ss10"))
    error = np.linalg.norm(run.si.position[-1] - exact.si.position[-1], axis=1).max()
    assert 0 < run.estimated_error < 1e-8
    assert error < 1e-8 * 1184


def test_several_bodies_and_one_that_does_not_pull() -> None:
    """A grain of dust goes where a mass without weight would, with the Sun and the Earth at work."""
    given, state = four_bodies(point=1e-3)
    bodies = [*given.bodies[:3], ba.RigidBody("dust", ba.Point(), mass=1e-3 * u.kg, pulls=False)]
    method = ba.Splitting(120 * u.s)
    ends = []
    for some in (given.bodies, bodies):
        system = ba.System(some, gravity=ba.SecondDegree(), perturbations=[SUN, NEAR])
        run = ba.propagate(system, state, duration=6 * u.h, integrator=method)
        assert run.max_relative_angular_momentum_error < 1e-14
        assert run.max_relative_linear_momentum_error < 1e-14
        ends.append(run[-1].si.position)
    np.testing.assert_allclose(ends[0], ends[1], rtol=0, atol=1e-9)
    alone = ba.System(bodies, gravity=ba.SecondDegree())
    end = ba.propagate(alone, state, duration=6 * u.h, integrator=method)[-1].si.position
    assert np.abs(end - ends[1]).max() > 1


def test_both_faces_of_a_plate_are_alike() -> None:
    given, state = ba.catalogue.load("didymos")
    ends = []
    for sign in (1, -1):
        plate = ba.RadiationPressure(
            "Dimorphos",
            SUN,
            area=1e4 * u.km**2,
            normal=[sign * 0.3, sign * 0.4, sign * 0.9],
            specular=0.3,
            diffuse=0.2,
            point=[5, 0, 1] * u.m,
        )
        system = with_forces(given, plate)
        ends.append(ba.propagate(system, state, duration=6 * u.h, integrator=ba.Splitting(5 * u.min))[-1].si)
    np.testing.assert_allclose(ends[0].position, ends[1].position, atol=1e-9)
    np.testing.assert_allclose(ends[0].attitude, ends[1].attitude, atol=1e-11)
    alone = ba.propagate(given, state, duration=6 * u.h, integrator=ba.Splitting(5 * u.min))[-1].si
    assert np.abs(ends[0].position - alone.position).max() > 1


def test_yorp_and_byorp_have_the_rates_they_are_given() -> None:
    bodies = [
        ba.RigidBody(name, ba.Sphere(radius * u.m), density=2400 * u.kg / u.m**3)
        for name, radius in (("A", 400.0), ("B", 60.0))
    ]
    rate, push = 1e-12, 1e-2  # rad/s2, N
    acting = [ba.Yorp("A", acceleration=rate * u.rad / u.s**2), ba.Byorp("B", "A", push * u.N)]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=acting)
    state = ba.State.from_elements(system, semi_major_axis=1500 * u.m, eccentricity=0, spins=[3 * u.h, 12 * u.h])
    run = ba.propagate(system, state, duration=5 * u.day, integrator=ba.Splitting(10 * u.min))
    spun = (run.si.spin[-1, 0, 2] - run.si.spin[0, 0, 2]) / run.si.time[-1]
    assert spun == pytest.approx(rate, rel=1e-8)
    x, v = (array[:, 1] - array[:, 0] for array in (run.si.position, run.si.velocity))
    gm = sum(body.si.gm for body in bodies)
    a = 1 / (2 / np.linalg.norm(x, axis=1) - np.sum(v**2, axis=1) / gm)
    grown = (a[-1] - a[0]) / run.si.time[-1]
    of_light_secondary = 2 * push / (bodies[1].si.mass * np.sqrt(gm / 1500**3))
    assert grown == pytest.approx(of_light_secondary, rel=5e-3)


@pytest.mark.parametrize(
    "acting",
    [
        SUN,
        NEAR,
        PLANET,
        TIDE,
        ba.Yorp("A", torque=3 * u.N * u.m),
        ba.Byorp("B", "A", 2 * u.N),
        ba.RadiationPressure("B", SUN, area=3 * u.m**2, normal=[0, 0, 2], specular=0.1, point=[0, 1, 0] * u.m),
        ba.RadiationPressure("B", SUN, area=3 * u.m**2, coefficient=1.2),
        ba.ThirdBody(EARTH, np.arange(8) * u.day, np.full((8, 3), 1e6) * u.km),
        ba.Force(drag, [1.0, 2.0]),
        ba.ExternalPotential(spring, [1.0, 1e-6]),
    ],
    ids=lambda acting: type(acting).__name__,
)
def test_pickled_and_in_a_file(tumbling: tuple[ba.System, ba.State], acting: object, tmp_path: Path) -> None:
    given, state = tumbling
    system = with_forces(given, acting)
    run = ba.propagate(system, state, duration=2 * u.h, integrator=ba.LGVI(60 * u.s))
    run.write(tmp_path / "run.h5")
    read = ba.Trajectory.read(tmp_path / "run.h5")
    assert same(read, run)
    assert repr(read.system.perturbations) == repr(system.perturbations)
    for other in (pickle.loads(pickle.dumps(system)), read.system):
        again = ba.propagate(other, state, duration=2 * u.h, integrator=ba.LGVI(60 * u.s))
        assert same(again, run)


@pytest.mark.parametrize("method", [ba.RungeKutta(), ba.Taylor()])
def test_others_refuse(tumbling: tuple[ba.System, ba.State], method: object) -> None:
    given, state = tumbling
    with pytest.raises(InputError, match=f"^{type(method).__name__}: it takes no perturbations: take ba.LGVI or"):
        ba.propagate(with_forces(given, SUN), state, duration=1 * u.h, integrator=method)


def test_a_force_that_is_not_a_number(tumbling: tuple[ba.System, ba.State]) -> None:
    given, state = tumbling
    with pytest.raises(InputError, match=r"^Force pushed: what it exerts at the start is not a number$"):
        ba.propagate(
            with_forces(given, ba.Force(pushed, [1.0, 0.0])), state, duration=1 * u.h, integrator=ba.LGVI(60 * u.s)
        )
    for method in STEPS.values():
        with pytest.warns(EndWarning, match=r"^the run ended after [0-9.]+ s: .*or a force are not numbers any more"):
            run = ba.propagate(
                with_forces(given, ba.Force(pushed, [1.0, 3000.0])), state, duration=2 * u.h, integrator=method
            )
        assert run.status == "failed"
        assert 2000 <= run.si.time[-1] <= 3000
        assert np.all(np.isfinite(run.si.position))


def table(begin: float, end: float) -> ba.ThirdBody:
    """Return a distant mass that stands still, known from one day to another."""
    return ba.ThirdBody(EARTH, np.linspace(begin, end, 9) * u.day, np.full((9, 3), 1e6) * u.km)


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ba.Sun(1.6 * u.au), "Sun: orbit: expected a ba.Orbit, got"),
        (lambda: ba.Sun(ba.Orbit(1.6 * u.au), epoch="2022"), "Sun: epoch: expected an astropy Time, got"),
        (lambda: ba.Planet(-EARTH, ba.Orbit(1 * u.au)), "Planet: gm: expected a positive value"),
        (lambda: ba.Flyby(EARTH, 6000 * u.km, 8 * u.km / u.s, 1 * u.h, radius=6378 * u.km), "Flyby: it hits: the dist"),
        (lambda: ba.Flyby(EARTH, 6000 * u.km, 0 * u.km / u.s, 1 * u.h), "Flyby: speed: expected a positive value"),
        (lambda: ba.TidalTorque("A", "B", 0.1, quality_factor=-3), "TidalTorque: quality_factor: expected at least 1"),
        (lambda: ba.TidalTorque("A", "B", -0.1, quality_factor=3), "TidalTorque: love_number: expected at least 0"),
        (lambda: ba.TidalTorque("A", "B", 0.1), "give exactly one of quality_factor= and time_lag="),
        (lambda: ba.Yorp("A"), "Yorp: give exactly one of torque= and acceleration="),
        (lambda: ba.RadiationPressure("A", SUN, area=1 * u.m**2), "give exactly one of coefficient= .* and normal="),
        (lambda: ba.RadiationPressure("A", SUN, area=1 * u.m**2, normal=[0, 0, 0]), "a vector that is not zero"),
        (lambda: ba.ThirdBody(EARTH, [0, 1, 1] * u.day, np.ones((3, 3)) * u.au), "expected at least 6 that grow"),
        (lambda: ba.Force(lambda: 0), "is not compiled: decorate it with @ba.force"),
        (lambda: ba.Force(spring), "is not compiled: decorate it with @ba.force"),
        (lambda: ba.force(lambda p, t: None), "cannot be compiled: .*expected 8 arguments"),
    ],
)
def test_bad_arguments(make: Callable[[], object], says: str) -> None:
    with pytest.raises(InputError, match=says) as raised:
        make()
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("acting", "says"),
    [
        (SUN, None),
        ([3], "perturbations: expected such as ba.Sun"),
        ([ba.TidalTorque("A", "C", 0.1, quality_factor=3)], "TidalTorque: raised_by: 'C' is no body of this system"),
        ([ba.TidalTorque("A", "A", 0.1, quality_factor=3)], "TidalTorque: A is named twice"),
        ([ba.Yorp("a", torque=1 * u.N * u.m)], "Yorp: body: 'a' is no body .*it has A, B"),
        ([ba.Byorp("B", "Didymos", 1 * u.N)], "Byorp: about: 'Didymos' is no body"),
        ([ba.RadiationPressure("X", SUN, area=1 * u.m**2, coefficient=1)], "RadiationPressure: body: 'X' is no body"),
    ],
)
def test_bad_systems(tumbling: tuple[ba.System, ba.State], acting: object, says: str | None) -> None:
    given, _ = tumbling
    says = says or r"perturbations: expected a list such as \[ba.Sun"
    with pytest.raises(InputError, match=says) as raised:
        ba.System(given.bodies, perturbations=acting)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("acting", "says"),
    [
        (ba.Sun(ba.Orbit(1 * u.km)), "^Sun: it comes within 1000 m of the barycentre, where the bodies are up to"),
        (ba.Sun(ba.Orbit(10 * u.km, 0.95)), "^Sun: it comes within 500 m of the barycentre"),
        (ba.Flyby(EARTH, 700 * u.m, 8 * u.km / u.s, 1 * u.h), "^Flyby: it comes within 700 m of the barycentre"),
        (table(0, 1e-2), "^ThirdBody: its times go from 0 s to 864 s of the run, .* expected a table that covers it$"),
        (table(0.01, 1), "^ThirdBody: its times go from 864 s"),
        (ba.Sun(ba.Orbit(1 * u.au), ecliptic=True), "^Sun: ecliptic=True needs axes that are known: .* got 'local'$"),
        (ba.Sun(ba.Orbit(1 * u.au), epoch=Time("2022-01-01")), "^Sun: it has an epoch, the state has none: give"),
    ],
)
def test_bad_starts(tumbling: tuple[ba.System, ba.State], acting: object, says: str) -> None:
    given, state = tumbling
    for how in ({"integrator": ba.LGVI(60 * u.s)}, {"accuracy": 1e-6}):
        with pytest.raises(InputError, match=says) as raised:
            ba.propagate(with_forces(given, acting), state, duration=2 * u.h, **how)
        assert "\n" not in str(raised.value)
