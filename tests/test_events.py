"""Events: their times against closed forms, by every integrator; what ends a run; contact; files and scenarios."""

import json
import pickle
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import astropy.units as u
import numpy as np
import pytest
from validation.systems import four_bodies, tumbling_pair

import binaryast as ba
from binaryast import cli
from binaryast.errors import ContactError, EndWarning, InputError, UnitError
from binaryast.integrators import Integrator

A, E, START = 2000.0, 0.3, np.radians(100)  # m, 1, true anomaly
PERIAPSIS = np.radians(40)
needs_heyoka = pytest.mark.skipif(find_spec("heyoka") is None, reason="heyoka is not installed")


def kepler_pair() -> tuple[ba.System, ba.State]:
    bodies = [ba.RigidBody(n, ba.Sphere(r * u.m), mass=m * u.kg) for n, r, m in (("A", 100, 1e12), ("B", 10, 1e9))]
    system = ba.System(bodies, gravity=ba.PointMass())
    state = ba.State.from_elements(
        system,
        semi_major_axis=A * u.m,
        eccentricity=E,
        inclination=30 * u.deg,
        argument_of_periapsis=PERIAPSIS * u.rad,
        true_anomaly=START * u.rad,
        spins=[3 * u.h, 4 * u.h],
    )
    return system, state


def period(system: ba.System) -> float:
    return 2 * np.pi * (A**3 / sum(body.si.gm for body in system.bodies)) ** 0.5


P = period(kepler_pair()[0])
SIXTIETH = P / 60 * u.s
INTEGRATORS = {
    "Splitting": ba.Splitting(SIXTIETH, "ss10"),
    "Splitting inertial": ba.Splitting(SIXTIETH, "ss10", frame="inertial"),
    "KeplerSplitting": ba.KeplerSplitting(6 * SIXTIETH),
    "KeplerSplitting corrected": ba.KeplerSplitting(2 * SIXTIETH, "aba104", corrector=True),
    "LGVI": ba.LGVI(SIXTIETH, order=10),
    "RungeKutta": ba.RungeKutta(rtol=1e-12, atol=1e-12),
    "RungeKutta in steps": ba.RungeKutta(step=SIXTIETH / 2),
    "Taylor": ba.Taylor(),
}


@pytest.fixture(params=[pytest.param(n, marks=needs_heyoka) if n == "Taylor" else n for n in INTEGRATORS])
def integrator(request: pytest.FixtureRequest) -> Integrator:
    return INTEGRATORS[request.param]


def passage(true_anomaly: float) -> float:
    """Return when a true anomaly is passed first, over the period."""

    def mean(f: float) -> float:
        anomaly = 2 * np.arctan(np.sqrt((1 - E) / (1 + E)) * np.tan(f / 2))
        return float((anomaly - E * np.sin(anomaly)) / (2 * np.pi))

    return (mean(true_anomaly) - mean(START)) % 1.0


def times(run: ba.Trajectory, event: ba.events.Event, direction: int | None = None) -> np.ndarray:
    """Return the times of an event over the period."""
    found = [one for one in run.events if one.event is event and direction in (None, one.direction)]
    return np.array([one.time.value for one in found]) / P


