"""The production step: the same map as (118)-(127) as printed, reversible, symplectic."""

import numpy as np
import pytest

import binaryast as ba
from binaryast import working
from binaryast.kernels import discrete, layout, lgvi, loop
from binaryast.kernels.contact import pair_touches
from binaryast.kernels.measure import pair_measure
from tests.conftest import attitude_angle, tumbling_pair, wobbling_pair


def steps(system: ba.System, state: np.ndarray, h: float, count: int) -> np.ndarray:
    """Take steps, in place; return what was watched."""
    watch = np.zeros(loop.WATCH_SIZE)
    constants = working.constants(system)
    watch[: loop.ENERGY_ERROR] = pair_measure(state, constants)[: loop.ENERGY_ERROR]
    watch[loop.CLOSEST] = np.inf
    status = loop.advance(
        lgvi.pair_step,
        pair_measure,
        pair_touches,
        system.gravity.potential,
        system.parameters,
        constants,
        np.array([0.0, 0.0, 0.0, 1.0]),
        state,
        watch,
        h,
        count,
        count,
        np.empty((1, layout.ROW_SIZE)),
    )
    assert status == 0
    return watch


def printed(system: ba.System, state: ba.State, h: float, count: int) -> dict[str, np.ndarray]:
    """Take steps of (118)-(127) as printed."""
    relative = state.relative()
    m1, m2 = system.secondary.si.mass, system.primary.si.mass
    j1, j2 = np.diag(system.secondary.si.moments), np.diag(system.primary.si.moments)
    r = relative.R.copy()
    v = {
        "X": relative.X.value.copy(),
        "Gamma": system.reduced_mass * relative.V.value,
        "Pi": r @ j1 @ r.T @ relative.Omega.value,
        "Pi2": j2 @ relative.Omega2.value,
        "R": r,
        "x2": state.si.position[0].copy(),
        "gamma2": m2 * state.si.velocity[0],
        "R2": state.si.attitude[0].copy(),
    }
    status = discrete.hamiltonian_relative(
        system.gravity.potential, system.parameters, m1, m2, j1, j2, h, count, *v.values()
    )
    assert status == 0
    return v


PAIRS = {"tumbling": tumbling_pair, "wobbling": wobbling_pair}


@pytest.mark.parametrize(
    ("name", "h", "count", "bound"),
    [
        ("tumbling", 10.0, 10_000, 1e-11),  # chaotic: later, the difference grows as any does
        ("wobbling", 40.0, 100_000, 1e-9),
        ("didymos", 40.0, 100_000, 1e-9),
        ("dumbbells", 5e-5, 100_000, 5e-8),  # far less until the encounter, which magnifies it
    ],
)
def test_it_is_the_printed_map(name: str, h: float, count: int, bound: float) -> None:
    """Position, velocity, attitude and momentum of both bodies agree to round-off and its growth."""
    system, state = PAIRS[name]() if name in PAIRS else ba.catalogue.load(name)
    v = printed(system, state, h, count)
    array = working.to_working(system, state)
    steps(system, array, h, count)
    time = np.array([h * count])
    motion = working.from_rows(system, array[None, : layout.ROW_SIZE], time, working.barycentre(system, state))
    scale = np.linalg.norm(v["X"])
    assert np.linalg.norm(motion.position[0, 0] - v["x2"]) < bound * scale
    relative = motion.attitude[0, 0].T @ (motion.position[0, 1] - motion.position[0, 0])
    assert np.linalg.norm(relative - v["X"]) < bound * scale
    assert attitude_angle(motion.attitude[0, 0], v["R2"]) < bound
    assert attitude_angle(motion.attitude[0, 1], v["R2"] @ v["R"]) < bound
    velocity = motion.attitude[0, 0].T @ (motion.velocity[0, 1] - motion.velocity[0, 0])
    gamma = system.reduced_mass * velocity
    assert np.linalg.norm(gamma - v["Gamma"]) < bound * np.linalg.norm(v["Gamma"])
    assert np.linalg.norm(motion.velocity[0, 0] * system.primary.si.mass - v["gamma2"]) < bound * np.linalg.norm(
        v["gamma2"]
    )
    pi2 = system.primary.si.moments * motion.spin[0, 0]
    assert np.linalg.norm(pi2 - v["Pi2"]) < bound * np.linalg.norm(v["Pi2"])
    pi = v["R"] @ (system.secondary.si.moments * motion.spin[0, 1])
    assert np.linalg.norm(pi - v["Pi"]) < bound * np.linalg.norm(v["Pi"])


