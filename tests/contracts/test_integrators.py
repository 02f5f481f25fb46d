"""What every integrator of equal steps must pass. To add one, add a line to `METHODS`."""

import copy
import pickle
from collections.abc import Callable
from functools import cache, partial
from typing import NamedTuple

import astropy.units as u
import numpy as np
import pytest
from validation.steps import take_steps
from validation.systems import four_bodies, tumbling_pair

import binaryast as ba
from binaryast import working
from binaryast.integrators import Integrator, Stepping
from tests.conftest import attitude_angle


class Method(NamedTuple):
    """A method, and in which numbers of steps in so many hours its error has come to fall with its order."""

    make: Callable[..., Stepping]
    counts: tuple[int, int]
    hours: float = 10


METHODS = {
    "LGVI": Method(ba.LGVI, (160, 320)),
    "LGVI inertial": Method(partial(ba.LGVI, frame="inertial"), (160, 320)),
    "LGVI 4": Method(partial(ba.LGVI, order=4), (160, 320)),
    "LGVI yoshida4": Method(partial(ba.LGVI, scheme="yoshida4"), (320, 640)),
    "LGVI 6": Method(partial(ba.LGVI, order=6), (113, 226)),
    "LGVI 8": Method(partial(ba.LGVI, order=8), (113, 160)),
    "LGVI 10": Method(partial(ba.LGVI, order=10), (56, 80)),
    "LGVI 6 inertial": Method(partial(ba.LGVI, order=6, frame="inertial"), (113, 226)),
    "Splitting leapfrog": Method(partial(ba.Splitting, scheme="leapfrog"), (160, 320)),
    "Splitting rkn4": Method(partial(ba.Splitting, scheme="rkn4"), (160, 320)),
    "Splitting rkn6a": Method(partial(ba.Splitting, scheme="rkn6a"), (40, 80)),
    "Splitting rkn6a inertial": Method(partial(ba.Splitting, scheme="rkn6a", frame="inertial"), (40, 80)),
    "Splitting ss10": Method(partial(ba.Splitting, scheme="ss10"), (212, 257), hours=100),
    "KeplerSplitting aba104": Method(partial(ba.KeplerSplitting, scheme="aba104"), (80, 160)),
    "KeplerSplitting aba864": Method(partial(ba.KeplerSplitting, scheme="aba864"), (80, 160)),
    "KeplerSplitting aba1064": Method(partial(ba.KeplerSplitting, scheme="aba1064"), (80, 160)),
}


@pytest.fixture(params=METHODS)
def method(request: pytest.FixtureRequest) -> Callable[..., Stepping]:
    return METHODS[request.param].make


def run(
    tumbling: tuple[ba.System, ba.State], integrator: Integrator, hours: float = 10, rows: int = 10
) -> ba.Trajectory:
    return ba.propagate(*tumbling, duration=hours * u.h, integrator=integrator, save_every=hours / rows * u.h)


def in_steps(tumbling: tuple[ba.System, ba.State], make: Callable[..., Stepping], hours: float, count: int) -> ba.State:
    """Return where so many steps lead in so many hours."""
    step = hours / count * (1 + 1e-12) * u.h
    result = run(tumbling, make(step=step), hours, rows=1)
    assert result.steps == count
    return result[-1]


def error(state: ba.State, reference: ba.State) -> float:
    """Return the largest of the errors in position, relative to the distance, and attitude [rad] of both bodies."""
    distance = np.linalg.norm(reference.position[1] - reference.position[0])
    position = np.linalg.norm(state.position - reference.position, axis=1).max() / distance
    return max(float(position), attitude_angle(state.attitude, reference.attitude))


@cache
def reference(hours: float) -> ba.State:
    """Return where the tumbling pair is, to 2e-14 of everything."""
    return in_steps(tumbling_pair(), partial(ba.LGVI, order=10), hours, round(36 * hours))


def test_the_references_agree_with_others(tumbling: tuple[ba.System, ba.State]) -> None:
    """The other family at order 10, and SciPy's integrator on the equations as printed."""
    other = in_steps(tumbling, partial(ba.Splitting, scheme="ss10"), 100, 1800)
    assert error(other, reference(100)) < 2e-13
    printed = run(tumbling, ba.RungeKutta(rtol=1e-13, atol=1e-13), rows=1)[-1]
    assert error(printed, reference(10)) < 1e-11