def follow(case: tuple[ba.System, ba.State], time: float, integrator: Integrator, events: list, **more: Any) -> Any:
    return ba.propagate(*case, duration=time * u.s, integrator=integrator, events=events, **more)


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")  # long steps show a high order
def test_apsides_nodes_and_distances_against_kepler_and_a_motion_that_is_not_changed(integrator: Integrator) -> None:
    apsides, nodes = ba.events.Crossing("radial_velocity"), ba.events.PlaneCrossing()
    ascending = ba.events.PlaneCrossing([0, 0, 1], direction=1)
    distance = ba.events.Separation(1900 * u.m)
    cosine = (A * (1 - E**2) / 1900 - 1) / E
    run = follow(kepler_pair(), 3 * P, integrator, [apsides, nodes, ascending, distance])
    expected = {
        (apsides, 1): passage(0),
        (apsides, -1): passage(np.pi),
        (nodes, 1): passage(-PERIAPSIS),
        (nodes, -1): passage(np.pi - PERIAPSIS),
        (ascending, None): passage(-PERIAPSIS),
        (distance, 1): passage(np.arccos(cosine)),
        (distance, -1): passage(-np.arccos(cosine)),
    }
    tolerance = {"RungeKutta": 1e-10, "KeplerSplitting": 1e-14}.get(type(integrator).__name__, 3e-14)
    for (event, direction), first in expected.items():
        np.testing.assert_allclose(times(run, event, direction), first + np.arange(3), atol=tolerance)
    assert np.all(np.diff([one.time.value for one in run.events]) >= 0)
    plain = follow(kepler_pair(), 3 * P, integrator, [])
    for array, other in zip(run.si, plain.si, strict=True):
        np.testing.assert_array_equal(array, other)
    for one in run.events:
        if one.event is distance:
            assert one.state.separation.value == pytest.approx(1900, rel=1e-12)


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")
def test_a_double_root_and_roots_near_each_other_are_not_missed(integrator: Integrator) -> None:
    """Distances just above that of the periapsis, at it, and below it."""
    nearest = A * (1 - E)
    run = follow(
        kepler_pair(), 2.5 * P, integrator, [ba.events.Separation(nearest * (1 + x) * u.m) for x in (1e-4, 1e-8)]
    )
    for event, depth in zip(run.watched, (1e-4, 1e-8), strict=True):
        cosine = (A * (1 - E**2) / (nearest * (1 + depth)) - 1) / E
        entering, leaving = passage(-np.arccos(cosine)), passage(np.arccos(cosine))
        loose = 5e-7 if type(integrator).__name__ == "RungeKutta" else 1e-11
        np.testing.assert_allclose(times(run, event, -1), entering + np.arange(2), atol=loose)
        np.testing.assert_allclose(times(run, event, 1), leaving + np.arange(2), atol=loose)
    if type(integrator).__name__ in ("RungeKutta", "Taylor"):
        return  # their periapsis is off by more than what counts as a touch, or crosses by as much
    touch, away = ba.events.Separation(nearest * u.m), ba.events.Separation(nearest * (1 - 1e-8) * u.m)
    rising = ba.events.Separation(nearest * (1 + 1e-10) * u.m, direction=1)
    run = follow(kepler_pair(), 2.5 * P, integrator, [touch, away, rising])
    np.testing.assert_allclose(np.unique(np.round(times(run, touch), 6)), np.round(passage(0) + np.arange(2), 6))
    assert len(times(run, away)) == 0
    assert len(times(run, rising)) == 2


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")
def test_the_closest_approach_is_that_within_steps(integrator: Integrator) -> None:
    run = follow(kepler_pair(), 0.95 * P, integrator, [])
    tolerance = 1e-9 if type(integrator).__name__ == "RungeKutta" else 1e-13
    assert run.closest_approach.value == pytest.approx(A * (1 - E), rel=tolerance)
    assert run.closest_approach_time.value / P == pytest.approx(passage(0), abs=tolerance)


@pytest.mark.parametrize("value", [30, 179.99, 180, -120])
def test_angles_pass_a_value_once_a_turn_and_not_where_they_jump(value: float) -> None:
    """On a circle: the longitude in the axes of the primary, and the yaw, grow uniformly."""
    system, _ = kepler_pair()
    start = ba.State.circular_orbit(system, period=P * u.s, spins=[0.37 * P * u.s, 0.21 * P * u.s])
    longitude, yaw = (ba.events.Crossing(what, value * u.deg) for what in ("longitude", "yaw"))
    run = follow((system, start), 4 * P, ba.Splitting(SIXTIETH, "ss10"), [longitude, yaw])
    turn = value / 360
    for event, rate, sign in ((longitude, 1 - 1 / 0.37, -1), (yaw, 1 / 0.21 - 1, 1)):
        offset = 0.5 if event is longitude and start.si.position[1, 0] < start.si.position[0, 0] else 0.0
        expected = np.sort((turn + offset + np.arange(-30, 30)) / rate)
        expected = expected[(expected > 1e-9) & (expected < 4)]
        np.testing.assert_allclose(times(run, event), expected, atol=1e-12)
        assert {one.direction for one in run.events if one.event is event} == {sign}


