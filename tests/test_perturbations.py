"""What acts from outside, against equations that are written out here once more, closed forms and balances."""

import pickle
from typing import Any

import astropy.units as u
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.errors import InputError
from binaryast.perturbations.distant import GM_SUN

ORBIT = ba.Orbit(1.6442 * u.au, eccentricity=0.38385, inclination=20 * u.deg, mean_anomaly=40 * u.deg)
SUN = ba.Sun(ORBIT)
GM_EARTH = 3.986004355e14
FLYBY = ba.Flyby(
    GM_EARTH * u.m**3 / u.s**2, 30000 * u.km, 6 * u.km / u.s, 5 * u.h, inclination=30 * u.deg, radius=6378 * u.km
)
TIDE = ba.TidalTorque("Didymos", "Dimorphos", 0.1, quality_factor=10)


def didymos(*perturbations: Any, gravity: Any = None) -> tuple[ba.System, ba.State]:
    system, state = ba.catalogue.load("didymos")
    return ba.System(system.bodies, gravity=gravity or ba.SecondDegree(), perturbations=perturbations), state


def spheres(*perturbations: Any) -> tuple[ba.System, ba.State]:
    bodies = [
        ba.RigidBody("one", ba.Sphere(400 * u.m), mass=5e11 * u.kg),
        ba.RigidBody("two", ba.Sphere(80 * u.m), mass=5e9 * u.kg),
    ]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=perturbations)
    return system, ba.State.circular_orbit(system, separation=1.2 * u.km, spins=[3 * u.h, 5 * u.h])


def balances(run: ba.Trajectory) -> tuple[float, float, float]:
    """Return how far energy, linear and angular momentum of the rows are from what they should be."""
    energy = (run.energy - run.energy[0] - run.work).value / run.energy[0].value
    linear = (run.linear_momentum - run.linear_momentum[0] - run.impulse).value
    angular = (run.angular_momentum - run.angular_momentum[0] - run.angular_impulse).value
    size = np.linalg.norm(run.angular_momentum[0].value)
    momentum = np.sum([b.si.mass for b in run.system.bodies] * np.linalg.norm(run.si.velocity[0], axis=-1))
    return np.abs(energy).max(), np.abs(linear).max() / momentum, np.abs(angular).max() / size


def sun_at(time: float, gm: float) -> np.ndarray:
    """Return where the Sun is, by Kepler's equation solved anew."""
    a, e, i = 1.6442 * u.au.to(u.m), 0.38385, np.radians(20)
    mean = np.radians(40) + np.sqrt(gm / a**3) * time
    E = mean
    for _ in range(50):
        E = E - (E - e * np.sin(E) - mean) / (1 - e * np.cos(E))
    x, y = a * (np.cos(E) - e), a * np.sqrt(1 - e * e) * np.sin(E)
    return -np.array([x, y * np.cos(i), y * np.sin(i)])


def test_points_with_the_sun_against_plain_differences() -> None:
    """The Sun's pull on each body less that on the barycentre, as it stands: 5e-8 of it are lost."""
    bodies = [ba.RigidBody(n, ba.Point(), mass=m * u.kg) for n, m in (("one", 5e11), ("two", 5e10))]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=[SUN])
    state = ba.State.from_elements(system, semi_major_axis=40 * u.km, eccentricity=0.1, spins=["none", "none"])
    gm = np.array([b.si.gm for b in bodies])

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        x, v = y[:6].reshape(2, 3), y[6:].reshape(2, 3)
        s = sun_at(t, GM_SUN + gm.sum())
        apart = x[1] - x[0]
        pull = apart / np.linalg.norm(apart) ** 3
        a = np.array([gm[1] * pull, -gm[0] * pull])
        for k in range(2):
            a[k] += GM_SUN * ((s - x[k]) / np.linalg.norm(s - x[k]) ** 3 - s / np.linalg.norm(s) ** 3)
        return np.concatenate([v.ravel(), a.ravel()])

    start = np.concatenate([state.si.position.ravel(), state.si.velocity.ravel()])
    end = 60 * 86400.0
    exact = solve_ivp(rates, (0, end), start, method="DOP853", rtol=1e-13, atol=1e-9).y[:6, -1].reshape(2, 3)
    plain = ba.System(bodies, gravity=ba.PointMass())
    for integrator in (ba.Splitting(4 * u.h, "ss10"), ba.KeplerSplitting(6 * u.h), ba.LGVI(2 * u.h, order=8)):
        run, without = (ba.propagate(one, state, duration=end * u.s, integrator=integrator) for one in (system, plain))
        wrong = np.linalg.norm(run.si.position[-1] - exact) / 40e3
        moved = np.linalg.norm(run.si.position[-1] - without.si.position[-1]) / 40e3
        assert wrong < 3e-9 * max(1.0, moved)
        assert moved > 1e5 * wrong


