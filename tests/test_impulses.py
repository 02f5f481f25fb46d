"""Impulses: what they change, when, and that a run goes on from there as from a start of its own."""

import json
import os
import pickle
import signal
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from astropy.time import Time

import binaryast as ba
from binaryast import cli
from binaryast.errors import AccuracyError, EndWarning, InputError, StepError
from binaryast.plotting import overview
from binaryast.scenario import loads
from binaryast.schedule import Leg, row_times, schedule

SPEED = [3.0, -1.0, 2.0] * u.mm / u.s
METHODS = {
    "LGVI": ba.LGVI(40 * u.s),
    "LGVI, inertial": ba.LGVI(40 * u.s, frame="inertial"),
    "Splitting": ba.Splitting(10 * u.min),
    "KeplerSplitting": ba.KeplerSplitting(30 * u.min),
    "RungeKutta": ba.RungeKutta(),
    "RungeKutta, fixed steps": ba.RungeKutta(step=3 * u.min),
    "Taylor": ba.Taylor(),
}


def momenta(system: ba.System, state: ba.State) -> tuple[np.ndarray, np.ndarray]:
    """Return linear momentum, and angular momentum about the origin, inertial, added up body by body."""
    position, velocity, attitude, spin = state.si
    linear, angular = np.zeros(3), np.zeros(3)
    for i, body in enumerate(system.bodies):
        linear += body.si.mass * velocity[i]
        angular += body.si.mass * np.cross(position[i], velocity[i]) + attitude[i] @ (body.si.moments * spin[i])
    return linear, angular


@pytest.mark.parametrize("body", [0, 1])
def test_an_impact_off_the_centre_balances(tumbling: tuple[ba.System, ba.State], body: int) -> None:
    """Both momenta, about a point that is nowhere special, change by those of what comes in."""
    system, state = tumbling
    radius = system.bodies[body].bounding_radius
    point = 0.9 * radius * np.array([0.5, -0.7, 0.3])
    impact = ba.Impact(0 * u.s, 800 * u.kg, [2.0, -5.0, 3.0] * u.km / u.s, body, 3.1, point * u.m)
    after = impact.apply(state, system)
    gained = 3.1 * 800 * np.array([2e3, -5e3, 3e3])
    hit = state.si.position[body] + state.si.attitude[body] @ point
    (linear, angular), (linear_after, angular_after) = momenta(system, state), momenta(system, after)
    sizes = [
        max(body.si.mass * np.linalg.norm(v) for body, v in zip(system.bodies, state.si.velocity, strict=True)),
        np.linalg.norm(angular),
    ]
    assert np.linalg.norm(linear_after - linear - gained) < 1e-15 * sizes[0]
    assert np.linalg.norm(angular_after - angular - np.cross(hit, gained)) < 1e-15 * sizes[1]
    assert np.linalg.norm(np.cross(hit, gained)) > 1e-9 * sizes[1]  # of which round-off is not a part
    np.testing.assert_array_equal(after.si.position, state.si.position)
    np.testing.assert_array_equal(after.si.attitude, state.si.attitude)
    np.testing.assert_array_equal(after.si.spin[1 - body], state.si.spin[1 - body])


def test_a_central_impact_and_an_impulse_turn_nothing(tumbling: tuple[ba.System, ba.State]) -> None:
    system, state = tumbling
    mass = system.bodies[1].si.mass
    impact = ba.Impact(0 * u.s, 1e-3 * mass * u.kg, 1e3 * SPEED, system.names[1])
    for kick in (ba.Impulse(0 * u.s, SPEED, 1), impact):
        after = kick.apply(state, system)
        np.testing.assert_array_equal(after.si.spin, state.si.spin)
        np.testing.assert_array_equal(after.si.velocity[0], state.si.velocity[0])
        np.testing.assert_allclose(after.si.velocity[1] - state.si.velocity[1], SPEED.to_value("m / s"), atol=1e-15)
        np.testing.assert_allclose(kick.velocity_change(system).value, SPEED.to_value("m / s"), rtol=1e-14)