def test_round_off_is_no_event() -> None:
    """An orbit stays in its own plane, on the equator of its primary, and on a circle at its radius."""
    system, _ = kepler_pair()
    start = ba.State.circular_orbit(system, separation=1 * u.km, pole=[0.1, 0.2, 1], spins=[3 * u.h, 4 * u.h])
    normal = np.cross(start.si.position[1], start.si.velocity[1])
    events = [
        ba.events.PlaneCrossing(normal),
        ba.events.PlaneCrossing(axes=0),
        ba.events.Crossing("radial_velocity"),
        ba.events.Separation(1 * u.km),
    ]
    for integrator in (ba.Splitting(60 * u.s, "ss10"), ba.Splitting(60 * u.s, "ss10", frame="inertial")):
        run = ba.propagate(system, start, duration=20 * u.day, integrator=integrator, events=events)
        assert run.events == ()


def test_small_angles_and_rates_of_a_tumbling_body() -> None:
    """Each occurrence has the value that was asked for, in formulas of its own."""
    case = tumbling_pair()
    wanted = {
        "roll": -20 * u.deg,
        "pitch": 3 * u.deg,
        "yaw": 20 * u.deg,
        "latitude": 2 * u.deg,
        "longitude": 100 * u.deg,
        "spin_rate": np.linalg.norm(case[1].si.spin[1]) * 1.0001 * u.rad / u.s,
    }
    events = {name: ba.events.Crossing(name, value) for name, value in wanted.items()}
    for frame in ("relative", "inertial"):
        run = ba.propagate(
            *case,
            duration=4 * u.day,
            integrator=ba.Splitting(200 * u.s, "ss10", frame=frame),
            events=[*events.values()],
        )
        for name, event in events.items():
            found = [one for one in run.events if one.event is event]
            assert found, name
            for one in found:
                assert known(name, one.state) == pytest.approx(wanted[name].si.value, rel=1e-11), name


def known(name: str, state: ba.State) -> float:
    """Return a quantity of a state."""
    from scipy.spatial.transform import Rotation

    x, v = (array[1] - array[0] for array in (state.si.position, state.si.velocity))
    if name == "spin_rate":
        return float(np.linalg.norm(state.si.spin[1]))
    if name in ("longitude", "latitude"):
        y = state.si.attitude[0].T @ x
        return float(np.arctan2(y[1], y[0]) if name == "longitude" else np.arcsin(y[2] / np.linalg.norm(y)))
    pole = np.cross(x, v)
    frame = np.column_stack([x, np.cross(pole, x), pole])
    frame /= np.linalg.norm(frame, axis=0)
    angles = Rotation.from_matrix(frame.T @ state.si.attitude[1]).as_euler("XYZ")
    return float(angles[("roll", "pitch", "yaw").index(name)])


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")
def test_a_terminal_event_ends_a_run(integrator: Integrator) -> None:
    farthest = ba.events.Crossing("radial_velocity", direction=-1, terminal=True)
    later, before = ba.events.PlaneCrossing(direction=1), ba.events.Separation(2.4 * u.km)
    run = follow(kepler_pair(), 3 * P, integrator, [farthest, later, before], save_every=P / 40 * u.s)
    assert run.status == "event"
    assert "radial velocity" in run.message
    tolerance = 1e-10 if type(integrator).__name__ == "RungeKutta" else 1e-13
    assert run.si.time[-1] / P == pytest.approx(passage(np.pi), abs=tolerance)
    np.testing.assert_allclose(run.si.time[:-1], np.arange(len(run) - 1) * P / 40, rtol=1e-14)
    assert [one.event for one in run.events] == [before, farthest]
    np.testing.assert_array_equal(run.events[-1].state.position.value, run[-1].position.value)
    again = follow((kepler_pair()[0], run[-1]), 1.5 * P, integrator, [farthest])
    assert again.si.time[-1] / P == pytest.approx(1, abs=3 * tolerance)  # not where it starts, at the last one
    run.at(run.events[0].time)