def test_the_tide_loses_no_digits() -> None:
    """Twice the distance from the barycentre, twice the tide, to the last digits: of 1e-8 of the Sun's distance."""
    from binaryast.kernels.external.third_body import potential
    from binaryast.perturbations.base import Span

    bodies = [ba.RigidBody(n, ba.Point(), mass=1 * u.kg) for n in ("one", "two")]
    p = SUN.parameters(bodies, Span(0.0, 1.0, None, "local"))
    x = np.array([[3.0, -2.0, 1.0], [6.0, -4.0, 2.0]])
    force, torque = np.zeros((2, 3)), np.zeros((2, 3))
    potential(p, 0.0, x, np.array([np.eye(3)] * 2), force, torque)
    np.testing.assert_allclose(force[1], 2 * force[0], rtol=1e-9)
    s = sun_at(0.0, GM_SUN)
    first = GM_SUN / np.linalg.norm(s) ** 3 * (3 * (x[0] @ s) * s / (s @ s) - x[0])
    np.testing.assert_allclose(force[0], first, rtol=1e-9)


def test_a_flyby_turns_bodies_and_moves_them() -> None:
    """Against Euler's equations with MacCullagh's force and torque, written out here, for bodies of second degree."""
    bodies = [
        ba.RigidBody("one", ba.Ellipsoid(400 * u.m, 300 * u.m, 200 * u.m), mass=5e11 * u.kg),
        ba.RigidBody("two", ba.Ellipsoid(90 * u.m, 70 * u.m, 50 * u.m), mass=5e10 * u.kg),
    ]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=[FLYBY])
    state = ba.State.circular_orbit(system, separation=3 * u.km, spins=[6 * u.h, 9 * u.h])
    gm, mass = np.array([b.si.gm for b in bodies]), np.array([b.si.mass for b in bodies])
    J = [np.diag(b.si.moments) for b in bodies]
    both = GM_EARTH + gm.sum()
    speed = np.sqrt(6000.0**2 + 2 * both / 3e7)
    plane = Rotation.from_euler("x", 30, degrees=True).as_matrix()
    planet = -3e7 * plane[:, 0], -speed * plane[:, 1]  # at the closest
    back = solve_ivp(
        lambda t, y: np.concatenate([y[3:], -both * y[:3] / np.linalg.norm(y[:3]) ** 3]),
        *((0, -5 * 3600.0), np.concatenate(planet)),
        method="DOP853",
        rtol=1e-13,
        atol=1e-6,
    ).y[:, -1]

    def rates(t: float, y: np.ndarray) -> np.ndarray:
        x, v, q, w = y[:6].reshape(2, 3), y[6:12].reshape(2, 3), y[12:20].reshape(2, 4), y[20:26].reshape(2, 3)
        s, sdot = y[26:29], y[29:]
        apart = x[1] - x[0]
        pull = apart / np.linalg.norm(apart) ** 3
        a = np.array([gm[1] * pull, -gm[0] * pull])
        dq, dw = np.empty((2, 4)), np.empty((2, 3))
        for k in range(2):
            R = Rotation.from_quat(q[k]).as_matrix()
            d = s - x[k]
            r = np.linalg.norm(d)
            inertia = R @ J[k] @ R.T
            a[k] += GM_EARTH * (d / r**3 - s / np.linalg.norm(s) ** 3)
            second = 1.5 * (np.trace(J[k]) - 5 * d @ inertia @ d / r**2) * d / r**5 + 3 * inertia @ d / r**5
            a[k] += GM_EARTH * second / mass[k]
            torque = R.T @ (3 * GM_EARTH / r**5 * np.cross(d, inertia @ d))
            dw[k] = np.linalg.solve(J[k], torque - np.cross(w[k], J[k] @ w[k]))
            vector, scalar = q[k, :3], q[k, 3]
            dq[k] = 0.5 * np.append(scalar * w[k] + np.cross(vector, w[k]), -vector @ w[k])
        of_planet = -both * s / np.linalg.norm(s) ** 3
        return np.concatenate([v.ravel(), a.ravel(), dq.ravel(), dw.ravel(), sdot, of_planet])

    quaternions = Rotation.from_matrix(state.si.attitude.copy()).as_quat()
    start = [state.si.position.ravel(), state.si.velocity.ravel(), quaternions.ravel(), state.si.spin.ravel(), back]
    end = 10 * 3600.0
    exact = solve_ivp(rates, (0, end), np.concatenate(start), method="DOP853", rtol=1e-12, atol=1e-9).y[:, -1]
    errors = []
    for integrator in (ba.LGVI(60 * u.s), ba.LGVI(30 * u.s), ba.Splitting(10 * u.min, "ss10")):
        run = ba.propagate(system, state, duration=end * u.s, integrator=integrator)
        place = np.linalg.norm(run.si.position[-1] - exact[:6].reshape(2, 3)) / 3e3
        turned = Rotation.from_quat(exact[12:20].reshape(2, 4)).inv() * Rotation.from_matrix(run.si.attitude[-1].copy())
        errors.append((place, float(turned.magnitude().max())))
    assert errors[-1][0] < 1e-8
    assert errors[-1][1] < 1e-8
    np.testing.assert_allclose(np.divide(errors[0], errors[1]), 4, rtol=0.05)  # second order, in both
    still = ba.propagate(*didymos_like(bodies, state), duration=end * u.s, integrator=ba.Splitting(10 * u.min, "ss10"))
    assert np.linalg.norm(still.si.position[-1] - exact[:6].reshape(2, 3)) > 1.0  # metres, by the Earth


