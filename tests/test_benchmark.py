"""The work-precision benchmark: its tables on made-up figures, its equations for heyoka, and a toy problem."""

import sys
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import binaryast as ba
from tests.conftest import attitude_angle

pytest.importorskip("heyoka")
if np.finfo(np.longdouble).eps > 1e-18:
    pytest.skip("no long doubles of 80 bits", allow_module_level=True)

from validation.benchmark import figures, measure, ours, problems, tables, taylor_runs
from validation.benchmark.heyoka_problem import HeyokaProblem
from validation.benchmark.measure import Candidate, Point, Run
from validation.systems import tumbling_pair


def made_up(family: str, method: str, *at: tuple[float, float, float]) -> list[Point]:
    """Points of a method: time, error of position, error of everything."""
    return [Point(family, method, str(k), t, 2 * t, position, every) for k, (t, position, every) in enumerate(at)]


POINTS = [
    *made_up("ours", "quick", (1e-3, 1e-4, 1e-2), (1e-2, 1e-8, 1e-4), (2e-2, 1e-7, 1e-4)),
    *made_up("ours", "exact", (5e-3, 1e-5, 1e-4), (5e-2, 1e-11, 1e-11)),
    *made_up("heyoka", "series", (1e-1, 1e-3, 1e-3), (2e-1, 1e-9, 1e-9)),
]


def test_time_to_reach_is_interpolated_in_logarithms_along_the_front() -> None:
    line = [(1e-4, 1e-3), (1e-8, 1e-2), (1e-7, 2e-2), (np.nan, 1e-9)]
    assert measure.front(line) == [(1e-4, 1e-3), (1e-8, 1e-2)]
    assert measure.time_to_reach(1e-6, line) == pytest.approx(1e-3 * 10**0.5, rel=1e-12)
    assert measure.time_to_reach(1e-3, line) == 1e-3  # never extrapolated
    assert measure.time_to_reach(1e-9, line) is None


def test_the_quickest_method_depends_on_error_and_kind() -> None:
    of_ours = [point for point in POINTS if point.family == "ours"]
    assert measure.best(1e-4, of_ours, "position") == (1e-3, "quick")
    assert measure.best(1e-4, of_ours, "everything") == (5e-3, "exact")
    assert measure.best(1e-4, of_ours, "position", call=True) == (2e-3, "quick")
    assert measure.best(1e-12, of_ours, "position") is None


def test_tables_say_what_is_reached_and_what_is_missed() -> None:
    problem = replace(problems.BY_NAME["degree-2"], asked={"position": {1e-4: 100.0, 1e-6: 50.0, 1e-10: 1.0}})
    result = tables.Result(problem, POINTS, 1e-14, ["a line"])
    series = 0.1 * 2 ** (np.log(10.0) / np.log(1e6))
    lines = {tuple(row[:2]): row for row in tables.ratios(result)}
    assert lines["position", 1e-4][2] == pytest.approx(series / 1e-3, rel=1e-12)
    assert lines["position", 1e-10][2] is None
    text = tables.report([result])
    assert f"| degree-2 | 0.0001 | position | {series / 1e-3:.3g} | 100 |" in text
    assert "| degree-2 | 1e-06 | position | 44.7 | 50, missed |" in text
    assert "| degree-2 | 1e-10 | position | - | 1, missed |" in text
    assert text.count("missed") == 2
    assert "| ours | quick | **1** |" in text
    assert "| degree-2 | position | heyoka, series | 112 | 44.7 |" in text
    assert f"1 / {series * 1e3:.3g} ({series * 1e3:.3g}) |" in tables.readme([result])[2]
    assert figures.diagram(result).axes[0].lines[0].get_xdata()[0] == 1e-4


def test_errors_of_an_end() -> None:
    _, state = tumbling_pair()
    end = measure.Snapshot(state.si.velocity, state.si.spin, state.si.position, state.si.attitude)
    apart = np.linalg.norm(end.x[1] - end.x[0])
    moved = end._replace(x=end.x + np.array([[0, 0, 0], [1e-6 * apart, 0, 0]]))
    assert measure.errors(moved, end) == pytest.approx((1e-6, 1e-6), rel=1e-8)
    assert measure.errors(end._replace(x=end.x + 5.0), end)[0] < 1e-14  # a place of both is no error of the pair
    c, s = np.cos(1e-5), np.sin(1e-5)
    turned = end._replace(R=end.R @ [[c, -s, 0], [s, c, 0], [0, 0, 1]])
    assert measure.errors(turned, end) == pytest.approx((0.0, 1e-5), rel=1e-8)
    assert attitude_angle(turned.R, end.R) == pytest.approx(1e-5, rel=1e-8)


