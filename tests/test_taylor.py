"""heyoka's Taylor series: formulas against the compiled potentials, runs against quadruple precision, refusals."""

import json
import signal
import sys
import time
from importlib.util import find_spec
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from validation.differences import difference, snapshot_of
from validation.systems import four_bodies, tumbling_pair

import binaryast as ba
from binaryast import cli, progress
from binaryast.errors import ContactError, EndWarning, InputError
from binaryast.gravity import Gravity
from binaryast.integrators import Integrator
from binaryast.schedule import Leg
from binaryast.state import State
from binaryast.system import System
from binaryast.taylor.attraction import Formula, formula_of
from binaryast.taylor.motion import Formulas
from binaryast.taylor.run import TaylorRun
from binaryast.working.bodies import WorkingBodies

needs_heyoka = pytest.mark.skipif(find_spec("heyoka") is None, reason="heyoka is not installed")
LENGTH = 2.0  # m, another unit than the metre
X, R = np.array([3.0, -4.0, 6.0]), Rotation.from_rotvec([0.4, -1.2, 0.7]).as_matrix()


def clouds(gravity: Gravity) -> System:
    """Two bodies of points that have no symmetry."""
    places = np.random.default_rng(1).normal(size=(2, 5, 3))
    return System(
        [ba.RigidBody(n, ba.PointCloud(some * u.m), mass=1e5 * u.kg) for n, some in zip("AB", places, strict=True)],
        gravity,
    )


def ellipsoids(gravity: Gravity) -> System:
    return System([ba.RigidBody(n, ba.Ellipsoid(2 * u.m, 1.5 * u.m, 1 * u.m), mass=1e5 * u.kg) for n in "AB"], gravity)


def formula(system: System) -> Formula:
    return formula_of(system, system.pairs[0], LENGTH)


@pytest.mark.parametrize(
    "system",
    [
        *(clouds(gravity) for gravity in (ba.PointMass(), ba.SecondDegree(), ba.PointPairs())),
        *(clouds(ba.Multipole(degree)) for degree in (2, 3, 8)),
        ellipsoids(ba.Multipole(16)),
    ],
    ids=lambda system: f"{system.gravity!r} {type(system.primary.shape).__name__}",
)
def test_formulas_are_the_compiled_potentials(system: System) -> None:
    of_pair = formula(system)
    exerted = of_pair.attraction(X / LENGTH, R.ravel(), of_pair.carried(R), float)
    strength = of_pair.strength / LENGTH
    values = [exerted.energy * strength, *np.multiply(exerted.gradient, strength / LENGTH)]
    u0, *rest = system.attraction(X, R)
    np.testing.assert_allclose(values, [u0, *rest[:3]], rtol=8e-15, atol=0)
    size = np.abs(rest[3:]).max()
    np.testing.assert_allclose(np.multiply(exerted.moment, strength), rest[3:], rtol=0, atol=8e-15 * size)


def test_what_is_carried_turns_with_the_body() -> None:
    of_pair, spin, h = formula(clouds(ba.Multipole(6))), np.array([0.3, -0.2, 0.5]), 1e-3
    turned = [np.array(of_pair.carried(Rotation.from_rotvec(k * h * spin).as_matrix() @ R)) for k in (-2, -1, 1, 2)]
    expected = (turned[0] - 8 * turned[1] + 8 * turned[2] - turned[3]) / (12 * h)
    rates = of_pair.rates(of_pair.carried(R), spin)
    np.testing.assert_allclose(rates, expected, rtol=0, atol=2e-11 * np.abs(expected).max())


def test_what_vanishes_is_no_variable() -> None:
    counts = {}
    for name, gravity in (("2", ba.SecondDegree()), ("4", ba.Multipole(4)), ("5", ba.Multipole(5))):
        counts[name] = [len(formula(of(gravity)).carried(R)) for of in (clouds, ellipsoids)]
    assert counts == {"2": [5, 5], "4": [21, 14], "5": [32, 14]}
    system, state = four_bodies()
    motion = Formulas(system, state, WorkingBodies(system, state))
    assert len(motion.start) == 3 * 13 + 6 + 3 * 5  # a point has no attitude, and is no secondary that turns
    assert np.all(np.abs(motion.start) < 10)