def didymos_like(bodies: list[ba.RigidBody], state: ba.State) -> tuple[ba.System, ba.State]:
    return ba.System(bodies, gravity=ba.PointMass()), state


@pytest.mark.parametrize(
    "integrator",
    [
        ba.LGVI(60 * u.s),
        ba.LGVI(60 * u.s, frame="inertial"),
        ba.Splitting(10 * u.min),
        ba.Splitting(10 * u.min, frame="inertial"),
        ba.KeplerSplitting(20 * u.min),
    ],
)
def test_what_is_given_is_what_is_had(integrator: Any) -> None:
    """GUBAS's set in one run: the Sun, a flyby, Hill's tide, a tidal torque; the strong tide takes much of the spin."""
    hill = ba.Sun(ORBIT, first_term_only=True)
    run = ba.propagate(*didymos(SUN, hill, FLYBY, TIDE), duration=1 * u.day, integrator=integrator)
    energy, linear, angular = balances(run)
    assert energy < (4e-6 if isinstance(integrator, ba.LGVI) else 3e-9)  # of second order, of what the spin loses
    assert linear < 1e-14
    assert angular < 1e-14
    assert np.abs(run.si.work).max() > 1e-7 * abs(run.energy[0].value)
    assert run.max_relative_energy_error == pytest.approx(energy, rel=0.5)


def test_both_frames_are_the_same_map() -> None:
    one, two = (
        ba.propagate(*didymos(SUN, FLYBY, TIDE), duration=1 * u.day, integrator=ba.LGVI(60 * u.s, frame=frame))
        for frame in ("relative", "inertial")
    )
    np.testing.assert_allclose(one.si.position[-1], two.si.position[-1], atol=1e-6)
    np.testing.assert_allclose(one.si.attitude[-1], two.si.attitude[-1], atol=1e-9)
    np.testing.assert_allclose(one.si.work[-1], two.si.work[-1], rtol=1e-6)


