"""Compositions and splittings as a user meets them: schemes, what is refused, fast spins, the corrector."""

import warnings

import astropy.units as u
import numpy as np
import pytest
from validation.systems import tumbling_pair

import binaryast as ba
from binaryast import integrators, schemes
from tests.conftest import attitude_angle

ALL = schemes.COMPOSITIONS | schemes.SPLITTINGS | schemes.KEPLER_SPLITTINGS


@pytest.mark.parametrize("name", ALL)
def test_schemes_are_symmetric_and_take_a_whole_step(name: str) -> None:
    scheme = ALL[name]
    assert sum(scheme.drifts) == pytest.approx(1, abs=5e-16)
    assert sum(scheme.kicks) == pytest.approx(1, abs=5e-16)
    assert scheme.drifts == scheme.drifts[::-1]
    assert scheme.kicks == scheme.kicks[::-1]
    assert len(scheme.shares) == 2 * scheme.stages + 1


@pytest.mark.parametrize("name", schemes.COMPOSITIONS)
def test_order_conditions_of_compositions(name: str) -> None:
    """A composition of order p has no sums of odd powers up to p - 1: the first of its conditions."""
    scheme = ALL[name]
    for power in range(3, scheme.order, 2):
        assert sum(np.array(scheme.drifts) ** power) == pytest.approx(0, abs=2e-15)
    assert abs(sum(np.array(scheme.drifts) ** (scheme.order + 1))) > 1e-7


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ba.LGVI(1 * u.s, order=3), "order=3: there are 2, 4, 6, 8, 10"),
        (lambda: ba.LGVI(1 * u.s, order="4"), "order='?4'?: there are"),
        (lambda: ba.LGVI(1 * u.s, scheme="yoshida"), "scheme='yoshida' is not known: did you mean 'yoshida4'"),
        (lambda: ba.LGVI(1 * u.s, order=6, scheme="kl8"), "scheme='kl8' has order 8, got order=6: leave one out"),
        (lambda: ba.Splitting(1 * u.s, "rkn8"), "there are leapfrog, rkn4, rkn6a, ss10"),
        (lambda: ba.Splitting(1 * u.s, frame="body"), "frame='body': expected one of relative, inertial"),
        (lambda: ba.Splitting(40), r"write step=40 \* u.s"),
        (lambda: ba.Splitting(0 * u.s), "step"),
        (lambda: ba.KeplerSplitting(1 * u.s, "rkn6a"), "there are aba104, aba864, aba1064"),
        (lambda: ba.KeplerSplitting(1 * u.s, corrector=True), "scheme='aba864' has none; there is one of aba104"),
        (lambda: ba.KeplerSplitting(1 * u.s, corrector="yes"), "corrector='yes': expected True or False"),
    ],
)
def test_what_is_no_integrator(make, says: str) -> None:
    with pytest.raises(ba.errors.InputError, match=says):
        make()


def test_an_unbound_pair_is_refused_by_kepler_splitting(didymos: ba.System) -> None:
    place, speed = [[0, 0, 0], [3, 0, 0]] * u.km, [[0, 0, 0], [0, 0.2, 0]] * u.m / u.s
    state = ba.State(place, speed, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s)
    with pytest.raises(
        ba.errors.InputError, match=r"a bound pair, got 0\.2 m/s at 3000 m, where 0\.15\d+ m/s is the speed of"
    ):
        ba.propagate(didymos, state, duration=1 * u.h, integrator=ba.KeplerSplitting(60 * u.s))
    run = ba.propagate(didymos, state, duration=10 * u.h, integrator=ba.Splitting(600 * u.s))
    run.check(energy=1e-9, momentum=1e-14, rotation=5e-15)


@pytest.mark.parametrize(
    ("order", "scheme", "limit"),
    [(2, None, 1.0), (4, None, 1.52), (4, "yoshida4", 0.5874), (6, None, 1.252), (8, None, 1.652), (10, None, 2.431)],
)
def test_the_limit_of_solvability(didymos: ba.System, order: int, scheme: str | None, limit: float) -> None:
    """Just below it every stage has a solution, at it the step is refused with the largest one."""
    spins = [2.26 * u.h, "synchronous"]
    state = ba.State.circular_orbit(didymos, period=11.921473 * u.h, spins=spins)
    spin = 2 * np.pi / (2.26 * 3600)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.StepWarning)
        below = ba.LGVI(0.999 * limit / spin * u.s, order=order, scheme=scheme)
        run = ba.propagate(didymos, state, duration=20 * below.step, integrator=below)
        assert run.status == "completed"
    above = ba.LGVI(1.001 * limit / spin * u.s, order=order, scheme=scheme)
    with pytest.raises(ba.errors.StepError, match=r"only below .*: the step must be below \d+") as refused:
        ba.propagate(didymos, state, duration=20 * above.step, integrator=above)
    assert ("order" in str(refused.value)) == (order > 2)