@pytest.mark.parametrize("name", METHODS)
def test_the_run_goes_on_as_one_that_starts_there(name: str) -> None:
    system, state = ba.catalogue.load("didymos")
    method = METHODS[name]
    kick = ba.Impact(5.1 * u.h, 580 * u.kg, [0, -6, 1] * u.km / u.s, "Dimorphos", 3.0, [10, 60, 20] * u.m)
    run = ba.propagate(system, state, duration=10.2 * u.h, integrator=method, impulses=[kick])
    first, second = run.legs
    assert run.status == "completed"
    assert first.si.time[-1] == second.si.time[0] == 5.1 * 3600
    assert run.si.time[-1] == pytest.approx(10.2 * 3600, rel=1e-15)
    before = ba.propagate(system, state, duration=5.1 * u.h, integrator=method)
    after = ba.propagate(system, kick.apply(before[-1], system), duration=5.1 * u.h, integrator=method)
    for one, other in ((first, before), (second, after)):
        for array, alone in zip(one[-1].si, other[-1].si, strict=True):
            np.testing.assert_array_equal(array, alone)
    changed = kick.apply(first[-1], system)
    rounding = 1e-11 if "RungeKutta" in name else 1e-15  # whose attitudes are no rotations beyond that
    speed, rate = np.abs(changed.si.velocity).max(), np.abs(changed.si.spin).max()
    np.testing.assert_allclose(second[0].si.velocity, changed.si.velocity, rtol=0, atol=rounding * speed)
    np.testing.assert_allclose(second[0].si.spin, changed.si.spin, rtol=0, atol=rounding * rate)
    assert run.steps == before.steps + after.steps


