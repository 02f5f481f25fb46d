"""SciPy's solvers on the continuous equations: accurate where they are tight, and off SO(3) as they say."""

import astropy.units as u
import numpy as np
import pytest
from validation.cases import four_bodies, tumbling_pair

import binaryast as ba
from binaryast.errors import ContactError, EndWarning, InputError, StepWarning
from tests.conftest import attitude_angle


def dumbbells(integrator: ba.RungeKutta, duration: float = 9.0, **options) -> ba.Trajectory:
    return ba.propagate(*ba.catalogue.load("dumbbells"), duration=duration * u.s, integrator=integrator, **options)


@pytest.mark.parametrize("frame", ["relative", "inertial"])
def test_high_precision_states(frame: str) -> None:
    """Those of the errata, by an independent implementation of the same method."""
    run = dumbbells(ba.RungeKutta(rtol=3e-14, atol=3e-14, frame=frame), save_every=1 * u.s)
    for row, expected in (
        (5, (-0.294973547348, 0.134272422190, -0.074388490523)),
        (9, (-0.081878775542, 0.073594701585, -0.001436890053)),
    ):
        np.testing.assert_allclose(run.si.position[row, 0], expected, atol=2e-11)
    assert run.separation[9].value == pytest.approx(0.330305022287, abs=2e-11)
    assert run.si.time.tolist() == list(range(10))


def test_the_variational_integrator_converges_to_it() -> None:
    system, state = tumbling_pair()
    exact = ba.propagate(system, state, duration=6 * u.h, integrator=ba.RungeKutta(rtol=1e-13, atol=1e-13))
    errors = []
    for step in (40, 20, 10):
        run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.LGVI(step * u.s))
        position = np.abs(run.si.position[-1] - exact.si.position[-1]).max()
        errors.append((position, attitude_angle(run.si.attitude[-1], exact.si.attitude[-1])))
    np.testing.assert_allclose(np.log2(np.divide(errors[:-1], errors[1:])), 2, atol=0.02)


@pytest.mark.parametrize(("method", "order", "steps"), [("DOP853", 8, (0.02, 0.01)), ("RK45", 5, (0.004, 0.002))])
def test_fixed_steps_have_the_order_of_the_method(method: str, order: int, steps: tuple) -> None:
    exact = dumbbells(ba.RungeKutta(rtol=3e-14, atol=3e-14), 1.0).si.position[-1]
    errors = []
    for step in steps:
        run = dumbbells(ba.RungeKutta(step=step * u.s, method=method), 1.0)
        assert run.steps == round(1 / step)
        assert run.step.value == pytest.approx(step)
        errors.append(np.abs(run.si.position[-1] - exact).max())
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.7)


def test_rows_of_fixed_steps_are_met_exactly() -> None:
    run = dumbbells(ba.RungeKutta(step=0.03 * u.s), 1.0, save_every=0.25 * u.s)
    np.testing.assert_allclose(run.si.time, [0, 0.25, 0.5, 0.75, 1.0], rtol=1e-15)
    assert run.steps == 4 * 9
    odd = dumbbells(ba.RungeKutta(step=0.03 * u.s), 1.0, save_every=0.3 * u.s)
    np.testing.assert_allclose(odd.si.time, [0, 0.3, 0.6, 0.9, 1.0], rtol=1e-14)


def test_it_leaves_rotations_and_says_so() -> None:
    with pytest.warns(StepWarning):
        run = dumbbells(ba.RungeKutta(rtol=1e-4, atol=1e-6, method="RK45"), 15.0)
    assert run.max_rotation_error > 1e-3
    assert run.rotation_error.max() <= run.max_rotation_error * 1.001
    with pytest.raises(InputError, match=r"left SO\(3\)"):
        run[-1]
    assert "SO(3)" in str(ba.RungeKutta.__doc__)


def test_four_bodies() -> None:
    system, state = four_bodies()
    run = ba.propagate(system, state, duration=6 * u.h, integrator=ba.RungeKutta(rtol=1e-12, atol=1e-12))
    run.check(energy=1e-10, momentum=1e-11, rotation=1e-9)
    steps = [ba.propagate(system, state, duration=6 * u.h, integrator=ba.LGVI(h * u.s)) for h in (20, 10)]
    extrapolated = (4 * steps[1].si.position[-1] - steps[0].si.position[-1]) / 3
    np.testing.assert_allclose(run.si.position[-1], extrapolated, atol=1e-5)


def test_contact_ends_it() -> None:
    bodies = [ba.RigidBody(name, ba.Sphere(100 * u.m), mass=1e10 * u.kg) for name in "AB"]
    zero = np.zeros((2, 3))

    def at(d: float) -> ba.State:
        return ba.State([[0, 0, 0], [d, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)

    with pytest.warns(EndWarning, match="B touched A"):
        run = ba.propagate(ba.System(bodies), at(1000), duration=3 * u.day, integrator=ba.RungeKutta())
    assert run.status == "contact"
    assert run.si.time[-1] < 3 * 86400
    with pytest.raises(ContactError):
        ba.propagate(ba.System(bodies), at(150), duration=1 * u.day, integrator=ba.RungeKutta())


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        ({"method": "RK4"}, "did you mean 'RK45'"),
        ({"rtol": 0}, "rtol=0"),
        ({"rtol": 1e-16}, "expected 2.3e-14 <= rtol"),
        ({"atol": -1.0}, "atol=-1"),
        ({"step": 10}, "no unit"),
        ({"step": -1 * u.s}, "positive"),
        ({"frame": "body"}, "expected one of relative, inertial"),
    ],
)
def test_wrong_arguments(arguments: dict, says: str) -> None:
    with pytest.raises(InputError, match=says):
        ba.RungeKutta(**arguments)


def test_what_it_declares() -> None:
    tight = ba.RungeKutta()
    assert (tight.order, tight.symplectic, tight.reversible, tight.adaptive) == (8, False, False, True)
    assert not ba.RungeKutta(step=1 * u.s).adaptive


def test_a_file_brings_it_back(tmp_path) -> None:
    run = dumbbells(ba.RungeKutta(rtol=1e-9, atol=1e-9), 1.0)
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    assert again.integrator.rtol == 1e-9
    assert again.integrator.step is None