def test_one_step_is_the_printed_one_to_the_last_digits() -> None:
    system, state = tumbling_pair()
    v = printed(system, state, 30.0, 1)
    array = working.to_working(system, state)
    steps(system, array, 30.0, 1)
    motion = working.from_rows(
        system, array[None, : layout.ROW_SIZE], np.array([30.0]), working.barycentre(system, state)
    )
    assert np.linalg.norm(motion.position[0, 0] - v["x2"]) < 1e-15 * np.linalg.norm(v["X"])
    assert attitude_angle(motion.attitude[0, 1], v["R2"] @ v["R"]) < 1e-15


def test_forward_and_back_returns() -> None:
    system, state = tumbling_pair()
    start = working.to_working(system, state)
    array = start.copy()
    steps(system, array, 20.0, 2000)
    steps(system, array, -20.0, 2000)
    scale = np.repeat([1200, 0.17, 1, 1e13, 1, 1e9], [3, 3, 4, 3, 4, 3])
    assert np.abs((array - start)[: layout.POTENTIAL] / scale).max() < 1e-11


def test_it_is_symplectic() -> None:
    """A finite-difference Jacobian in (x, p) for a pair without rotation, where T*Q is flat."""
    system, state = tumbling_pair()
    system = ba.System(system.bodies, gravity=ba.PointMass())
    base = working.to_working(system, state)
    mass = system.reduced_mass

    def stepped(z: np.ndarray) -> np.ndarray:
        array = base.copy()
        array[: layout.ATTITUDE_2] = z
        lgvi.prepare(array, system.gravity.potential, system.parameters)
        lgvi.pair_step(array, working.constants(system), system.gravity.potential, system.parameters, 500.0)
        return array[: layout.ATTITUDE_2]

    z = base[: layout.ATTITUDE_2].copy()
    scale = np.repeat([1e-2, 1e-6], 3)
    jacobian = np.column_stack(
        [(stepped(z + d) - stepped(z - d)) / (2 * s) for d, s in zip(np.diag(scale), scale, strict=True)]
    )
    form = np.block([[np.zeros((3, 3)), mass * np.eye(3)], [-mass * np.eye(3), np.zeros((3, 3))]])
    np.testing.assert_allclose(jacobian.T @ form @ jacobian, form, atol=1e-6 * mass)


def test_the_state_is_untouched_where_a_step_has_no_solution() -> None:
    system, state = tumbling_pair()
    array = working.to_working(system, state)
    before = array.copy()
    status = lgvi.pair_step(array, working.constants(system), system.gravity.potential, system.parameters, 5000.0)
    assert status == 2
    np.testing.assert_array_equal(array, before)


def test_nothing_else_influences_the_next_step() -> None:
    """A copy of the array goes on bit for bit: it is a checkpoint."""
    system, state = tumbling_pair()
    array = working.to_working(system, state)
    steps(system, array, 20.0, 500)
    copy = array.copy()
    steps(system, array, 20.0, 500)
    steps(system, copy, 20.0, 200)
    steps(system, copy, 20.0, 300)
    np.testing.assert_array_equal(array, copy)


def test_compensated_sums_pay() -> None:
    """Over 10^6 steps energy keeps no trace of round-off growth, momentum and rotations stay at the last digits."""
    system, state = tumbling_pair()
    array = working.to_working(system, state)
    first = steps(system, array, 10.0, 100_000)
    watch = steps(system, array, 10.0, 1_000_000)
    assert watch[loop.MOMENTUM_ERROR] / np.linalg.norm(watch[1:4]) < 2e-14
    assert watch[loop.ROTATION_ERROR] < 4e-15
    assert watch[loop.ENERGY_ERROR] < 3 * first[loop.ENERGY_ERROR]