def tumbling(gravity: Any) -> tuple[ba.System, ba.State]:
    """The tumbling pair with another gravity, of two clouds of points for `PointPairs`."""
    pair, state = tumbling_pair()
    bodies = list(pair.bodies)
    if isinstance(gravity, ba.PointPairs):
        shapes = problems.cloud((420.0, 400.0, 330.0), 6), problems.cloud((100.0, 80.0, 60.0), 5)
        bodies = [ba.RigidBody(b.name, shape, mass=b.mass) for b, shape in zip(bodies, shapes, strict=True)]
    return ba.System(bodies, gravity=gravity), state


@pytest.mark.parametrize("axes", ["primary", "inertial"])
@pytest.mark.parametrize(
    ("gravity", "expanded"),
    [(ba.Multipole(2), True), (ba.Multipole(4), True), (ba.Multipole(8), True), (ba.PointPairs(), True),
     (ba.PointPairs(), False)],
)  # fmt: skip
def test_the_equations_for_heyoka_are_those_of_the_paper(gravity: Any, expanded: bool, axes: str) -> None:
    system, state = tumbling(gravity)
    problem = HeyokaProblem(system, state, axes=axes, expanded=expanded)
    length, time, _ = problem.units
    found = problem.right_hand_side()(problem.y)
    ours = ba.equations.continuous(system, frame="inertial", form="lagrangian")
    rates = ours.unpack(ours.rhs(0.0, ours.from_state(state)))
    acceleration = found[3:6]
    if axes == "primary":
        acceleration = state.si.attitude[0] @ (acceleration + np.cross(problem.y[14:17], problem.y[3:6]))
    expected = (rates["v"][1] - rates["v"][0]) * time**2 / length
    np.testing.assert_allclose(acceleration, expected, atol=1e-13 * np.abs(expected).max())
    spins = np.array([found[14:17], found[17:20]])
    np.testing.assert_allclose(spins, rates["Omega"] * time**2, atol=1e-13)
    step = 1e-6  # the other variables by a step of Euler's method, whose error is its square
    at, after = (problem.snapshot(problem.y + share * step * found) for share in (0, 1))
    np.testing.assert_allclose(at.x[1] - at.x[0], (state.si.position[1] - state.si.position[0]), rtol=1e-14)
    moved = (after.x - at.x).astype(float) / (step * time)
    np.testing.assert_allclose(moved[1] - moved[0], state.si.velocity[1] - state.si.velocity[0], rtol=0, atol=1e-5)
    turned = (after.R - at.R).astype(float) / (step * time)
    np.testing.assert_allclose(turned, rates["R"], atol=1e-5 * np.abs(rates["R"]).max())


@pytest.mark.skipif(sys.platform != "linux", reason="heyoka's quadruple precision")
def test_a_toy_problem(tmp_path: Any) -> None:
    whole = problems.BY_NAME["degree-2"]
    sweep = problems.Sweep("LGVI", problems.lgvi(4), (400.0, 200.0, 100.0))
    toy = replace(whole, duration=86400.0, sweeps=(sweep,), asked={})
    end, distance = taylor_runs.reference(toy)
    assert distance < 1e-14
    settings = [taylor_runs.Compiled(taylor_runs.COMPACT, tolerance, 1.0) for tolerance in (1e-8, 1e-15)]
    points = measure.measure(ours.candidates(toy) + taylor_runs.candidates(toy, settings), end, 2)
    errors = {point.setting: point.everything for point in points}
    assert 12 < errors["400 s"] / errors["200 s"] < 20
    assert 12 < errors["200 s"] / errors["100 s"] < 20
    assert errors["1e-15"] < 1e-13
    text = tables.report([tables.Result(toy, points, distance, [])])
    assert "| heyoka | compact mode |" in text
    figures.diagram(tables.Result(toy, points, distance, [])).savefig(tmp_path / "toy.png")


def test_a_run_that_does_not_arrive_is_not_counted() -> None:
    nowhere = measure.Snapshot(*(np.full((2, 3), np.nan) for _ in range(3)), np.zeros((2, 3, 3)))
    there = measure.Snapshot(*(np.ones((2, 3)) * [[0], [1]] for _ in range(3)), np.zeros((2, 3, 3)))
    candidate = Candidate("ours", "lost", "1 s", lambda: Run(1e-9, 1e-9, nowhere))
    points = measure.measure([candidate], there, 1)
    assert measure.best(1.0, points, "position") is None