def run(case: tuple[System, State], hours: float, integrator: Integrator | None = None, **options) -> ba.Trajectory:
    return ba.propagate(*case, duration=hours * u.h, integrator=integrator or ba.Taylor(), **options)


def didymos(gravity: Gravity) -> tuple[System, State]:
    system, state = ba.catalogue.load("didymos")
    return System(system.bodies, gravity), state


CASES = {
    "tumbling": (tumbling_pair(), 10.0, 2e-14),
    "didymos": (didymos(ba.SecondDegree()), 24.0, 6e-14),
    "didymos, degree 4": (didymos(ba.Multipole(4)), 24.0, 6e-14),
    "dumbbells": (ba.catalogue.load("dumbbells"), 5 / 3600, 5e-14),
}


@needs_heyoka
@pytest.mark.parametrize("name", CASES)
def test_a_pair_is_where_quadruple_precision_says(name: str) -> None:
    """Position, velocity, attitude and spin of both bodies; by (55)-(62), from which nothing here is made."""
    from validation.oracles import taylor
    from validation.oracles.relative_equations import RelativeEquations

    case, hours, tolerance = CASES[name]
    result = run(case, hours)
    exact = taylor.floats(RelativeEquations(*case).at(hours * 3600))
    assert difference(snapshot_of(result[-1]), exact).largest < tolerance
    result.check(energy=3e-14, momentum=1e-14, rotation=1e-14)
    assert result.max_energy_error_over_potential < 1e-12


@needs_heyoka
@pytest.mark.parametrize("case", [ba.catalogue.load("sn263"), four_bodies()], ids=["sn263", "four"])
def test_several_bodies(case: tuple[System, State]) -> None:
    one, two = (run(case, 6, integrator) for integrator in (ba.Taylor(), ba.RungeKutta(2.3e-14, 2.3e-14)))
    assert difference(snapshot_of(one[-1]), snapshot_of(two[-1])).largest < 2e-12  # Runge-Kutta's
    one.check(energy=1e-14, momentum=1e-14, rotation=1e-14)
    assert two.steps > 3 * one.steps


@needs_heyoka
def test_rows_between_steps_are_as_accurate_as_steps() -> None:
    case = tumbling_pair()
    rows = run(case, 10, save_every=0.5 * u.h)
    assert len(rows) == 21
    assert rows.steps > 30
    assert rows.rotation_error.max() <= rows.max_rotation_error * (1 + 1e-9)
    for k in (1, 7, 13):
        ending_there = run(case, k / 2)
        assert ending_there.si.time[-1] == rows.si.time[k]
        assert difference(snapshot_of(rows[k]), snapshot_of(ending_there[-1])).largest < 1e-14


@needs_heyoka
def test_a_pole_is_no_special_direction() -> None:
    """The secondary passes exactly over the poles of both bodies, where axes along X would be undefined."""
    bodies = [
        ba.RigidBody(n, ba.Ellipsoid(a * u.m, 0.9 * a * u.m, 0.7 * a * u.m), mass=1e11 * u.kg)
        for n, a in (("A", 200), ("B", 150))
    ]
    system = System(bodies, ba.Multipole(4))
    position = [[0, 0, 0], [0, 0, 1000]] * u.m
    state = ba.State(position, [[0, 0, 0], [0.1, 0, 0]] * u.m / u.s, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s)
    one, two = (run((system, state), 6, integrator) for integrator in (ba.Taylor(), ba.RungeKutta(2.3e-14, 2.3e-14)))
    assert difference(snapshot_of(one[-1]), snapshot_of(two[-1])).position < 1e-12
    assert one.steps < 100


@needs_heyoka
def test_a_moving_barycentre_costs_nothing() -> None:
    system, state = tumbling_pair()
    far = State(state.position + 1.5e11 * u.m, state.velocity + 3e4 * u.m / u.s, state.attitude, state.spin)
    one, two = (run((system, start), 5) for start in (state, far))
    assert one.steps == two.steps
    np.testing.assert_allclose(
        two.si.position[-1] - far.si.position - 3e4 * 18000, one.si.position[-1] - state.si.position, atol=1e-3
    )