def test_accuracy_and_interval() -> None:
    rough = ba.events.Crossing("radial_velocity", accuracy=0.01 * P * u.s)
    often = ba.events.PlaneCrossing(interval=P / 500 * u.s)
    run = follow(kepler_pair(), P, ba.Splitting(SIXTIETH, "ss10"), [rough, often])
    np.testing.assert_allclose(times(run, rough), [passage(np.pi), passage(0)], atol=0.01)
    np.testing.assert_allclose(np.sort(times(run, often)), np.sort([passage(np.pi - PERIAPSIS), passage(-PERIAPSIS)]))


def test_steps_too_long_for_an_event_are_looked_at_within() -> None:
    """A body that turns more than once in a step."""
    system, _ = kepler_pair()
    start = ba.State.circular_orbit(system, period=P * u.s, spins=[P / 61 * u.s, "synchronous"])
    event = ba.events.Crossing("longitude", 50 * u.deg)
    run = follow((system, start), P, ba.KeplerSplitting(3 * SIXTIETH), [event])
    assert len(run.events) == 60
    np.testing.assert_allclose(np.diff(times(run, event)), 1 / 60, rtol=1e-11)


@ba.event
def height(p, t, position, velocity, attitude, spin):
    return position[1, 2] - position[0, 2] - p[0] + 0.0 * t


@ba.event
def clock(p, t, position, velocity, attitude, spin):
    return t - p[0]


@ba.event
def failing(p, t, position, velocity, attitude, spin):
    if t > p[0]:
        raise ValueError("too late")
    return 1.0


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")
def test_a_user_s_function(integrator: Integrator) -> None:
    up, noon = ba.events.UserEvent(height, [0.0], direction=1), ba.events.UserEvent(clock, [0.4 * P])
    with_impulse = ba.Impulse(0.3 * P * u.s, np.zeros(3) * u.m / u.s, "B")
    run = follow(kepler_pair(), P, integrator, [up, noon], impulses=[with_impulse])
    assert times(run, up) == pytest.approx([passage(-PERIAPSIS)], abs=1e-9)
    assert times(run, noon) == pytest.approx([0.4], abs=1e-14)  # time counts from the start of the run, not of a leg
    assert up.name == "height"


def test_a_user_s_function_that_raises_ends_a_run() -> None:
    late = ba.events.UserEvent(failing, [0.5 * P])
    with pytest.warns(EndWarning, match="an event raised ValueError: too late"):
        run = follow(kepler_pair(), P, ba.Splitting(SIXTIETH, "ss10"), [late])
    assert run.status == "failed"
    assert 0.5 < run.si.time[-1] / P < 0.52


def test_escape_and_several_bodies() -> None:
    system, state = kepler_pair()
    escape = np.sqrt(2 * sum(body.si.gm for body in system.bodies) / 1400)
    fast = ba.State([[0, 0, 0], [1400, 0, 0]] * u.m, [[0, 0, 0], [0, 1.01 * escape, 0]] * u.m / u.s, *state.si[2:3],
                    state.spin)  # fmt: skip
    lost = ba.events.Escape(5 * u.km)
    run = follow((system, fast), 3 * P, ba.Splitting(SIXTIETH / 4, "ss10"), [lost])
    assert run.status == "escape"
    assert "escape of B" in run.message
    assert run.separation[-1].value == pytest.approx(5000 * (1 + 0), rel=1e-11)
    assert follow((system, state), 3 * P, ba.Splitting(SIXTIETH, "ss10"), [lost]).status == "completed"
    four = four_bodies()
    names = four[0].names
    near = ba.events.Crossing("radial_velocity", direction=1, bodies=(names[0], names[2]))
    plane = ba.events.PlaneCrossing([1, 0, 0], body=names[1], origin=names[3])
    run = ba.propagate(*four, duration=20 * u.h, integrator=ba.Splitting(60 * u.s, "ss10"), events=[near, plane])
    assert run.events
    for one in run.events:
        x, v = one.state.si.position, one.state.si.velocity
        if one.event is plane:
            assert abs(x[1, 0] - x[3, 0]) < 1e-9
        else:
            assert abs((x[2] - x[0]) @ (v[2] - v[0])) < 1e-9