@ba.force
def drag(p: Any, t: float, position: Any, velocity: Any, attitude: Any, spin: Any, force: Any, torque: Any) -> None:
    for i in range(2):
        for k in range(3):
            force[i, k] -= p[0] * velocity[i, k]
            torque[i, k] -= p[1] * spin[i, k]


@ba.force
def late(p: Any, t: float, position: Any, velocity: Any, attitude: Any, spin: Any, force: Any, torque: Any) -> None:
    if t > p[0]:
        force[1, 0] += np.nan


@ba.external_potential
def swing(p: Any, t: float, position: Any, attitude: Any, force: Any, torque: Any) -> tuple[float, float]:
    force[1, 0] += p[0] * np.cos(p[1] * t)
    return -p[0] * np.cos(p[1] * t) * position[1, 0], p[0] * p[1] * np.sin(p[1] * t) * position[1, 0]


@pytest.mark.parametrize("frame", ["relative", "inertial"])
def test_no_friction_is_no_difference(frame: str) -> None:
    """In no bit, but for sums that are rounded once where the compiler fuses them, which depends on what it sees."""
    nothing = [ba.TidalTorque("Didymos", "Dimorphos", 0.0, quality_factor=10), ba.Force(drag, [0.0, 0.0])]
    one, two = (
        ba.propagate(*didymos(*some), duration=1 * u.day, integrator=ba.LGVI(60 * u.s, frame=frame))
        for some in ([], nothing)
    )
    for name in ("position", "velocity", "attitude", "spin", "potential_energy"):
        size = np.abs(getattr(one.si, name)).max()
        np.testing.assert_allclose(getattr(one.si, name), getattr(two.si, name), rtol=0, atol=1e-14 * size)


def test_friction_and_a_potential_that_swings_are_balanced_to_the_methods_order() -> None:
    system, state = didymos(ba.Force(drag, [1e3, 1e8]), ba.ExternalPotential(swing, [50.0, 3e-4]))
    found = []
    for step in (120, 60, 30):
        run = ba.propagate(system, state, duration=0.5 * u.day, integrator=ba.LGVI(step * u.s), save_every=1 * u.h)
        energy, linear, angular = balances(run)
        assert linear < 1e-13
        assert angular < 1e-13
        found.append(energy)
    assert 3.5 < found[0] / found[1] < 4.5
    assert 3.5 < found[1] / found[2] < 4.5


@pytest.mark.parametrize("lag", [{"quality_factor": 20.0}, {"time_lag": 60 * u.s}])
def test_tides_change_spin_and_orbit_as_the_textbooks_say(lag: dict[str, Any]) -> None:
    """dOmega/dt and da/dt of two spheres (Murray and Dermott, section 4.9; Mignard's with 1/Q = 2 (Omega - n) dt)."""
    tide = ba.TidalTorque("one", "two", 0.5, **lag)
    system, state = spheres(tide)
    one, two = system.bodies
    duration = 30 * 86400.0
    run = ba.propagate(system, state, duration=duration * u.s, integrator=ba.Splitting(20 * u.min))
    a, R = 1200.0, 400.0
    gm = one.si.gm + two.si.gm
    n, spin = np.sqrt(gm / a**3), 2 * np.pi / (3 * 3600)
    inverse = 1 / 20 if "quality_factor" in lag else 2 * (spin - n) * 60
    torque = 1.5 * 0.5 * inverse * ba.constants.G * two.si.mass**2 * R**5 / a**6
    slowed = (run.si.spin[-1, 0, 2] - run.si.spin[0, 0, 2]) / duration
    assert slowed == pytest.approx(-torque / one.si.moments[2], rel=0.01)
    reduced = one.si.mass * two.si.mass / (one.si.mass + two.si.mass)
    x, v = (np.diff(array[[0, -1]], axis=1)[:, 0] for array in (run.si.position, run.si.velocity))
    axis = 1 / (2 / np.linalg.norm(x, axis=1) - np.sum(v * v, axis=1) / gm)
    assert (axis[1] - axis[0]) / duration == pytest.approx(2 * torque / (reduced * n * a), rel=0.01)