def test_figures_are_the_largest_of_all_legs(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    kick = ba.Impulse(1 * u.day, [0, 0, -3] * u.mm / u.s, 1)
    run = ba.propagate(didymos, state, duration=3 * u.day, integrator=ba.LGVI(40 * u.s), impulses=[kick])
    alone = ba.propagate(didymos, run.legs[1][0], duration=2 * u.day, integrator=ba.LGVI(40 * u.s))
    before = ba.propagate(didymos, state, duration=1 * u.day, integrator=ba.LGVI(40 * u.s))
    for figure in ("max_relative_energy_error", "max_energy_error_over_potential", "max_next_degree_term"):
        assert getattr(run, figure) == pytest.approx(max(getattr(one, figure) for one in (alone, before)), rel=1e-4)
    run.check(energy=1e-8, momentum=1e-14, rotation=1e-14)  # from the start of each leg, which the impulse is not in
    assert abs(run.energy[-1] / run.energy[0] - 1) > 1e-6
    assert alone.closest_approach < before.closest_approach - 20 * u.m
    assert run.closest_approach.value == pytest.approx(alone.closest_approach.value, rel=1e-14)
    assert (run.closest_approach_time - alone.closest_approach_time).value == pytest.approx(86400, rel=1e-12)


def test_an_accuracy_is_that_of_each_leg() -> None:
    entry = ba.catalogue.entry("dart")
    run = ba.propagate(
        entry.system, entry.state, duration=10 * u.day, accuracy=1e-8, impulses=entry.impulses, save_every=1 * u.h
    )
    assert run.accuracy == 1e-8
    assert 0 < run.estimated_error < 1e-8
    assert "; then " in run.choice
    exact = ba.propagate(
        entry.system, entry.state, duration=10 * u.day, integrator=ba.Taylor(), impulses=entry.impulses
    )
    assert np.linalg.norm(run.si.position[-1] - exact.si.position[-1], axis=1).max() < 1e-8 * 1184 * 10
    with pytest.raises(AccuracyError, match=r"^from 23\.8429 h on, after an impulse: .* it can be had for the first"):
        ba.propagate(entry.system, entry.state, duration=200 * u.day, accuracy=1e-13, impulses=entry.impulses)


def test_rows_are_at_multiples_from_the_start_of_the_run(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    kicks = [ba.Impulse(time * u.min, SPEED, 1) for time in (95.5, 30, 97.25)]
    times = [0, 30, 30, 60, 90, 95.5, 95.5, 97.25, 97.25, 120, 130]
    for method in (ba.LGVI(40 * u.s), ba.RungeKutta(), ba.RungeKutta(step=7 * u.min), ba.Taylor()):
        run = ba.propagate(
            didymos, state, duration=130 * u.min, integrator=method, save_every=30 * u.min, impulses=kicks
        )
        np.testing.assert_allclose(run.si.time, np.array(times) * 60, rtol=1e-15)
        assert [len(leg) for leg in run.legs] == [2, 4, 2, 3]
        assert [one.time.to_value("min") for one in run.impulses] == [30, 95.5, 97.25]


def test_at_most_two_thousand_rows_by_default(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    kicks = [ba.Impulse(time * u.h, SPEED / 100, 1) for time in range(1, 100)]
    for method in (ba.LGVI(40 * u.s), ba.RungeKutta()):
        run = ba.propagate(didymos, state, duration=100 * u.h, integrator=method, impulses=kicks)
        assert 900 < len(run) <= 2000 + 2 * len(kicks)
        assert len(run.legs) == 100


@pytest.mark.parametrize(
    ("leg", "step", "segments"),
    [
        (Leg(30.0, 100.0, 100.0, None), 7.0, [(7.0, 10, 1)]),
        (Leg(35.0, 100.0, 100.0, 30.0), 10.0, [(25 / 3, 3, 3), (10.0, 3, 3), (10.0, 1, 1)]),
        (Leg(60.0, 90.0, 100.0, 30.0), 10.0, [(10.0, 3, 3)]),
        (Leg(61.0, 62.0, 100.0, 30.0), 10.0, [(1.0, 1, 1)]),
        (Leg(0.0, 5.0, 100.0, None), 50.0, [(5.0, 1, 1)]),
        (Leg(3 * 0.1, 0.6, 0.6, 0.1), 0.1, [(0.1, 3, 1)]),  # 3 times 0.1 is more than 0.3
    ],
)
def test_schedules_of_legs(leg: Leg, step: float, segments: list) -> None:
    found = schedule(leg, step)
    assert len(found) == len(segments)
    for segment, expected in zip(found, segments, strict=True):
        assert segment == pytest.approx(expected)
    assert sum(segment.step * segment.steps for segment in found) == pytest.approx(leg.length, rel=1e-14)
    if leg.interval is not None:
        ends = np.cumsum([segment.step * segment.steps for segment in found])
        assert row_times(leg)[-1] == pytest.approx(ends[-1])
        assert len(row_times(leg)) == 1 + sum(segment.steps // segment.stride for segment in found)


def test_at_one_time_at_the_start_and_at_the_end(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    kicks = [ba.Impulse(time * u.h, factor * SPEED, 1) for time, factor in ((2, 1), (0, 2), (1, 3), (1, 4))]
    run = ba.propagate(didymos, state, duration=2 * u.h, integrator=ba.LGVI(40 * u.s), impulses=kicks)
    assert [len(leg) for leg in run.legs] == [1, 91, 91, 1]
    for k, factor in ((1, 2), (2, 3 + 4), (3, 1)):
        gained = run.legs[k][0].velocity - run.legs[k - 1][-1].velocity
        np.testing.assert_allclose(gained[1].to_value("mm / s"), factor * SPEED.value, rtol=0, atol=1e-12)
        np.testing.assert_allclose(gained[0].to_value("mm / s"), 0, atol=1e-12)
    np.testing.assert_allclose(run[0].si.velocity, state.si.velocity, rtol=0, atol=1e-16)
    assert run.steps == 180
    assert run.step == 40 * u.s
    assert run.integrator.order == 2
    picked = ba.propagate(didymos, state, duration=2 * u.h, accuracy=1e-8, impulses=[kicks[0], kicks[1]])
    assert picked.accuracy == 1e-8
    assert picked.estimated_error < 1e-8
    assert picked.steps > 0


def test_epochs_go_on() -> None:
    system, state = ba.catalogue.load("didymos")
    start = ba.State(**(state.arguments() | {"epoch": Time("2022-09-26T00:00:00", scale="tdb")}))
    kick = ba.Impulse(1 * u.h, SPEED, 1)
    run = ba.propagate(system, start, duration=3 * u.h, integrator=ba.LGVI(40 * u.s), impulses=[kick])
    assert run.epoch == start.epoch
    assert (run[-1].epoch - start.epoch).to_value("s") == pytest.approx(3 * 3600, abs=1e-6)
    assert run.frame == "ICRF"


def test_several_bodies_and_points() -> None:
    system, state = ba.catalogue.load("sn263")
    bodies = [*system.bodies[:2], ba.RigidBody("craft", ba.Point(), mass=20 * u.kg)]
    state = ba.State.from_orbits(
        ba.System(bodies),
        [ba.Orbit(4 * u.km), ba.Orbit(20 * u.km, about="inner")],
        spins=[3.4 * u.h, "synchronous", None],
    )
    system = ba.System(bodies)
    kicks = [ba.Impulse(1 * u.h, [0, 0, 1] * u.cm / u.s, "craft"), ba.Impact(2 * u.h, 1 * u.kg, 1e6 * SPEED, "craft")]
    run = ba.propagate(system, state, duration=5 * u.h, integrator=ba.Splitting(2 * u.min), impulses=kicks)
    run.check(momentum=1e-14)
    gained = [after[0].velocity - before[-1].velocity for before, after in zip(run.legs, run.legs[1:], strict=False)]
    np.testing.assert_allclose(gained[0].to_value("cm / s"), [[0, 0, 0], [0, 0, 0], [0, 0, 1]], atol=1e-11)
    np.testing.assert_allclose(gained[1][2].value, SPEED.value / 1e3 * 1e6 / 20, rtol=1e-12)


def test_a_run_that_ends_early_ends_its_legs(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    stop = ba.Impulse(1 * u.h, -(state.velocity[1] - state.velocity[0]), 1)
    later = ba.Impulse(20 * u.day, SPEED, 1)
    with pytest.warns(EndWarning, match="after .* s: Dimorphos touched Didymos"):
        turned = ba.propagate(didymos, state, duration=30 * u.day, integrator=ba.LGVI(10 * u.s), impulses=[stop, later])
    assert turned.status == "contact"
    assert len(turned.legs) == 2
    end = turned.si.time[-1]
    assert 3600 < end < 86400
    assert turned.message.endswith(f"{end:.9g} s")
    assert turned.impulses == (stop, later)
    assert "after 20 d, not reached" in turned.summary()


def test_ctrl_c_in_a_later_leg_keeps_what_there_was(didymos: ba.System, monkeypatch: pytest.MonkeyPatch) -> None:
    state = ba.catalogue.load("didymos")[1]
    kicks = [ba.Impulse(time * u.h, SPEED, 1) for time in (1, 2)]
    plan = ba.propagation.choosing.plan
    calls = []

    def pressed(*arguments):
        calls.append(arguments)
        if len(calls) == 2:
            os.kill(os.getpid(), signal.SIGINT)
        return plan(*arguments)

    monkeypatch.setattr(ba.propagation.choosing, "plan", pressed)
    run = ba.propagate(didymos, state, duration=3 * u.h, accuracy=1e-8, impulses=kicks)
    assert run.status == "interrupted"
    assert run.si.time[-1] == 3600
    assert run.message == "stopped after 3600 s; go on from the last row, run[-1]"
    assert [len(leg) for leg in run.legs][1:] == [1]  # the state after the first impulse, from which to go on


@pytest.mark.parametrize("name", ["LGVI", "RungeKutta", "Taylor"])
def test_ctrl_c_at_the_end_of_a_leg_is_not_lost(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Legs may be so short that it always comes too late to end one early."""
    system, state = ba.catalogue.load("didymos")

    @contextmanager
    def pressing(end: float, progress: bool, begin: float) -> Iterator[Callable]:
        yield lambda elapsed: os.kill(os.getpid(), signal.SIGINT) if begin + elapsed == 7200 else None

    monkeypatch.setattr(ba.propagation, "bar", pressing)
    kicks = [ba.Impulse(time * u.h, SPEED, 1) for time in (1, 2)]
    run = ba.propagate(system, state, duration=3 * u.h, integrator=METHODS[name], impulses=kicks)
    assert run.status == "interrupted"
    assert run.si.time[-1] == 7200
    assert len(run.legs) == 3


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ba.Impulse(1, SPEED, 1), "time=1 has no unit"),
        (lambda: ba.Impulse(-1 * u.s, SPEED, 1), "time: expected a value of zero or more"),
        (lambda: ba.Impulse(1 * u.s, [1, 2] * u.m / u.s, 1), r"delta_v: expected an array of shape \(3,\)"),
        (lambda: ba.Impulse(1 * u.s, SPEED * u.s, 1), "delta_v: .* is not a speed"),
        (lambda: ba.Impact(1 * u.s, 0 * u.kg, SPEED, 1), "mass: expected a positive value"),
        (lambda: ba.Impact(1 * u.s, 1 * u.kg, SPEED, 1, 0), "beta: expected a number above 0"),
        (lambda: ba.Impact(1 * u.s, 1 * u.kg, SPEED, 1, 2 * u.m), "beta: expected numbers without a unit"),
        (lambda: ba.Impact(1 * u.s, 1 * u.kg, SPEED, 1, point=[1, 2, 3]), r"point=\[1, 2, 3\] has no unit"),
    ],
)
def test_one_line_for_each_mistake(make, says: str) -> None:
    with pytest.raises(InputError, match=says) as error:
        make()
    assert "\n" not in str(error.value)


@pytest.mark.parametrize(
    ("kicks", "says"),
    [
        (ba.Impulse(1 * u.h, SPEED, 1), "impulses: expected a list of ba.Impulse and ba.Impact, got Impulse"),
        ("Impulse", "impulses: expected a list"),
        ([3], r"impulses\[0\]: expected a ba.Impulse or a ba.Impact, got 3"),
        ([ba.Impulse(1 * u.h, SPEED, "Didimos")], r"impulses\[0\]: 'Didimos' is no body .* did you mean 'Didymos'"),
        ([ba.Impulse(1 * u.h, SPEED, 2)], r"impulses\[0\]: 2 is no body of this system"),
        ([ba.Impulse(3 * u.h, SPEED, 1)], r"impulses\[0\]: its time, 3 h, is after the end of the run of 2 h"),
        (
            [ba.Impact(1 * u.h, 1 * u.kg, SPEED, 1, point=[0, 90, 0] * u.m)],
            r"impulses\[0\]: point: 90 m from the mass centre of Dimorphos, none of whose .* further than 89\.75 m",
        ),
    ],
)
def test_what_a_run_refuses(didymos: ba.System, kicks, says: str) -> None:
    state = ba.catalogue.load("didymos")[1]
    with pytest.raises(InputError, match=says) as error:
        ba.propagate(didymos, state, duration=2 * u.h, integrator=ba.LGVI(40 * u.s), impulses=kicks)
    assert "\n" not in str(error.value)


def test_a_point_is_not_hit_off_its_centre(didymos: ba.System) -> None:
    craft = ba.RigidBody("craft", ba.Point(), mass=20 * u.kg)
    system = ba.System([didymos.primary, craft])
    state = ba.State.circular_orbit(system, separation=2 * u.km, spins=[2.26 * u.h, None])
    hit = ba.Impact(1 * u.h, 1 * u.kg, SPEED, "craft", point=[0, 1, 0] * u.m)
    with pytest.raises(InputError, match="craft is a point, which does not turn: leave the point of impact out"):
        ba.propagate(system, state, duration=2 * u.h, integrator=ba.LGVI(40 * u.s), impulses=[hit])


def test_what_an_integrator_cannot_follow_after_an_impulse(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    hit = ba.Impact(1 * u.h, 1e6 * u.kg, [0, -50, 0] * u.km / u.s, 1, point=[80, 0, 0] * u.m)
    with pytest.raises(StepError, match=r"^from 3600 s on, after an impulse: step: Dimorphos spins at"):
        ba.propagate(didymos, state, duration=2 * u.h, integrator=ba.LGVI(40 * u.s), impulses=[hit])
    kick = ba.Impulse(1 * u.h, [0, 2, 0] * u.m / u.s, 1)
    with pytest.raises(InputError, match=r"^from 3600 s on, after an impulse: KeplerSplitting: it is for a bound pair"):
        ba.propagate(didymos, state, duration=2 * u.h, integrator=ba.KeplerSplitting(20 * u.min), impulses=[kick])


def test_file_and_back(didymos: ba.System, tmp_path: Path) -> None:
    state = ba.catalogue.load("didymos")[1]
    kicks = [
        ba.Impulse(1 * u.h, SPEED, 0),
        ba.Impact(2 * u.h, 5 * u.kg, 1e6 * SPEED, "Dimorphos", 2.5, [1, 2, 3] * u.m),
        ba.Impact(3 * u.h, 5 * u.kg, 1e6 * SPEED, "Dimorphos"),
    ]
    run = ba.propagate(didymos, state, duration=4 * u.h, integrator=ba.LGVI(40 * u.s), impulses=kicks)
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    for copy in (again, pickle.loads(pickle.dumps(run))):
        assert [len(leg) for leg in copy.legs] == [len(leg) for leg in run.legs]
        assert copy.summary() == run.summary()
        for one, other in zip(copy.impulses, kicks, strict=True):
            assert type(one) is type(other)
            assert one.arguments().keys() == other.arguments().keys()
            for name, value in other.arguments().items():
                assert np.all(getattr(one, name) == value), name
    assert ba.propagate(didymos, state, duration=1 * u.h, integrator=ba.LGVI(40 * u.s)).impulses == ()
    assert len(run.to_table()) == len(run)


def test_pictures_and_slices(didymos: ba.System) -> None:
    state = ba.catalogue.load("didymos")[1]
    kick = ba.Impulse(1 * u.day, [0, 0, -3] * u.mm / u.s, 1)
    run = ba.propagate(didymos, state, duration=2 * u.day, integrator=ba.LGVI(40 * u.s), impulses=[kick, kick])
    assert len(run.legs[0].legs) == 1
    assert len(run[len(run.legs[0]) - 1 :].legs) == 2
    errors = ba.plotting.conserved(run).lines[0].get_ydata()
    assert errors.max() < 1e-8  # from the start of each leg
    figure = overview(run)
    assert not any("expected" in text.get_text() for ax in figure.axes for text in ax.texts)
    assert ba.analysis.mutual_period(run).value == pytest.approx(11.9, abs=0.3)


SCENARIO = ba.catalogue.text("dart")


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ('type = "Impact"', 'type = "Impackt"', "impulses[0].type: 'Impackt' is not known: did you mean 'Impact'?"),
        ("beta = 3.2987", "betta = 3.2987", "impulses[0].betta: unknown key"),
        ("beta = 3.2987", 'beta = "3"', "impulses[0]: beta:"),
        ('time = "23.842946 h"\n', "", "impulses[0].time is missing"),
        ('time = "23.842946 h"', 'time = "70 d"', "impulses[0]: its time, 70 d, is after the end of the run of 60 d"),
        ('body = "Dimorphos"', 'body = "Dimorfos"', "impulses[0]: 'Dimorfos' is no body of this system"),
        ('"[0, -6144.9, 0] m / s"', '"[0, -6144.9, 0]"', "impulses[0].velocity"),
        ("[[impulses]]", "[impulses]", "impulses: expected tables [[impulses]]"),
    ],
)
def test_one_line_for_each_mistake_in_a_scenario(old: str, new: str, says: str) -> None:
    assert SCENARIO.count(old) == 1
    with pytest.raises(InputError) as error:
        loads(SCENARIO.replace(old, new), name="x", where="x")
    assert says in str(error.value)
    assert "\n" not in str(error.value)


def test_dart() -> None:
    """The velocity changes along the track by what is published, and the period by what is observed."""
    entry = ba.catalogue.entry("dart")
    (impact,) = entry.impulses
    run = ba.propagate(
        entry.system, entry.state, duration=entry.duration, accuracy=entry.accuracy, impulses=entry.impulses
    )
    before, after = run.legs
    along = (before.velocity[-1, 1] - before.velocity[-1, 0]).value
    gained = (after.velocity[0] - before.velocity[-1])[1].to_value("mm / s")
    assert gained @ along / np.linalg.norm(along) == pytest.approx(-2.63, abs=1e-3)
    assert np.linalg.norm(gained) == pytest.approx(2.63, abs=1e-3)
    assert ba.analysis.mutual_period(before).value == pytest.approx(11.921473, abs=2e-3)
    assert ba.analysis.mutual_period(after).value == pytest.approx(11.3674, abs=2e-3)
    libration = [float(np.degrees(np.abs(ba.analysis.libration_angle(leg).value).max())) for leg in run.legs]
    assert libration[0] < 0.05
    assert 10 < libration[1] < 30
    surface = np.sum((impact.point.value / np.array([89.75, 84.7, 57.6])) ** 2)
    assert surface == pytest.approx(1, abs=1e-4)


@pytest.mark.parametrize(
    ("gravity", "oblate", "point", "minutes"),
    [
        (ba.PointMass(), True, False, -31.33),
        (ba.Multipole(4), False, False, -31.33 - 0.30),
        (ba.Multipole(4), True, False, -31.33 - 1.50 - 0.30),
        (ba.Multipole(4), True, True, -31.33 - 1.50 - 0.30 - 0.20),
    ],
)
def test_what_changes_the_period_of_dart(gravity: object, oblate: bool, point: bool, minutes: float) -> None:
    entry = ba.catalogue.entry("dart")
    didymos, dimorphos = entry.system.bodies
    if not oblate:
        didymos = ba.RigidBody("Didymos", ba.Sphere(380 * u.m), gm=didymos.gm)
    system = ba.System([didymos, dimorphos], gravity=gravity)
    start = ba.State.circular_orbit(system, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    (impact,) = entry.impulses
    if not point:
        impact = ba.Impulse(impact.time, impact.velocity_change(system), "Dimorphos")
    found = [
        ba.propagate(system, start, duration=60 * u.day, integrator=ba.Splitting(4 * u.min), impulses=impulses).legs[-1]
        for impulses in ([], [impact])
    ]
    before, after = (ba.analysis.mutual_period(leg).to_value("min") for leg in found)
    assert after - before == pytest.approx(minutes, abs=0.05)


def test_the_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", "dart", "--duration", "4d"]) == 0
    text = capsys.readouterr().out
    assert "Impact on Dimorphos after 23.8429 h: its velocity changes by 0.00263 m/s" in text
    assert "mutual period from 0 s to 23.8429 h 11.9" in text
    assert "mutual period from 23.8429 h to 4 d 11.3" in text
    assert "libration from 23.8429 h to 4 d at most 1" in text
    assert cli.main(["run", "dart", "--duration", "4d", "--step", "40s", "--force", "--json", "--no-picture"]) == 0
    result = json.loads(capsys.readouterr().out)
    before, after = result["legs"]
    assert before["end"] == after["begin"] == 23.842946 * 3600
    assert result["mutual_period"] == after["periods"]["Dimorphos"] < before["periods"]["Dimorphos"] - 1800
    (impact,) = result["impulses"]
    assert impact["type"] == "Impact"
    assert impact["velocity"] == [0, -6144.9, 0]
    assert impact["body"] == "Dimorphos"


def test_going_on_to_an_impulse(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """A run that stops before it is continued with the impulse at its time, one that is too short says so."""
    monkeypatch.chdir(tmp_path)
    assert cli.main(["run", "dart", "--duration", "12h", "--no-picture"]) == 0
    captured = capsys.readouterr()
    assert "warning: the impact after 23.8429 h is left out: the run ends after 12 h" in captured.err
    assert "Impact" not in captured.out
    entry = ba.catalogue.entry("dart")
    run = ba.propagate(
        entry.system, entry.state, duration=60 * u.day, integrator=ba.LGVI(40 * u.s), impulses=entry.impulses
    )[:20]
    run.write("part.h5")
    assert cli.main(["run", "part.h5", "--duration", "3d", "--no-picture", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    left = 23.842946 * 3600 - run.si.time[-1]
    assert result["legs"][1]["begin"] == pytest.approx(left, abs=1e-9)