def test_events_in_legs() -> None:
    """An impulse's jump is no event, and times count from the start of the run."""
    apsides = ba.events.Crossing("radial_velocity")
    kick = ba.Impulse(0.2 * P * u.s, [0, 0, 0] * u.m / u.s, "B")
    cut = follow(kepler_pair(), 2 * P, ba.Splitting(SIXTIETH, "ss10"), [apsides], impulses=[kick])
    np.testing.assert_allclose(
        np.sort(times(cut, apsides)), np.sort(np.ravel([passage(0) + np.arange(2), passage(np.pi) + np.arange(2)]))
    )
    (system, state), ended = kepler_pair(), ba.events.Separation(1.9 * u.km, terminal=True, direction=-1)
    run = follow((system, state), 2 * P, ba.Splitting(SIXTIETH, "ss10"), [ended], impulses=[kick])
    assert run.status == "event"
    assert len(run.legs) == 2


# Contact


def light(distance: float, spin: float, shapes: list, speed: float = 0.0) -> tuple[ba.System, ba.State]:
    """Two bodies that are too light to attract each other, the first of which turns about its z axis."""
    bodies = [ba.RigidBody(n, shape, mass=1e-15 * u.kg) for n, shape in zip("AB", shapes, strict=True)]
    state = ba.State(
        [[0, 0, 0], [distance, 0, 0]] * u.m,
        [[0, 0, 0], [speed, 0, 0]] * u.m / u.s,
        [np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), np.eye(3)],
        [[0, 0, spin], [0, 0, 0]] * u.rad / u.s,
    )
    return ba.System(bodies, gravity=ba.PointMass()), state


LONG = ba.Ellipsoid(100 * u.m, 50 * u.m, 40 * u.m)


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")
@pytest.mark.parametrize("distance", [60.0, 90.0, 99.9, 100 * (1 - 1e-6), 100 * (1 - 1e-10), 100 * (1 - 1e-13)])
def test_the_tip_of_an_ellipsoid_that_turns_hits_a_point(distance: float, integrator: Integrator) -> None:
    """Also where it only just reaches it, in the middle of a step: a graze shorter than 1e-6 of a turn."""
    spin = 2 * np.pi / P
    case = light(distance, spin, [LONG, ba.Point()])
    if isinstance(integrator, ba.KeplerSplitting):
        return  # it takes bound pairs only
    if isinstance(integrator, ba.RungeKutta) and distance > 99.99:
        return  # its attitudes are off by more than that
    with pytest.warns(EndWarning, match="B touched A"):
        run = follow(case, P, integrator, [])
    sine = np.sqrt((1 / distance**2 - 1 / 100**2) / (1 / 50**2 - 1 / 100**2))
    expected = (np.pi / 2 - np.arcsin(sine)) / (2 * np.pi)
    # the nearer two roots are to each other, the less round-off leaves of them
    tolerance = 1e-10 if isinstance(integrator, ba.RungeKutta) else 4e-15 + 5e-17 / sine
    assert run.status == "contact"
    assert run.si.time[-1] / P == pytest.approx(expected, abs=tolerance)
    assert run.events[-1].event.title(run.system) == "contact of B and A"
    assert run.events[-1].time.value == run.si.time[-1]