@needs_heyoka
def test_its_order_is_what_heyoka_takes() -> None:
    case = ba.catalogue.load("dumbbells")
    for tolerance in (1e-3, 1e-9, 1e-16, 1e-18):
        one = TaylorRun(*case, ba.Taylor(tolerance), Leg.of_run(1.0))
        assert one.integrator.order == ba.Taylor(tolerance).order
        assert one.integrator.tol == tolerance
        assert one.integrator.compact_mode


@needs_heyoka
def test_a_looser_tolerance_takes_fewer_terms_and_errs_more() -> None:
    case = ba.catalogue.load("dumbbells")
    exact = run(case, 5 / 3600)
    errors = [
        difference(snapshot_of(run(case, 5 / 3600, ba.Taylor(tolerance))[-1]), snapshot_of(exact[-1])).position
        for tolerance in (1e-5, 1e-8, 1e-11)
    ]
    assert 1e-6 < errors[0] < 1e-2
    assert errors[0] > 100 * errors[1] > 1e4 * errors[2]


def spheres(velocity: float) -> tuple[System, State]:
    """A small sphere 2 km from a large one, going across with a part of the speed of a circle."""
    bodies = [ba.RigidBody(n, ba.Sphere(r * u.m), mass=m * u.kg) for n, r, m in (("A", 1700, 1e12), ("B", 50, 1e9))]
    state = State.circular_orbit(System(bodies), separation=2 * u.km, spins=[10 * u.h, 10 * u.h])
    return System(bodies), State(state.position, velocity * state.velocity, state.attitude, state.spin)


@needs_heyoka
def test_contact_is_found_within_a_step_and_an_arc_beside_a_body_is_none() -> None:
    """The chord of a long step goes through the body that its arc goes round."""
    assert run(spheres(1), 20, ba.Taylor(1e-4)).status == "completed"
    with pytest.warns(EndWarning, match="B touched A"):
        result = run(spheres(0), 20, save_every=1 * u.min)
    assert result.status == "contact"
    assert result.separation[-1].value == pytest.approx(1750, rel=1e-14)
    assert np.all(np.diff(result.si.time) > 0)
    overlapping = State(
        [[0, 0, 0], [0, 0, 1]] * u.km, *(getattr(spheres(1)[1], n) for n in ("velocity", "attitude", "spin"))
    )
    with pytest.raises(ContactError, match="overlap at the start"):
        run((spheres(1)[0], overlapping), 1)


