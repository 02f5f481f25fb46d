"""What every integrator must pass. To add one, add a line to `METHODS`."""

from collections.abc import Callable
from functools import partial

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.integrators import Integrator, Stepping
from tests.conftest import attitude_angle

Method = Callable[..., Stepping]
METHODS = {"LGVI": ba.LGVI, "LGVI inertial": partial(ba.LGVI, frame="inertial")}


@pytest.fixture(params=METHODS)
def method(request: pytest.FixtureRequest) -> Method:
    return METHODS[request.param]


def run(tumbling: tuple[ba.System, ba.State], integrator: Integrator, hours: float = 10) -> ba.Trajectory:
    return ba.propagate(*tumbling, duration=hours * u.h, integrator=integrator, save_every=hours / 10 * u.h)


def test_order_of_convergence(method: Method, tumbling: tuple[ba.System, ba.State]) -> None:
    """In position and attitude of both bodies, against a run with a step 16 times smaller."""
    reference = run(tumbling, method(step=0.625 * u.s))
    errors = []
    for step in (40, 20, 10):
        result = run(tumbling, method(step=step * u.s))
        position = np.linalg.norm(result.position[-1] - reference.position[-1], axis=-1).to_value("m")
        attitudes = [attitude_angle(result.attitude[-1, i], reference.attitude[-1, i]) for i in range(2)]
        errors.append([*position, *attitudes])
    slopes = np.log2(np.array(errors[:-1]) / np.array(errors[1:]))
    np.testing.assert_allclose(slopes, method(step=1 * u.s).order, atol=0.1)


def test_energy_is_bounded_and_momenta_are_kept(method: Method, tumbling: tuple[ba.System, ba.State]) -> None:
    result = run(tumbling, method(step=20 * u.s), hours=500)
    result.check(energy=1e-6, momentum=1e-13, rotation=5e-15)
    assert result.max_energy_error_over_potential < 1e-4


def test_a_run_cut_in_two_is_the_same_run(method: Method, tumbling: tuple[ba.System, ba.State]) -> None:
    system, _ = tumbling
    whole = run(tumbling, method(step=20 * u.s), hours=20)
    first = run(tumbling, method(step=20 * u.s), hours=10)
    second = run((system, first[-1]), method(step=20 * u.s), hours=10)
    assert np.abs(second.position[-1] - whole.position[-1]).max() < 1e-9 * u.m
    assert attitude_angle(second.attitude[-1], whole.attitude[-1]) < 1e-11


def test_time_turned_round_leads_back(method: Method, tumbling: tuple[ba.System, ba.State]) -> None:
    system, state = tumbling
    end = run(tumbling, method(step=20 * u.s))[-1]
    turned = ba.State(end.position, -end.velocity, end.attitude, -end.spin)
    back = run((system, turned), method(step=20 * u.s))[-1]
    assert np.abs(back.position - state.position).max() < 1e-9 * u.m
    assert np.abs(back.velocity + state.velocity).max() < 1e-12 * u.m / u.s
    assert attitude_angle(back.attitude, state.attitude) < 1e-11
    np.testing.assert_allclose(-back.spin.value, state.spin.value, atol=1e-14)


def test_the_same_run_twice_is_the_same_bits(method: Method, tumbling: tuple[ba.System, ba.State]) -> None:
    one, two = (run(tumbling, method(step=20 * u.s)) for _ in range(2))
    for left, right in zip(one.si, two.si, strict=True):
        np.testing.assert_array_equal(left, right)


def test_what_is_declared(method: Method) -> None:
    integrator = method(step=20 * u.s)
    assert integrator.symplectic
    assert integrator.reversible
    assert not integrator.adaptive
    assert integrator.largest_turn > 0