def test_ellipsoids_that_fall_on_each_other() -> None:
    """Along their long axes: a radial Kepler orbit until they touch."""
    bodies = [
        ba.RigidBody(n, ba.Ellipsoid(a * u.m, 50 * u.m, 40 * u.m), mass=1e10 * u.kg) for n, a in (("A", 120), ("B", 80))
    ]
    system = ba.System(bodies, gravity=ba.PointMass())
    gm, first, last = sum(body.si.gm for body in bodies), 600.0, 200.0
    state = ba.State(
        [[0, 0, 0], [first, 0, 0]] * u.m, np.zeros((2, 3)) * u.m / u.s, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s
    )
    share = last / first
    expected = np.sqrt(first**3 / (2 * gm)) * (np.arccos(np.sqrt(share)) + np.sqrt(share * (1 - share)))
    for integrator in (
        ba.Splitting(60 * u.s, "ss10"),
        ba.Splitting(60 * u.s, "ss10", frame="inertial"),
        ba.RungeKutta(),
    ):
        with pytest.warns(EndWarning, match="B touched A"):
            run = ba.propagate(system, state, duration=1 * u.day, integrator=integrator)
        tolerance = 1e-9 if isinstance(integrator, ba.RungeKutta) else 1e-12
        assert run.si.time[-1] == pytest.approx(expected, rel=tolerance)
        assert run.separation[-1].value == pytest.approx(200, rel=tolerance)


def test_beside_each_other_there_is_no_contact() -> None:
    run = follow(light(100 * (1 + 1e-7), 2 * np.pi / P, [LONG, ba.Point()]), P, ba.Splitting(SIXTIETH, "ss10"), [])
    assert run.status == "completed"
    assert run.events == ()


def test_bodies_that_may_go_through_each_other() -> None:
    spheres = [ba.Sphere(100 * u.m), ba.Sphere(50 * u.m)]
    case = light(400, 0.0, spheres, speed=-1.0)
    through = ba.events.Contact(terminal=False, direction=0)
    run = ba.propagate(*case, duration=1000 * u.s, integrator=ba.Splitting(7 * u.s, "ss10"), events=[through])
    assert run.status == "completed"
    assert [(one.time.value, one.direction) for one in run.events] == [
        (pytest.approx(250, rel=1e-13), -1),
        (pytest.approx(550, rel=1e-13), 1),
    ]
    inside = light(100, 0.0, spheres)
    with pytest.raises(ContactError):
        ba.propagate(*inside, duration=10 * u.s, integrator=ba.Splitting(1 * u.s, "ss10"))


def test_what_happens_in_the_step_of_a_contact_counts() -> None:
    case = light(400, 0.0, [ba.Sphere(100 * u.m), ba.Sphere(50 * u.m)], speed=-1.0)
    just, beyond = (ba.events.Separation(d * u.m) for d in (150.5, 149.5))
    for integrator in (ba.Splitting(7 * u.s, "ss10"), ba.RungeKutta(step=7 * u.s)):
        with pytest.warns(EndWarning, match="B touched A after 250 s"):
            run = ba.propagate(*case, duration=1000 * u.s, integrator=integrator, events=[just, beyond])
        assert [type(one.event).__name__ for one in run.events] == ["Separation", "Contact"]
        assert run.events[0].time.value == pytest.approx(249.5, rel=1e-12)
    end = ba.events.Separation(150.5 * u.m, terminal=True)
    run = ba.propagate(*case, duration=1000 * u.s, integrator=ba.Splitting(7 * u.s, "ss10"), events=[end])
    assert run.status == "event"


def test_two_of_three_may_go_through_each_other_and_no_others() -> None:
    bodies = [ba.RigidBody(n, ba.Sphere(50 * u.m), mass=1e-15 * u.kg) for n in "ABC"]
    system = ba.System(bodies, gravity=ba.PointMass())
    zero = np.zeros((3, 3))
    state = ba.State(
        [[0, 0, 0], [300, 20, 0], [-700, 0, 0]] * u.m,
        [[0, 0, 0], [-1, 0, 0], [1, 0, 0]] * u.m / u.s,
        [np.eye(3)] * 3,
        zero * u.rad / u.s,
    )
    through = ba.events.Contact(("A", "B"), terminal=False)
    with pytest.warns(EndWarning, match="contact of C and B"):
        run = ba.propagate(
            system, state, duration=2000 * u.s, integrator=ba.Splitting(10 * u.s, "ss10"), events=[through]
        )
    assert run.status == "contact"
    assert [one.event.title(system) for one in run.events] == ["contact of B and A", "contact of C and B"]
    assert run.si.time[-1] == pytest.approx((1000 - np.sqrt(100**2 - 20**2)) / 2, rel=1e-12)