@needs_heyoka
def test_points_that_fall_into_each_other_end_a_run() -> None:
    system = System([ba.RigidBody(n, ba.Point(), mass=1e12 * u.kg) for n in "AB"], ba.PointMass())
    zero = np.zeros((2, 3))
    state = State([[0, 0, 0], [1, 0, 0]] * u.km, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
    with pytest.warns(EndWarning, match="too near one another; the last good row is at 3040"):
        result = run((system, state), 2)
    assert result.status == "failed"
    assert all(np.all(np.isfinite(array)) for array in result.si)
    fall = np.pi * np.sqrt(1000.0**3 / (8 * 2 * ba.constants.G * 1e12))
    assert result.si.time[-1] == pytest.approx(fall, rel=1e-9)


@needs_heyoka
def test_ctrl_c_stops_between_steps_and_the_rest_can_follow() -> None:
    system, state = tumbling_pair()
    one = TaylorRun(system, state, ba.Taylor(), Leg.of_run(36000.0, 60.0))
    one.go(lambda _: signal.raise_signal(signal.SIGINT))
    outcome = one.outcome()
    assert outcome.status == "interrupted"
    assert outcome.steps == 1
    assert outcome.time[-1] == one.elapsed < 36000
    middle = State(
        *(array[-1] * unit for array, unit in zip(outcome.motion[:2], (u.m, u.m / u.s), strict=True)),
        outcome.motion.attitude[-1],
        outcome.motion.spin[-1] * u.rad / u.s,
    )
    rest = run((system, middle), (36000 - one.elapsed) / 3600)
    assert difference(snapshot_of(rest[-1]), snapshot_of(run((system, state), 10)[-1])).largest < 1e-13


@needs_heyoka
def test_it_is_kept_in_a_file_with_what_it_was_made_by(tmp_path: Path) -> None:
    result = run(ba.catalogue.load("didymos"), 2, ba.Taylor(1e-14, compact=True))
    result.write(tmp_path / "run.h5")
    again = ba.Trajectory.read(tmp_path / "run.h5")
    assert repr(again.integrator) == "Taylor(tolerance=1e-14, compact=True)"
    assert again.provenance["heyoka"] >= "7"
    assert "on average" in again.summary()


@needs_heyoka
def test_command_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.chdir(tmp_path)
    arguments = ["--duration", "2h", "--json", "--no-picture", "--force", "-o", "run.h5"]
    assert cli.main(["run", "didymos", "--integrator", "Taylor", *arguments]) == 0
    assert json.loads(capsys.readouterr().out)["integrator"] == "Taylor(tolerance=1e-16, compact=True)"
    assert cli.main(["run", "run.h5", *arguments]) == 0
    assert json.loads(capsys.readouterr().out)["integrator"] == "Taylor(tolerance=1e-16, compact=True)"
    for option in (["--step", "40s"], ["--frame", "relative"]):
        assert cli.main(["run", "didymos", "--integrator", "Taylor", *option, *arguments]) == 2
        assert f"{option[0]}: Taylor does not take it" in json.loads(capsys.readouterr().out)["message"]


def test_scenario_file() -> None:
    text = ba.catalogue.text("dumbbells")
    with_table = text.replace("[run]", "[run]\nintegrator = { type = 'Taylor', tolerance = 1e-12 }")
    with pytest.raises(InputError, match=r"run\.step: Taylor chooses its steps itself: leave it out"):
        ba.scenario.loads(with_table, name="x", where="x")
    without_step = "\n".join(line for line in with_table.splitlines() if not line.startswith("step"))
    assert (
        repr(ba.scenario.loads(without_step, name="x", where="x").integrator) == "Taylor(tolerance=1e-12, compact=True)"
    )


def test_what_takes_long_is_said(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    monkeypatch.setattr(progress, "MOMENT", 0.01)
    for shown in (True, False):
        with progress.said_if_long("heyoka compiles", shown):
            time.sleep(0.1)
        assert capsys.readouterr().err == ("binaryast: heyoka compiles\n" if shown else "")


def test_without_heyoka_one_line_says_how_to_get_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "heyoka", None)
    integrator = ba.Taylor()
    with pytest.raises(InputError, match=r"heyoka is not installed.*'binaryast\[taylor\]'.*conda-forge") as caught:
        run(ba.catalogue.load("didymos"), 1, integrator)
    assert "\n" not in str(caught.value)


@needs_heyoka
@pytest.mark.parametrize("gravity", [ba.EllipsoidPair(), ba.Adaptive(accuracy=1e-6)])
def test_gravity_that_is_no_formula_is_refused(gravity: Gravity) -> None:
    system, state = tumbling_pair()
    with pytest.raises(InputError, match=r"between A and B cannot be written as a formula: expected ba\.PointMass"):
        run((System(system.bodies, gravity), state), 1)


def test_too_many_points_are_refused() -> None:
    cloud = ba.PointCloud(np.random.default_rng(1).normal(size=(65, 3)) * u.m)
    with pytest.raises(InputError, match="PointPairs of 65 x 65 points: expected at most 4096"):
        formula(System([ba.RigidBody(n, cloud, mass=1 * u.kg) for n in "AB"], ba.PointPairs()))


@pytest.mark.parametrize("tolerance", [0, -1e-10, 1e-2, 1e-19, np.nan, np.inf, "tight", None, 1e-10 * u.m])
def test_tolerances_that_cannot_be(tolerance: object) -> None:
    with pytest.raises(InputError, match="Taylor: tolerance"):
        ba.Taylor(tolerance)


def test_what_is_declared() -> None:
    integrator = ba.Taylor()
    assert (integrator.symplectic, integrator.reversible, integrator.adaptive) == (False, False, True)
    with pytest.raises(InputError, match="compact=3: expected True or False"):
        ba.Taylor(compact=3)
