"""The production step: the same map as (118)-(127) as printed, reversible, symplectic."""

import astropy.units as u
import numpy as np
import pytest
from validation.steps import snapshot, take_steps
from validation.systems import tumbling_pair, wobbling_pair

import binaryast as ba
from binaryast import schemes, working
from binaryast.equations.legendre import Snapshot
from binaryast.kernels import loop, status
from binaryast.kernels.pair import lgvi
from tests.conftest import attitude_angle

SECOND_ORDER = schemes.LEAPFROG.shares


def printed(system: ba.System, state: ba.State, h: float, count: int) -> Snapshot:
    """Take steps of (118)-(127) as printed."""
    equations = ba.equations.discrete(system, step=h * u.s, frame="relative", form="hamiltonian")
    return equations.snapshot(equations.advance(equations.from_state(state), count))


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
    """Position, velocity, attitude and spin of both bodies agree to round-off and its growth."""
    system, state = PAIRS[name]() if name in PAIRS else ba.catalogue.load(name)
    expected = printed(system, state, h, count)
    w = working.of(system, state)
    take_steps(w, h, count)
    found = snapshot(w, h * count)
    for one, two in ((found.x, expected.x), (found.v, expected.v)):
        assert np.abs((one[1] - one[0]) - (two[1] - two[0])).max() < bound * np.linalg.norm(two[1] - two[0])
        assert np.abs(one - two).max() < bound * np.linalg.norm(two[1] - two[0])
    assert attitude_angle(found.R, expected.R) < bound
    assert np.all(np.abs(found.Omega - expected.Omega).max(axis=1) < bound * np.linalg.norm(expected.Omega, axis=1))


def test_one_step_is_the_printed_one_to_the_last_digits() -> None:
    system, state = tumbling_pair()
    expected = printed(system, state, 30.0, 1)
    w = working.of(system, state)
    take_steps(w, 30.0, 1)
    found = snapshot(w, 30.0)
    assert np.linalg.norm(found.x - expected.x) < 1e-15 * np.linalg.norm(expected.x[1] - expected.x[0])
    assert attitude_angle(found.R, expected.R) < 1e-15


def test_the_state_is_untouched_where_a_step_has_no_solution() -> None:
    system, state = tumbling_pair()
    w = working.of(system, state)
    before = w.state.copy()
    assert (
        lgvi.step(w.state, w.constants, SECOND_ORDER, w.attraction, w.parameters, w.external, 5000.0)
        == status.NO_ROTATION
    )
    np.testing.assert_array_equal(w.state, before)


def test_compensated_sums_pay() -> None:
    """Over 10^6 steps energy keeps no trace of round-off growth, momentum and rotations stay at the last digits."""
    system, state = tumbling_pair()
    w = working.of(system, state)
    first = take_steps(w, 10.0, 100_000)
    watch = take_steps(w, 10.0, 1_000_000)
    assert watch[loop.ANGULAR_ERROR] / np.linalg.norm(watch[1:4]) < 2e-14
    assert watch[loop.ROTATION_ERROR] < 4e-15
    assert watch[loop.ENERGY_ERROR] < 3 * first[loop.ENERGY_ERROR]