# Errors, files, scenarios, the command


@pytest.mark.parametrize(
    ("make", "kind", "says"),
    [
        (partial(ba.events.Separation, 5), UnitError, "write distance=5 \\* u.m"),
        (partial(ba.events.Separation, -5 * u.m), InputError, "positive"),
        (partial(ba.events.Crossing, "yawn"), InputError, "did you mean 'yaw'"),
        (partial(ba.events.Crossing, "yaw", 5 * u.m), UnitError, "not an angle"),
        (partial(ba.events.Crossing, "yaw", direction=2), InputError, "expected 1, -1 or 0"),
        (partial(ba.events.Crossing, "yaw", terminal=1), InputError, "True or False"),
        (partial(ba.events.Crossing, "yaw", accuracy=0 * u.s), InputError, "positive"),
        (partial(ba.events.Crossing, "yaw", interval=1 * u.m), UnitError, "not a time"),
        (partial(ba.events.PlaneCrossing, [0, 0, 0]), InputError, "expected a direction"),
        (partial(ba.events.UserEvent, lambda: 0), InputError, "decorate it with @ba.event"),
        (partial(ba.event, lambda p, t: 0.0), InputError, "expected 6 arguments"),
    ],
)
def test_what_cannot_be(make: Any, kind: type, says: str) -> None:
    with pytest.raises(kind, match=says) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("events", "says"),
    [
        ("contact", "expected a list of ba.events"),
        ([1], "events\\[0\\]: expected one of ba.events"),
        ([ba.events.Escape(1 * u.km, "C")], "events\\[0\\]: "),
        ([ba.events.Contact(), ba.events.Separation(1 * u.km, ("A", "A"))], "events\\[1\\]: .*A twice"),
    ],
)
def test_events_that_this_system_cannot_have(events: Any, says: str) -> None:
    with pytest.raises(InputError, match=says):
        follow(kepler_pair(), P, ba.Splitting(SIXTIETH, "ss10"), events)


def test_a_point_has_no_angles() -> None:
    case = light(200, 1e-3, [LONG, ba.Point()])
    with pytest.raises(InputError, match="B is a point, which has no axes"):
        follow(case, P, ba.Splitting(SIXTIETH, "ss10"), [ba.events.Crossing("yaw")])
    with pytest.raises(InputError, match="bodies: expected two"):
        ba.propagate(*four_bodies(), duration=1 * u.h, events=[ba.events.Crossing("separation", 1 * u.km)])


def all_kinds() -> list[ba.events.Event]:
    return [
        ba.events.Crossing("yaw", 10 * u.deg, direction=1, interval=20 * u.s),
        ba.events.PlaneCrossing([0, 1, 0], axes="A", offset=3 * u.m, accuracy=1 * u.us),
        ba.events.Separation(1.9 * u.km, ("A", "B")),
        ba.events.Escape(100 * u.km),
        ba.events.Contact(),
        ba.events.UserEvent(height, [10.0], name="ten metres up"),
    ]


def test_files_and_pickles_keep_them(tmp_path: Path) -> None:
    run = follow(kepler_pair(), P, ba.Splitting(SIXTIETH, "ss10"), all_kinds())
    assert len(run.events) > 4
    for again in (ba.Trajectory.read(run.write(tmp_path / "run.h5")), pickle.loads(pickle.dumps(run))):
        assert [repr(one) for one in again.watched] == [repr(one) for one in run.watched]
        for one, other in zip(again.events, run.events, strict=True):
            assert (one.time, one.direction) == (other.time, other.direction)
            np.testing.assert_array_equal(one.state.attitude, other.state.attitude)
            assert one.event.title(run.system) == other.event.title(run.system)
    follow(kepler_pair(), P / 10, ba.Splitting(SIXTIETH, "ss10"), list(again.watched))
    assert (
        ba.Trajectory.read(follow(kepler_pair(), P, INTEGRATORS["LGVI"], []).write(tmp_path / "none.h5")).events == ()
    )


