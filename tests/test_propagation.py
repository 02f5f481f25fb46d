"""Runs: the times that are met, what ends a run, what is refused before it starts."""

import warnings

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import ContactError, EndWarning, GravityWarning, InputError, StepError, StepWarning
from binaryast.kernels import loop, status
from binaryast.schedule import Leg, schedule
from binaryast.stepping import LEVELS, PARTS, SteppedRun


@pytest.mark.parametrize(
    ("end", "step", "interval", "segments"),
    [
        (100.0, 10.0, None, [(10.0, 10, 1)]),
        (100.0, 30.0, None, [(25.0, 4, 1)]),
        (5184000.0, 40.0, None, [(40.0, 129600, 72)]),
        (100.0, 7.0, 20.0, [(20 / 3, 15, 3)]),
        (100.0, 7.0, 30.0, [(6.0, 15, 5), (5.0, 2, 2)]),
        (0.3, 0.1, 0.1, [(0.1, 3, 1)]),
        (100.0, 50.0, 20.0, [(20.0, 5, 1)]),
    ],
)
def test_schedules(end: float, step: float, interval: float | None, segments: list) -> None:
    found = schedule(Leg.of_run(end, interval), step)
    for segment, expected in zip(found, segments, strict=True):
        assert segment == pytest.approx(expected)
    assert sum(segment.step * segment.steps for segment in found) == pytest.approx(end, rel=1e-14)


def test_times_are_met_exactly(tumbling: tuple[ba.System, ba.State]) -> None:
    run = ba.propagate(*tumbling, duration=1 * u.day, integrator=ba.LGVI(40 * u.s), save_every=35 * u.min)
    np.testing.assert_allclose(run.si.time[:-1], np.arange(42) * 2100.0, rtol=1e-15)
    assert run.si.time[-1] == pytest.approx(86400, rel=1e-15)
    assert run.step.value == pytest.approx(2100 / 53)
    assert run.status == "completed"


def test_at_most_two_thousand_rows_by_default(tumbling: tuple[ba.System, ba.State]) -> None:
    run = ba.propagate(*tumbling, duration=10 * u.day, integrator=ba.LGVI(17 * u.s))
    assert 1000 <= len(run) <= 2002
    assert run.si.time[-1] == pytest.approx(864000, rel=1e-14)


def test_the_first_row_is_the_start(tumbling: tuple[ba.System, ba.State]) -> None:
    system, state = tumbling
    run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(20 * u.s))
    np.testing.assert_allclose(run.position[0].value, state.position.value, atol=1e-12)
    np.testing.assert_allclose(run.attitude[0], state.attitude, atol=1e-15)
    np.testing.assert_allclose(run.spin[0].value, state.spin.value, rtol=1e-14)


def test_a_barycentre_that_moves_goes_on(tumbling: tuple[ba.System, ba.State]) -> None:
    system, state = tumbling
    arguments = state.arguments()
    arguments["position"] = state.position + [1, 2, 3] * u.km
    arguments["velocity"] = state.velocity + [1, -1, 2] * u.m / u.s
    still = ba.propagate(system, state, duration=5 * u.h, integrator=ba.LGVI(20 * u.s))
    moved = ba.propagate(system, ba.State(**arguments), duration=5 * u.h, integrator=ba.LGVI(20 * u.s))
    shift = (moved.position[-1] - still.position[-1]).to_value("m")
    np.testing.assert_allclose(shift, [np.array([1e3, 2e3, 3e3]) + 18000 * np.array([1, -1, 2])] * 2, rtol=1e-9)
    np.testing.assert_allclose(moved.energy.value, still.energy.value, rtol=1e-12)