@pytest.mark.filterwarnings("ignore::binaryast.errors.StepWarning")  # long steps show a high order
@pytest.mark.parametrize("name", METHODS)
def test_order_of_convergence(name: str, tumbling: tuple[ba.System, ba.State]) -> None:
    make, counts, hours = METHODS[name]
    errors = [error(in_steps(tumbling, make, hours, count), reference(hours)) for count in counts]
    slope = np.log(errors[0] / errors[1]) / np.log(counts[1] / counts[0])
    assert slope == pytest.approx(make(step=1 * u.s).order, abs=0.2)


def test_energy_is_bounded_and_momenta_are_kept(
    method: Callable[..., Stepping], tumbling: tuple[ba.System, ba.State]
) -> None:
    result = run(tumbling, method(step=20 * u.s), hours=500)
    bounds = {2: 1e-6, 4: 1e-11}
    result.check(energy=bounds.get(result.integrator.order, 1e-12), momentum=1e-13, rotation=5e-15)
    assert result.max_energy_error_over_potential < 1e-4


def test_a_run_cut_in_two_is_the_same_run(
    method: Callable[..., Stepping], tumbling: tuple[ba.System, ba.State]
) -> None:
    system, _ = tumbling
    whole = run(tumbling, method(step=20 * u.s), hours=20)
    first = run(tumbling, method(step=20 * u.s), hours=10)
    second = run((system, first[-1]), method(step=20 * u.s), hours=10)
    assert np.abs(second.position[-1] - whole.position[-1]).max() < 1e-9 * u.m
    assert attitude_angle(second.attitude[-1], whole.attitude[-1]) < 1e-11


def test_time_turned_round_leads_back(method: Callable[..., Stepping], tumbling: tuple[ba.System, ba.State]) -> None:
    system, state = tumbling
    end = run(tumbling, method(step=20 * u.s))[-1]
    turned = ba.State(end.position, -end.velocity, end.attitude, -end.spin)
    back = run((system, turned), method(step=20 * u.s))[-1]
    assert np.abs(back.position - state.position).max() < 1e-9 * u.m
    assert np.abs(back.velocity + state.velocity).max() < 1e-12 * u.m / u.s
    assert attitude_angle(back.attitude, state.attitude) < 1e-11
    np.testing.assert_allclose(-back.spin.value, state.spin.value, atol=1e-14)


def test_a_checkpoint_goes_on_bit_for_bit(
    method: Callable[..., Stepping], tumbling: tuple[ba.System, ba.State]
) -> None:
    """The working state is all that influences the next step."""
    integrator = method(step=20 * u.s)
    inertial = integrator.is_inertial(tumbling[0])
    one, other = (working.of(*tumbling, inertial=inertial) for _ in range(2))
    take_steps(one, 20.0, 300, integrator=integrator)
    other.state[:] = one.state
    take_steps(one, 20.0, 200, integrator=integrator)
    take_steps(other, 20.0, 120, integrator=integrator)
    take_steps(other, 20.0, 80, integrator=integrator)
    np.testing.assert_array_equal(one.state, other.state)


def test_the_same_run_twice_is_the_same_bits(
    method: Callable[..., Stepping], tumbling: tuple[ba.System, ba.State]
) -> None:
    one, two = (run(tumbling, method(step=20 * u.s)) for _ in range(2))
    for left, right in zip(one.si, two.si, strict=True):
        np.testing.assert_array_equal(left, right)


def test_several_bodies_or_a_refusal(method: Callable[..., Stepping]) -> None:
    integrator = method(step=20 * u.s)
    system, state = four_bodies()
    if integrator.several:
        result = ba.propagate(system, state, duration=5 * u.h, integrator=integrator)
        result.check(momentum=1e-13, rotation=5e-15)
    else:
        with pytest.raises(ba.errors.InputError, match=r"for a pair, got 4 bodies: take ba\.Splitting"):
            ba.propagate(system, state, duration=5 * u.h, integrator=integrator)


def test_what_is_declared(method: Callable[..., Stepping]) -> None:
    integrator = method(step=20 * u.s)
    assert integrator.symplectic
    assert integrator.reversible
    assert not integrator.adaptive
    assert integrator.largest_turn > 0
    for other in (pickle.loads(pickle.dumps(integrator)), copy.deepcopy(integrator)):
        assert repr(other) == repr(integrator)
