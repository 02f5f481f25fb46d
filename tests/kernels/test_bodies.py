"""The production step of several bodies: the same map as (93)-(97) as printed, and for two as the pair's."""

import astropy.units as u
import numpy as np
import pytest
from validation.steps import snapshot, take_steps
from validation.systems import four_bodies, tumbling_pair, wobbling_pair

import binaryast as ba
from binaryast import schemes, working
from binaryast.kernels import loop, status
from binaryast.kernels.bodies import layout, lgvi, stages
from binaryast.kernels.bodies import loop as bodies_loop
from tests.conftest import attitude_angle

SECOND_ORDER = schemes.LEAPFROG.shares


@pytest.mark.parametrize(
    ("make", "h", "count", "bound"),
    [
        (wobbling_pair, 40.0, 100_000, 1e-9),
        (four_bodies, 20.0, 10_000, 1e-11),
        (lambda: ba.catalogue.load("sn263"), 60.0, 100_000, 1e-9),
        (lambda: ba.catalogue.load("dumbbells"), 2e-4, 10_000, 1e-10),
    ],
)
def test_it_is_the_printed_map(make, h: float, count: int, bound: float) -> None:
    """Position, velocity, attitude and spin of every body agree to round-off and its growth."""
    system, state = make()
    equations = ba.equations.discrete(system, step=h * u.s, frame="inertial")
    expected = equations.snapshot(equations.advance(equations.from_state(state), count))
    w = working.of(system, state, inertial=True)
    take_steps(w, h, count)
    found = snapshot(w)
    size = np.linalg.norm(expected.x[1] - expected.x[0])
    assert np.abs(found.x - expected.x).max() < bound * size
    assert np.abs(found.v - expected.v).max() < bound * np.abs(expected.v).max()
    assert attitude_angle(found.R, expected.R) < bound
    assert np.all(np.abs(found.Omega - expected.Omega).max(axis=1) <= bound * np.linalg.norm(expected.Omega, axis=1))


@pytest.mark.parametrize(
    ("make", "h", "count", "bound"),
    [
        (tumbling_pair, 20.0, 10_000, 1e-11),  # chaotic: later, the difference grows as any does
        (wobbling_pair, 40.0, 100_000, 1e-11),
        (lambda: ba.catalogue.load("dumbbells"), 2e-4, 10_000, 1e-11),
    ],
)
def test_two_bodies_move_as_a_pair(make, h: float, count: int, bound: float) -> None:
    system, state = make()
    one, two = working.of(system, state), working.of(system, state, inertial=True)
    take_steps(one, h, count)
    take_steps(two, h, count)
    pair, bodies = snapshot(one), snapshot(two)
    assert np.abs(bodies.x - pair.x).max() < bound * np.linalg.norm(pair.x[1] - pair.x[0])
    assert attitude_angle(bodies.R, pair.R) < bound
    assert np.abs(bodies.Omega - pair.Omega).max() < bound * np.abs(pair.Omega).max()


def test_momenta_over_a_million_steps() -> None:
    """Linear and angular momentum to round-off, energy without growth, in a triple."""
    w = working.of(*ba.catalogue.load("sn263"))
    speeds = w.masses @ np.linalg.norm(w.state[layout.velocity_of(3) : layout.attitude_of(3)].reshape(3, 3), axis=1)
    first = take_steps(w, 60.0, 100_000)
    watch = take_steps(w, 60.0, 1_000_000)
    assert watch[loop.ANGULAR_ERROR] / np.linalg.norm(watch[1:4]) < 2e-14
    assert watch[loop.LINEAR_ERROR] / speeds < 2e-15
    assert watch[loop.ROTATION_ERROR] < 5e-15
    assert watch[loop.ENERGY_ERROR] < 1.5 * first[loop.ENERGY_ERROR]


def test_a_step_without_a_solution_leaves_the_state_as_it_was() -> None:
    system, state = four_bodies()
    w = working.of(system, state)
    before = w.state.copy()
    assert (
        lgvi.step(w.state, w.constants, SECOND_ORDER, w.attraction, w.parameters, w.external, 5000.0)
        == status.NO_ROTATION
    )
    assert np.any(w.state != before)
    w.state[:] = before
    arrays = (
        SECOND_ORDER,
        w.attraction,
        w.parameters,
        w.external,
        w.constants,
        w.surfaces,
        w.state,
        w.before,
        np.zeros(loop.WATCH_SIZE),
    )
    rows = np.empty((1, w.row_size))
    assert w.advance(lgvi.step, w.measure, w.touching, *arrays, 5000.0, 10, 10, rows) == status.NO_ROTATION
    np.testing.assert_array_equal(w.state, before)


@pytest.mark.parametrize("make", [tumbling_pair, four_bodies])
def test_nothing_else_influences_the_next_step(make) -> None:
    """A copy of the array goes on bit for bit: it is a checkpoint, of a pair and of several bodies."""
    w, copy = working.of(*make()), working.of(*make())
    take_steps(w, 20.0, 500)
    copy.state[:] = w.state
    take_steps(w, 20.0, 500)
    take_steps(copy, 20.0, 200)
    take_steps(copy, 20.0, 300)
    np.testing.assert_array_equal(w.state, copy.state)


def test_one_compilation_serves_any_number_of_pairs() -> None:
    """Two to twelve bodies, of several models, with one set of compiled kernels."""
    for count in (2, 3, 12):
        bodies = [ba.RigidBody(f"{i}", ba.Sphere(10 * u.m), mass=1e9 * u.kg) for i in range(count)]
        place = np.stack([np.arange(count) * 1e4, np.arange(count) ** 2 * 1e3, np.zeros(count)], axis=1)
        zero = np.zeros((count, 3))
        state = ba.State(place * u.m, zero * u.m / u.s, [np.eye(3)] * count, zero * u.rad / u.s)
        models = [ba.PointMass(), ba.SecondDegree(), ba.PointPairs()]
        gravity = [models[i % 3] for i in range(count * (count - 1) // 2)]
        w = working.of(ba.System(bodies, gravity=gravity), state, inertial=True)
        take_steps(w, 10.0, 20)
    assert [len(kernel.overloads) for kernel in (bodies_loop.advance, lgvi.step, stages.exert)] == [1, 1, 1]


def test_a_point_feels_what_it_should_and_does_not_turn() -> None:
    """A light point about a heavy sphere moves as Kepler says; beside a rigid body it takes no torque."""
    system = ba.System(
        [ba.RigidBody("S", ba.Sphere(100 * u.m), mass=1e12 * u.kg), ba.RigidBody("P", ba.Point(), mass=1 * u.kg)]
    )
    orbit = ba.Orbit(1000 * u.m, 0.3)
    state = ba.State.from_orbits(system, [orbit], spins=[10 * u.h, None])
    period = 2 * np.pi / orbit.rate(sum(body.si.gm for body in system.bodies)) * u.s
    run = ba.propagate(system, state, duration=period, integrator=ba.LGVI(1 * u.s, frame="inertial"))
    assert np.linalg.norm(run.position[-1, 1] - run.position[0, 1]) < 0.02 * u.m
    np.testing.assert_array_equal(
        run.si.attitude[:, 1], np.broadcast_to(state.attitude[1], run.si.attitude[:, 1].shape)
    )
    np.testing.assert_array_equal(run.si.spin[:, 1], 0)
    also = ba.propagate(system, state, duration=period, integrator=ba.LGVI(1 * u.s))
    np.testing.assert_allclose(also.si.position[-1], run.si.position[-1], atol=1e-9)