def test_byorp_and_yorp_do_what_they_say() -> None:
    byorp, yorp = ba.Byorp("two", "one", 0.5 * u.N), ba.Yorp("one", acceleration=-1e-12 * u.rad / u.s**2)
    system, state = spheres(byorp, yorp)
    run = ba.propagate(system, state, duration=20 * u.day, integrator=ba.Splitting(20 * u.min))
    change = run.si.spin[-1, 0, 2] - run.si.spin[0, 0, 2]
    assert change == pytest.approx(-1e-12 * 20 * 86400, rel=1e-6)
    x, v = (np.diff(array[[0, -1]], axis=1)[:, 0] for array in (run.si.position, run.si.velocity))
    gm = sum(body.si.gm for body in system.bodies)
    axis = 1 / (2 / np.linalg.norm(x, axis=1) - np.sum(v * v, axis=1) / gm)
    n = np.sqrt(gm / 1200.0**3)
    assert (axis[1] - axis[0]) / (20 * 86400) == pytest.approx(2 * 0.5 / (system.bodies[1].si.mass * n), rel=0.01)


def craft(mass: float, *, pulls: bool = True) -> tuple[ba.System, ba.State]:
    """Return Didymos with a spacecraft: a box with the moments of its mass."""
    system, state = ba.catalogue.load("didymos")
    inertia = mass * np.array([0.5, 1.2, 1.5]) * u.kg * u.m**2
    box = ba.RigidBody("craft", ba.Ellipsoid(2 * u.m, 1 * u.m, 1 * u.m), mass=mass * u.kg, inertia=inertia, pulls=pulls)
    whole = ba.System([*system.bodies, box], gravity=ba.SecondDegree())
    position = np.vstack([state.si.position, [4000.0, 100.0, 300.0]]) * u.m
    velocity = np.vstack([state.si.velocity, [0.0, 0.02, 0.09]]) * u.m / u.s
    attitude = np.concatenate([state.si.attitude, Rotation.from_euler("xyz", [0.3, 0.2, 0.1]).as_matrix()[None]])
    spin = np.vstack([state.si.spin, [1e-4, 2e-4, 3e-4]]) * u.rad / u.s
    return whole, ba.State(position, velocity, attitude, spin)


def test_a_light_craft_keeps_all_its_digits() -> None:
    """A mass of 1e-11 of the primary, and one that does not pull at all, move alike; the others do as without it."""
    integrator = ba.Splitting(20 * u.min, "ss10")
    heavy, light, none = (
        ba.propagate(*craft(mass, pulls=pulls), duration=5 * u.day, integrator=integrator)
        for mass, pulls in ((1e4, True), (10.0, True), (10.0, False))
    )
    for one, apart in ((heavy, 1e-6), (light, 1e-9)):
        # 1e4 kg move the others by 1e-8 of their distance, and feel that; 10 kg by 1e-11
        assert np.linalg.norm(one.si.position[-1, 2] - none.si.position[-1, 2]) / 4000 < apart
        np.testing.assert_allclose(one.si.attitude[-1, 2], none.si.attitude[-1, 2], atol=1e2 * apart)
    system, state = ba.catalogue.load("didymos")
    alone = ba.propagate(
        ba.System(system.bodies), state, duration=5 * u.day, integrator=ba.Splitting(20 * u.min, "ss10", "inertial")
    )
    np.testing.assert_array_equal(none.si.position[-1, :2], alone.si.position[-1])
    assert none.max_relative_energy_error == alone.max_relative_energy_error