def falling() -> tuple[ba.System, ba.State]:
    bodies = [ba.RigidBody(n, ba.Ellipsoid(120 * u.m, 100 * u.m, 80 * u.m), mass=1e10 * u.kg) for n in "AB"]
    zero = np.zeros((2, 3))
    state = ba.State([[-200, 0, 0], [200, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
    return ba.System(bodies), state


def test_contact_ends_a_run() -> None:
    with pytest.warns(EndWarning, match="B touched A"), pytest.warns(GravityWarning, match="leaves out"):
        run = ba.propagate(*falling(), duration=10 * u.day, integrator=ba.LGVI(5 * u.s), save_every=1 * u.h)
    assert run.status == "contact"
    assert 236 < run.separation[-1].value <= 240  # the long axes point at each other
    assert run.si.time[-1] < 86400
    assert np.all(np.diff(run.si.time) > 0)
    assert np.all(np.isfinite(run.si.position))


def test_point_clouds_pass_through_each_other() -> None:
    cloud = ba.PointCloud(np.vstack([np.eye(3), -np.eye(3)]) * 100 * u.m)
    bodies = [ba.RigidBody(n, cloud, mass=1e10 * u.kg) for n in "AB"]
    zero = np.zeros((2, 3))
    state = ba.State([[-200, 35, 0], [200, 0, 30]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
    system = ba.System(bodies, gravity=ba.PointPairs())
    with pytest.warns(StepWarning, match="energy was wrong"):  # two points come close for a moment
        run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.LGVI(1 * u.s))
    assert run.status == "completed"
    assert run.closest_approach.value < 100


def test_a_step_without_solution_in_the_middle_ends_the_run_and_keeps_what_there_was() -> None:
    """The dumbbells' encounter spins one of them up beyond h Omega = 1 of this step."""
    system, state = ba.catalogue.load("dumbbells")
    with pytest.warns(EndWarning, match="the step must be below"), pytest.warns(StepWarning):
        run = ba.propagate(system, state, duration=15 * u.s, integrator=ba.LGVI(0.105 * u.s))
    assert run.status == "failed"
    assert 0 < run.si.time[-1] < 15
    assert len(run) > 10


def test_a_doubtful_step_is_a_warning(didymos: ba.System) -> None:
    state = ba.State.circular_orbit(didymos, separation=1.2 * u.km, spins=[2.26 * u.h, "synchronous"])
    with pytest.warns(StepWarning, match="will run ahead"):
        ba.propagate(didymos, state, duration=1 * u.h, integrator=ba.LGVI(10 * u.min))


@pytest.mark.parametrize(
    ("change", "error", "says"),
    [
        ({"integrator": ba.LGVI(1400 * u.s)}, StepError, "Didymos spins at .* below 1294.8"),
        ({"integrator": ba.LGVI(2 * u.day)}, StepError, "longer than the run"),
        ({"duration": 10}, InputError, "write duration=10 \\* u.s"),
        ({"duration": -1 * u.s}, InputError, "positive"),
        ({"duration": np.inf * u.s}, InputError, "finite"),
        ({"duration": [1, 2] * u.s}, InputError, "single value"),
        ({"save_every": 2 * u.day}, StepError, "save_every"),
        ({"save_every": 1e-5 * u.s}, InputError, "at most 10000000"),
        ({"integrator": "LGVI"}, InputError, "expected an object of class Integrator"),
        ({"state": None}, InputError, "expected an object of class State"),
    ],
)
def test_what_is_refused(didymos: ba.System, change: dict, error: type, says: str) -> None:
    state = ba.State.circular_orbit(didymos, separation=1.2 * u.km, spins=[2.26 * u.h, "synchronous"])
    arguments = {"system": didymos, "state": state, "duration": 1 * u.day, "integrator": ba.LGVI(40 * u.s)} | change
    with pytest.raises(error, match=says):
        ba.propagate(**arguments)


def test_bodies_that_overlap_at_the_start(didymos: ba.System) -> None:
    state = ba.State.circular_orbit(didymos, separation=500 * u.m, spins=[2.26 * u.h, "synchronous"])
    with pytest.raises(ContactError, match="overlap at the start"):
        ba.propagate(didymos, state, duration=1 * u.day, integrator=ba.LGVI(40 * u.s))


def test_touching_is_a_matter_of_shape_not_of_bounding_spheres() -> None:
    bodies = [ba.RigidBody(n, ba.Ellipsoid(300 * u.m, 100 * u.m, 100 * u.m), mass=1e10 * u.kg) for n in "AB"]
    zero = np.zeros((2, 3))
    state = ba.State([[0, -110, 0], [0, 110, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
    with pytest.warns(GravityWarning, match="leaves out"):
        run = ba.propagate(ba.System(bodies), state, duration=10 * u.s, integrator=ba.LGVI(1 * u.s))
    assert run.status == "completed"


def test_the_size_of_what_gravity_leaves_out() -> None:
    """Seen at saved rows, of the pair for which it is largest; said once, where it is more than a thousandth."""
    bodies = [ba.RigidBody(n, ba.Ellipsoid(300 * u.m, 100 * u.m, 100 * u.m), mass=1e10 * u.kg) for n in "ABC"]
    zero = np.zeros((3, 3))
    place = [[0, 0, 0], [0, 650, 0], [0, 5000, 0]] * u.m
    state = ba.State(place, zero * u.m / u.s, [np.eye(3)] * 3, zero * u.rad / u.s)
    figures = {}
    for gravity in (ba.SecondDegree(), ba.Multipole(2), ba.Multipole(4), ba.Multipole(6), ba.PointMass()):
        with warnings.catch_warnings(record=True) as found:
            warnings.simplefilter("always")
            run = ba.propagate(ba.System(bodies, gravity), state, duration=100 * u.s, integrator=ba.LGVI(10 * u.s))
        figures[repr(gravity)] = run.max_next_degree_term
        told = [str(warning.message) for warning in found if warning.category is GravityWarning]
        large = run.max_next_degree_term is not None and run.max_next_degree_term > 1e-3
        assert len(told) == large
        assert all("between A and B leaves out terms up to" in text for text in told)
        assert all(text.endswith("take a higher degree of ba.Multipole") for text in told)
        assert ("next degrees of gravity" in run.summary()) == (run.max_next_degree_term is not None)
    assert figures["PointMass()"] is None
    assert figures["SecondDegree()"] == figures["Multipole(degree=2)"]
    pair = [ba.System(bodies[:2], ba.Multipole(n)).mutual_gravity([0, 650, 0] * u.m).energy.value for n in (2, 4, 6, 8)]
    for degree, step in zip((2, 4, 6), np.diff(pair), strict=True):
        size = abs(step / pair[0])  # at the start, where they are nearly as close as they come
        assert figures[f"Multipole(degree={degree})"] == pytest.approx(size, rel=0.05)


def test_what_helps_where_gravity_leaves_out_too_much() -> None:
    """A higher degree, where there is one and where the series converges."""
    zero = np.zeros((2, 3))
    for distance, gravity, says in (
        (
            500,
            ba.Multipole(4),
            "at 500 m spheres that hold the bodies meet, a higher degree need not be better: take ba.P",
        ),
        (610, ba.Multipole(16), "there is no higher degree: take ba.PointPairs"),
    ):
        random = np.random.default_rng(1)
        points = np.concatenate([random.normal(size=(20, 3)) * 20, [[-299, 0, 0], [299, 0, 0]]])
        shape = ba.Ellipsoid(300 * u.m, 20 * u.m, 20 * u.m) if distance < 600 else ba.PointCloud(points * u.m)
        bodies = [ba.RigidBody(n, shape, mass=1e10 * u.kg) for n in "AB"]
        place = [[0, 0, 0], [distance, 0, 0]] if distance > 600 else [[0, 0, 0], [0, distance, 0]]
        state = ba.State(place * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
        with pytest.warns(GravityWarning, match=says):
            ba.propagate(ba.System(bodies, gravity), state, duration=1 * u.s, integrator=ba.LGVI(1 * u.s))


def test_where_the_next_degree_is_not_known() -> None:
    table = np.zeros((3, 3, 3))
    table[0, 0, 0], table[2, 0, 0], table[0, 2, 0], table[0, 0, 2] = 10, 50, 32, 18
    bodies = [ba.RigidBody(n, ba.InertiaIntegrals(table, 1 * u.m), mass=1e6 * u.kg) for n in "AB"]
    system = ba.System(bodies, ba.Multipole(2))
    state = ba.State.circular_orbit(system, separation=50 * u.m, spins=["synchronous", "synchronous"])
    run = ba.propagate(system, state, duration=10 * u.s, integrator=ba.LGVI(1 * u.s))
    assert run.max_next_degree_term is None
    assert "next degrees of gravity: not known" in run.summary()


def test_a_pass_within_one_step_is_a_contact_all_the_same() -> None:
    """10 km in a step, through a body of 2 km."""
    bodies = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for n in "AB"]
    velocity = [[0, 0, 0], [-1e4, 0, 0]] * u.m / u.s
    zero = np.zeros((2, 3)) * u.rad / u.s
    state = ba.State([[0, 0, 0], [4, 0.5, 0]] * u.km, velocity, [np.eye(3)] * 2, zero)
    with pytest.warns(EndWarning, match="touched"):
        run = ba.propagate(ba.System(bodies), state, duration=10 * u.s, integrator=ba.LGVI(1 * u.s))
    assert run.status == "contact"
    past = ba.State([[0, 0, 0], [4, 2.1, 0]] * u.km, velocity, [np.eye(3)] * 2, zero)
    with pytest.warns(StepWarning, match="long beside"):
        run = ba.propagate(ba.System(bodies), past, duration=10 * u.s, integrator=ba.LGVI(1 * u.s))
    assert run.status == "completed"


@ba.pair_potential
def one_sided(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
    """A potential that goes wrong where x < p[1]: in U, in the gradient or in the moment, or by raising."""
    r = (x * x + y * y + z * z) ** 0.5
    w = p[0] / r**3
    bad = np.nan if x < p[1] else 0.0
    if p[2] == 3.0 and x < p[1]:
        raise ValueError("too near")
    first = bad if p[2] == 0.0 else 0.0
    second = bad if p[2] == 1.0 else 0.0
    third = bad if p[2] == 2.0 else 0.0
    return -p[0] / r + first, w * x + second, w * y, w * z, third, 0.0, 0.0


@pytest.mark.parametrize("kind", [0, 1, 2, 3])
def test_gravity_that_goes_wrong_ends_a_run_and_no_nan_leaves(didymos: ba.System, kind: int) -> None:
    gm = didymos.primary.si.gm * didymos.secondary.si.mass
    state = ba.State(
        [[0, 0, 0], [1200, 0, 0]] * u.m,
        [[0, 0, 0], [0, 0.15, 0]] * u.m / u.s,
        [np.eye(3)] * 2,
        np.zeros((2, 3)) * u.rad / u.s,
    )
    system = ba.System(didymos.bodies, gravity=ba.PairPotential(one_sided, [gm, 900.0, kind]))
    with pytest.warns(EndWarning, match="raised ValueError" if kind == 3 else "not numbers any more"):
        run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(40 * u.s), save_every=10 * u.min)
    assert run.status == "failed"
    assert len(run) > 3
    for array in run.si:
        assert np.all(np.isfinite(array))
    assert np.isfinite(run.max_relative_linear_momentum_error)
    broken = ba.System(didymos.bodies, gravity=ba.PairPotential(one_sided, [gm, 1300.0, kind]))
    with pytest.raises(InputError, match=r"not a number|too near"):
        ba.propagate(broken, state, duration=1 * u.day, integrator=ba.LGVI(40 * u.s))


def test_the_largest_step_of_all_segments_is_what_counts(didymos: ba.System) -> None:
    segments = schedule(Leg.of_run(139.0, 50.0), 40.0)
    assert max(segment.step for segment in segments) == pytest.approx(25.0)


@pytest.mark.parametrize("step", [1e-80, 1e-20])
def test_more_steps_than_can_be_counted(didymos: ba.System, step: float) -> None:
    state = ba.State.circular_orbit(didymos, separation=1.2 * u.km, spins=[2.26 * u.h, "synchronous"])
    with pytest.raises(StepError, match="expected at most 1e15"):
        ba.propagate(didymos, state, duration=1 * u.day, integrator=ba.LGVI(step * u.s))


def test_progress_is_shown_on_standard_error(
    tumbling: tuple[ba.System, ba.State], capfd: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    import tqdm

    plain = tqdm.tqdm
    monkeypatch.setattr(tqdm, "tqdm", lambda **options: plain(**(options | {"delay": 0, "leave": True})))
    ba.propagate(*tumbling, duration=10 * u.day, integrator=ba.LGVI(20 * u.s), progress=True)
    captured = capfd.readouterr()
    assert captured.out == ""
    assert "10/10 d simulated" in captured.err


def test_a_closer_look_saves_no_rows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where parts of parts of a step do not touch after all, rows would be written where there is no room for them."""
    run = SteppedRun(*falling(), ba.LGVI(5 * u.s), schedule(Leg.of_run(100.0), 5.0))
    seen, longer = [], 5.0 / PARTS**3 * 1.5

    def call(self, step, count, stride, rows, watch, surfaces) -> int:
        first_of_longer = step > longer and not seen.count(step)
        seen.append(step)
        if first_of_longer:
            return status.CONTACT
        watch[loop.STEPS] += count
        assert watch[loop.STEPS] < 0
        return status.COMPLETED

    monkeypatch.setattr(SteppedRun, "_call", call)
    assert run._by_parts(5.0, LEVELS, run.watch.array.copy()) is None
    assert len(seen) == 3 * PARTS