def test_a_fast_spin_costs_an_exact_rotation_nothing(didymos: ba.System) -> None:
    """A step that turns the primary by 1.4 rad, and one that turns it four times round: no warning, no lag."""
    state = ba.State.circular_orbit(didymos, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    reference = ba.propagate(didymos, state, duration=100 * u.h, integrator=ba.LGVI(100 * u.s, order=10))[-1]
    for integrator in (ba.Splitting(30 * u.min), ba.KeplerSplitting(30 * u.min, "aba1064")):
        end = ba.propagate(didymos, state, duration=100 * u.h, integrator=integrator)[-1]
        assert attitude_angle(end.attitude, reference.attitude) < 1e-6
    sphere = ba.System(
        [
            ba.RigidBody("A", ba.Sphere(400 * u.m), mass=5e11 * u.kg),
            ba.RigidBody("B", ba.Sphere(80 * u.m), mass=4e9 * u.kg),
        ]
    )
    spun = ba.State.circular_orbit(sphere, separation=1200 * u.m, spins=[10 * u.min, 5 * u.min])
    end = ba.propagate(sphere, spun, duration=50 * u.h, integrator=ba.KeplerSplitting(40 * u.min))
    turn = 2 * np.pi * (50 * 60 / 10)
    expected = [[np.cos(turn), -np.sin(turn), 0], [np.sin(turn), np.cos(turn), 0], [0, 0, 1]]
    np.testing.assert_allclose(end.si.attitude[-1, 0], expected, atol=3e-12)


def test_the_corrector(didymos: ba.System) -> None:
    state = ba.State.circular_orbit(didymos, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    options = {"duration": 99.7 * u.h, "save_every": 7 * u.h}  # the last stretch has steps of its own
    reference = ba.propagate(didymos, state, integrator=ba.Splitting(300 * u.s, "ss10"), **options)
    plain, corrected = (
        ba.propagate(didymos, state, integrator=ba.KeplerSplitting(20 * u.min, "aba104", corrector=on), **options)
        for on in (False, True)
    )
    assert corrected.steps == plain.steps
    np.testing.assert_array_equal(corrected.si.time, plain.si.time)
    assert corrected.max_energy_error < plain.max_energy_error / 8
    errors = [np.abs(run.si.position - reference.si.position).max() for run in (plain, corrected)]
    assert errors[1] < errors[0] / 1.7
    corrected.check(momentum=1e-14, rotation=5e-15)
    np.testing.assert_array_equal(corrected.si.position[0], plain.si.position[0])


def test_the_corrector_of_a_tumbling_pair_is_undone_at_every_row() -> None:
    """Its error falls with the fourth power of the step, too."""
    system, state = tumbling_pair()
    reference = ba.propagate(
        system, state, duration=20 * u.h, integrator=ba.LGVI(100 * u.s, order=10), save_every=2 * u.h
    )
    errors = []
    for step in (600, 300):
        integrator = ba.KeplerSplitting(step * u.s, "aba104", corrector=True)
        run = ba.propagate(system, state, duration=20 * u.h, integrator=integrator, save_every=2 * u.h)
        errors.append(np.abs(run.si.position - reference.si.position).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.3)


def test_integrators_survive_a_file(didymos: ba.System, tmp_path) -> None:
    state = ba.State.circular_orbit(didymos, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    for integrator in (
        ba.LGVI(60 * u.s, scheme="yoshida4"),
        ba.Splitting(600 * u.s, "ss10", "inertial"),
        ba.KeplerSplitting(600 * u.s, "aba104", corrector=True),
    ):
        run = ba.propagate(didymos, state, duration=2 * u.h, integrator=integrator)
        run.write(tmp_path / "run.h5", force=True)
        assert repr(ba.Trajectory.read(tmp_path / "run.h5").integrator) == repr(integrator)


def test_every_integrator_is_public() -> None:
    assert all(getattr(ba, name) is kind for name, kind in integrators.KINDS.items())