def test_one_body_of_a_pair_may_not_pull() -> None:
    """A point that only feels a planet moves on Kepler's ellipse about it, and the planet stays where it is."""
    planet = ba.RigidBody("planet", ba.Sphere(500 * u.m), mass=1e12 * u.kg)
    grain = ba.RigidBody("grain", ba.Point(), mass=1 * u.g, pulls=False)
    system = ba.System([planet, grain], gravity=ba.PointMass())
    gm = planet.si.gm
    state = ba.State(
        [[0, 0, 0], [2000, 0, 0]] * u.m,
        [[0, 0, 0], [0, np.sqrt(gm / 2000), 0]] * u.m / u.s,
        [np.eye(3)] * 2,
        np.zeros((2, 3)) * u.rad / u.s,
    )
    period = 2 * np.pi * np.sqrt(2000.0**3 / gm)
    run = ba.propagate(system, state, duration=period * u.s, integrator=ba.Splitting(period / 60 * u.s))
    np.testing.assert_allclose(run.si.position[-1], state.si.position, atol=1e-4)
    np.testing.assert_array_equal(run.si.position[:, 0], 0)


def test_legs_go_on_in_time_with_the_sun() -> None:
    """An impulse of nothing changes next to nothing: the second leg knows when it begins.

    It counts places from its own barycentre, which the planet has moved by 15 m from the first leg's.
    """
    system, state = didymos(FLYBY)
    nothing = ba.Impulse(4 * u.h, [0, 0, 0] * u.m / u.s, "Dimorphos")
    one, two = (
        ba.propagate(system, state, duration=12 * u.h, integrator=ba.LGVI(60 * u.s), impulses=some)
        for some in ([], [nothing])
    )
    np.testing.assert_allclose(one.si.position[-1], two.si.position[-1], atol=1e-3)
    np.testing.assert_allclose(one.si.work[-1], two.si.work[-1], rtol=1e-4)
    again = ba.retrace(one, 8.01 * u.h)
    np.testing.assert_allclose(again.si.position, one.at(8.01 * u.h).si.position, atol=1e-3)


def test_a_table_is_as_good_as_the_orbit() -> None:
    system, _ = didymos(SUN)
    times = np.linspace(-1, 12, 400) * u.day
    gm = GM_SUN + sum(body.si.gm for body in system.bodies)
    places = [sun_at(float(t), gm) for t in times.to_value(u.s)] * u.m
    table = ba.ThirdBody(GM_SUN * u.m**3 / u.s**2, times, places)
    integrator = ba.KeplerSplitting(30 * u.min)
    one, two = (ba.propagate(*didymos(distant), duration=10 * u.day, integrator=integrator) for distant in (SUN, table))
    np.testing.assert_allclose(one.si.position[-1], two.si.position[-1], atol=1e-8)


