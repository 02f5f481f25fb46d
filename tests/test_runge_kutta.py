"""SciPy's solvers on the continuous equations: accurate where they are tight, and off SO(3) as they say."""

import astropy.units as u
import numpy as np
import pytest
from validation.systems import four_bodies, tumbling_pair

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
    with pytest.warns(StepWarning, match="are no rotations"):
        state = run[-1]
    nearest = np.linalg.norm(np.eye(3) - np.swapaxes(state.attitude, -1, -2) @ state.attitude)
    assert nearest < 1e-14
    assert np.linalg.norm(state.attitude - run.si.attitude[-1]) < run.rotation_error[-1]
    assert run.relative.R.shape == (len(run), 3, 3)
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


@ba.pair_potential
def hollow(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
    """Kepler's within 1500 m; beyond, what p[1] says: a value that is no number, or an error."""
    r = (x * x + y * y + z * z) ** 0.5
    w = p[0] / r**3
    u = -p[0] / r
    if r > 1500:
        if p[1] == 0:
            raise ValueError("too far")
        if p[1] == 1:
            u = u * np.nan
        else:
            w = w * np.nan
    return u, w * x, w * y, w * z, 0.0, 0.0, 0.0


@pytest.mark.parametrize("kind", [0, 1, 2])
@pytest.mark.parametrize("step", [None, 50 * u.s])
def test_a_potential_that_fails_on_the_way_leaves_good_rows(kind: int, step: u.Quantity | None) -> None:
    bodies = [ba.RigidBody(name, ba.Sphere(10 * u.m), mass=1e11 * u.kg) for name in "AB"]
    gm = ba.constants.G * 1e22
    system = ba.System(bodies, gravity=ba.PairPotential(hollow, [gm, kind]))
    zero = np.zeros((2, 3))
    velocity = [[0, 0, 0], [0.3, 0.1, 0]] * u.m / u.s
    state = ba.State([[0, 0, 0], [1000, 0, 0]] * u.m, velocity, [np.eye(3)] * 2, zero / u.s * u.rad)
    with pytest.warns(EndWarning):
        run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.RungeKutta(step=step), save_every=50 * u.s)
    assert run.status == "failed"
    assert "not a number" in run.message or "too far" in run.message
    assert all(np.all(np.isfinite(array)) for array in run.si)
    assert 1000 < run.si.time[-1] < 3000
    equations = ba.equations.continuous(system)
    far = ba.State([[0, 0, 0], [2000, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero / u.s * u.rad)
    if kind != 1:
        with pytest.raises(InputError, match=r"gravity: the potential raised|not a number"):
            equations.rhs(0.0, equations.from_state(far))
        for frame in ("relative", "inertial"):
            steps = ba.equations.discrete(system, step=10 * u.s, frame=frame)
            with pytest.raises(InputError, match=r"gravity: |not a number"):
                steps.advance(steps.from_state(far), 3)


def test_a_point_may_come_first() -> None:
    """Round-off gives it no momentum, which would stop the solver."""
    bodies = [
        ba.RigidBody("P", ba.Point(), mass=1e12 * u.kg),
        ba.RigidBody("E", ba.Ellipsoid(200 * u.m, 150 * u.m, 100 * u.m), mass=1e12 * u.kg),
    ]
    spins = [None, [1e-4, 2e-4, 3e-4] * u.rad / u.s]
    for order in (1, -1):
        system = ba.System(bodies[::order])
        state = ba.State.from_orbits(system, [ba.Orbit(1 * u.km, 0.1)], spins=spins[::order])
        for frame in ("relative", "inertial"):
            run = ba.propagate(system, state, duration=1 * u.h, integrator=ba.RungeKutta(1e-8, 1e-8, frame=frame))
            assert run.steps < 100
        forms = [ba.equations.discrete(system, step=10 * u.s, frame=f) for f in ("relative", "inertial")]
        one, two = (form.snapshot(form.advance(form.from_state(state), 100)) for form in forms)
        np.testing.assert_allclose(one.x, two.x, atol=1e-9)


def test_an_arc_beside_a_body_is_no_contact() -> None:
    """The chord of a long step goes through the body that its arc goes round; a real contact is found in the step."""
    bodies = [ba.RigidBody(n, ba.Sphere(r * u.m), mass=m * u.kg) for n, r, m in (("A", 1700, 1e12), ("B", 50, 1e9))]
    system = ba.System(bodies)
    state = ba.State.circular_orbit(system, separation=2 * u.km, spins=[10 * u.h, 10 * u.h])
    run = ba.propagate(system, state, duration=20 * u.h, integrator=ba.RungeKutta(1e-4, 1e-4))
    assert run.status == "completed"
    falling = ba.State(state.position, 0 * state.velocity, state.attitude, state.spin)
    with pytest.warns(EndWarning, match="B touched A"):
        run = ba.propagate(system, falling, duration=20 * u.h, integrator=ba.RungeKutta(1e-4, 1e-4))
    assert 1700 < run.separation[-1].value < 1755


def test_a_moving_barycentre_costs_nothing() -> None:
    system, state = ba.catalogue.load("sn263")
    far = ba.State(state.position + 1.5e11 * u.m, state.velocity + 3e4 * u.m / u.s, state.attitude, state.spin)
    tight = ba.RungeKutta(1e-11, 1e-11)
    one, two = (ba.propagate(system, s, duration=1 * u.day, integrator=tight) for s in (state, far))
    assert one.steps == two.steps
    assert two.max_relative_energy_error < 1.5 * one.max_relative_energy_error


def test_its_figures_cover_its_rows() -> None:
    system, state = ba.catalogue.load("didymos")
    run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.RungeKutta(1e-6, 1e-6))
    assert run.rotation_error.max() <= run.max_rotation_error * (1 + 1e-9)
    error = np.abs(run.energy.value - run.energy.value[0]).max()
    assert error <= run.max_energy_error.value * (1 + 1e-6) + 1e-14 * abs(run.energy.value[0])
    assert run.separation.value.min() >= run.closest_approach.value * (1 - 1e-12)