def test_an_epoch_goes_with_them() -> None:
    system, state = kepler_pair()
    from astropy.time import Time

    dated = ba.State(*(getattr(state, n) for n in ("position", "velocity", "attitude", "spin")), Time("2020-01-01"))
    run = follow((system, dated), P, ba.Splitting(SIXTIETH, "ss10"), [ba.events.Crossing("radial_velocity")])
    one = run.events[0]
    assert (one.state.epoch - dated.epoch).to_value("s") == pytest.approx(one.time.value, rel=1e-12)


def test_an_accuracy_and_events() -> None:
    apsides = ba.events.Crossing("radial_velocity", direction=1)
    run = ba.propagate(*kepler_pair(), duration=2 * P * u.s, accuracy=1e-9, events=[apsides])
    np.testing.assert_allclose(times(run, apsides), passage(0) + np.arange(2), atol=1e-9)


SCENARIO = """
[[bodies]]
name = "A"
shape = { type = "Sphere", radius = "100 m" }
mass = "1e12 kg"

[[bodies]]
name = "B"
shape = { type = "Sphere", radius = "10 m" }
mass = "1e9 kg"

[state]
type = "from_elements"
semi_major_axis = "2 km"
eccentricity = 0.3
inclination = "30 deg"
spins = ["3 h", "4 h"]

[run]
duration = "20 h"
step = "10 min"
integrator = { type = "Splitting", scheme = "ss10" }

[[events]]
type = "Crossing"
quantity = "radial_velocity"
direction = -1
accuracy = "1 ms"
interval = "10 min"

[[events]]
type = "PlaneCrossing"
normal = [0, 0, 1]
body = "B"
offset = "-100 m"

[[events]]
type = "Separation"
distance = "2.5 km"
bodies = ["A", "B"]
terminal = true
"""


def test_scenarios_and_the_command(tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    Path("mine.toml").write_text(SCENARIO)
    assert cli.main(["run", "mine.toml", "--no-picture"]) == 0
    out, _ = capsys.readouterr()
    assert "A and B: event: B 2500 m from A after" in out
    assert "B through a plane of A: never" in out or "B through a plane of A: once" in out
    assert cli.main(["run", "mine.toml", "--no-picture", "--json", "--force"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["status"] == "event"
    assert result["events"][-1]["type"] == "Separation"
    assert result["events"][-1]["time"] == result["duration"]
    assert cli.main(["run", "mine.h5", "--duration", "20h", "--no-picture", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert [one["type"] for one in result["events"]].count("Crossing") >= 1


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('"Crossing"', '"Crosing"', "events[0].type: 'Crosing' is not known: did you mean 'Crossing'?"),
        ('"radial_velocity"', '"radial"', "events[0]: Crossing: quantity='radial' is not known"),
        ('accuracy = "1 ms"', "accuracy = 1", "events[0].accuracy"),
        ("direction = -1", "direktion = -1", "events[0].direktion: unknown key: did you mean 'direction'?"),
        ('["A", "B"]', '["A", "C"]', "events[2]: "),
        ('"-100 m"', '"-100 s"', "events[1]: PlaneCrossing: offset"),
    ],
)
def test_scenarios_with_mistakes(tmp_path: Path, capsys: Any, old: str, new: str, says: str) -> None:
    path = tmp_path / "mine.toml"
    path.write_text(SCENARIO.replace(old, new))
    assert cli.main(["run", str(path), "-o", str(tmp_path / "x.h5")]) == 2
    complaint = capsys.readouterr().err
    assert says in complaint
    assert complaint.count("\n") == 1