def test_an_accuracy_with_the_sun(tmp_path: Any) -> None:
    system, state = didymos(SUN, TIDE)
    run = ba.propagate(system, state, duration=10 * u.day, accuracy=1e-8)
    reference = ba.propagate(system, state, duration=10 * u.day, integrator=ba.Splitting(10 * u.min, "ss10"))
    assert np.linalg.norm(run.si.position[-1] - reference.si.position[-1]) / 1184 < 1e-8
    assert "from outside: Sun, TidalTorque" in run.summary()
    back = ba.Trajectory.read(run.write(tmp_path / "sun.h5"))
    assert repr(back.system.perturbations) == repr(run.system.perturbations)
    np.testing.assert_array_equal(back.si.work, run.si.work)
    again = pickle.loads(pickle.dumps(system))
    same = ba.propagate(again, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    other = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    np.testing.assert_array_equal(same.si.position, other.si.position)


def test_light_pushes_a_ball_and_turns_a_plate() -> None:
    system, state = craft(500.0)
    ball = ba.RadiationPressure("craft", SUN, 10 * u.m**2, coefficient=1.5)
    plate = ba.RadiationPressure("craft", SUN, 10 * u.m**2, normal=[1, 0, 0], specular=1.0, point=[0, 1, 0] * u.m)
    s = sun_at(0.0, GM_SUN)
    pressure = 3.828e26 / (4 * np.pi * 299792458 * (s @ s))
    run = ba.propagate(
        ba.System(system.bodies, perturbations=[ball]), state, duration=100 * u.s, integrator=ba.LGVI(10 * u.s)
    )
    np.testing.assert_allclose(run.si.impulse[-1], -100 * pressure * 15 * s / np.linalg.norm(s), rtol=1e-4)
    run = ba.propagate(
        ba.System(system.bodies, perturbations=[plate]), state, duration=0.01 * u.s, integrator=ba.LGVI(0.01 * u.s)
    )
    normal = state.si.attitude[2] @ [1, 0, 0]
    cosine = normal @ s / np.linalg.norm(s)
    np.testing.assert_allclose(run.si.impulse[-1], -0.01 * pressure * 20 * abs(cosine) * cosine * normal, rtol=1e-3)
    assert run.si.spin[-1, 2, 2] - state.si.spin[2, 2] != 0


def run_with(*perturbations: Any, **arguments: Any) -> Any:
    system, state = didymos(*perturbations)
    arguments = {"integrator": ba.LGVI(60 * u.s), "duration": 1 * u.day} | arguments
    return ba.propagate(system, state, **arguments)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: run_with(ba.Sun(ba.Orbit(800 * u.m))), "comes within 800 m of the barycentre"),
        (lambda: ba.Flyby(1e14 * u.m**3 / u.s**2, 6000 * u.km, 8 * u.km / u.s, 1 * u.h, radius=6378 * u.km), "it hits"),
        (lambda: ba.TidalTorque("Didymos", "Dimorphos", 0.1, quality_factor=-3), "expected at least 1 .* got -3"),
        (lambda: ba.TidalTorque("Didymos", "Dimorphos", -0.1, quality_factor=3), "expected at least 0, got -0.1"),
        (lambda: ba.TidalTorque("Didymos", "Dimorphos", 0.1), "exactly one of quality_factor= and time_lag="),
        (lambda: didymos(ba.TidalTorque("Didymos", "Dimorfos", 0.1, quality_factor=3)), "did you mean 'Dimorphos'"),
        (lambda: run_with(ba.Force(late, [-1.0])), "Force late: what it exerts at the start is not a number"),
        (lambda: ba.Force(len), "decorate it with @ba.force"),
        (lambda: ba.force(lambda p: None), "cannot be compiled"),
        (lambda: run_with(SUN, integrator=ba.RungeKutta()), "RungeKutta: it takes no perturbations: take ba.LGVI"),
        (lambda: run_with(ba.Sun(ORBIT, ecliptic=True)), None),
        (lambda: didymos(ORBIT), "System: perturbations: expected such as ba.Sun"),
        (lambda: ba.System(didymos()[0].bodies, perturbations=SUN), "expected a list such as"),
        (lambda: ba.Sun(3), "Sun: orbit: expected a ba.Orbit"),
        (lambda: ba.Yorp("Didymos"), "exactly one of torque= and acceleration="),
        (
            lambda: run_with(ba.ThirdBody(1e20 * u.m**3 / u.s**2, np.arange(8) * u.h, np.full((8, 3), 1.0) * u.au)),
            "expected a table that covers it",
        ),
    ],
)
def test_bad_input_is_one_clear_line(call: Any, message: str | None) -> None:
    if message is None:
        call()
        return
    with pytest.raises(InputError, match=message) as caught:
        call()
    assert "\n" not in str(caught.value)


def test_a_force_that_is_no_number_later_ends_the_run_with_good_rows() -> None:
    with pytest.warns(ba.errors.EndWarning, match="not numbers any more"):
        run = run_with(ba.Force(late, [3600.0]))
    assert run.status == "failed"
    assert np.all(np.isfinite(run.si.position))
    assert 0 < run.si.time[-1] <= 3660


def test_a_scenario_names_them(tmp_path: Any) -> None:
    scenario = ba.catalogue.scenario_of("cubesat") if hasattr(ba.catalogue, "scenario_of") else None
    system, state = ba.catalogue.load("cubesat")
    assert [type(one).__name__ for one in system.perturbations] == ["Sun", "RadiationPressure"]
    run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    assert run.status == "completed"
    assert scenario is None or scenario.system.perturbations
