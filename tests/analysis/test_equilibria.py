"""Relative equilibria: against closed forms of second degree, and as runs."""

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from validation.cases import libration
from validation.oracles import librations

import binaryast as ba
from binaryast.errors import InputError

PLANAR = {("x", "z"): 0, ("y", "z"): 1, ("z", "x"): 2, ("x", "y"): 0, ("y", "x"): 1, ("z", "y"): 2}


def ellipsoids(gravity: object = None) -> ba.System:
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(*(np.array(axes) * u.m)), density=2000 * u.kg / u.m**3)
        for name, axes in (("A", (500, 400, 300)), ("B", (250, 200, 150)))
    ]
    return ba.System(bodies, gravity or ba.SecondDegree())


def closed_rate(system: ba.System, r: float, primary: tuple[str, str], secondary: tuple[str, str]) -> float:
    """Return n of m n^2 r = dU/dr at second degree, an axis of each along the line of centres."""
    one, two = system.secondary.si, system.primary.si
    pull = one.gm * two.mass / r**2
    for body, other, axes in ((one, two, secondary), (two, one, primary)):
        along = body.moments[PLANAR[axes]]
        pull += 1.5 * other.gm * (body.moments.sum() - 3 * along) / r**4
    return float(np.sqrt(pull / (system.reduced_mass * r)))


def test_all_families_against_the_closed_form() -> None:
    system = ellipsoids()
    found = ba.analysis.relative_equilibria(system, separation=3 * u.km)
    assert len(found) == 36
    for one in found:
        assert one.residual < 1e-14
        rate = closed_rate(system, 3000.0, one.primary_axes, one.secondary_axes)
        assert one.rate.value == pytest.approx(rate, rel=1e-14)
        assert one.separation.value == pytest.approx(3000.0, rel=1e-14)
    stable = [(one.primary_axes, one.secondary_axes) for one in found if one.stable]
    assert (("x", "z"), ("x", "z")) in stable
    assert all(axes[0] != "z" for pair in stable for axes in pair)


def test_by_period() -> None:
    system = ellipsoids()
    one = ba.analysis.relative_equilibrium(system, period=30 * u.h)
    assert one.period.to_value("h") == pytest.approx(30, rel=1e-14)
    again = ba.analysis.relative_equilibrium(system, separation=one.separation)
    assert again.rate.value == pytest.approx(one.rate.value, rel=1e-13)


@pytest.mark.parametrize("order", [slice(None), slice(None, None, -1)])
@pytest.mark.parametrize(("separation", "tolerance"), [(600.0, 5e-13), (1195.0, 5e-13), (4800.0, 2e-11)])
def test_small_oscillations_of_a_sphere_and_an_ellipsoid(separation: float, tolerance: float, order: slice) -> None:
    """Whichever is the primary; its torque is a difference of moments of m r^2, which costs digits where r is large."""
    theory = libration.closed_form(separation)
    system = ba.System(libration.system().bodies[order])
    one = ba.analysis.relative_equilibrium(system, separation=separation * u.m)
    assert one.stable
    assert one.rate.value == pytest.approx(theory.rate, rel=1e-14)
    measured = one.frequencies.value / theory.rate
    assert len(measured) == 4
    for frequency in theory.frequencies():
        assert np.abs(measured / frequency - 1).min() < tolerance


def test_out_of_the_plane_a_light_body_moves_as_debra_and_delp_say() -> None:
    sphere = ba.RigidBody("sphere", ba.Sphere(400 * u.m), mass=1e12 * u.kg)
    stone = ba.RigidBody("stone", ba.Ellipsoid(85 * u.m, 73 * u.m, 63 * u.m), mass=1.0 * u.kg)
    one = ba.analysis.relative_equilibrium(ba.System([sphere, stone]), separation=1e5 * u.km)
    moments = np.asarray(stone.si.moments)
    expected = [*librations.roll_and_yaw(moments), librations.pitch(moments), 1.0]
    np.testing.assert_allclose(np.sort(one.frequencies.value / one.rate.value), np.sort(expected), rtol=1e-10)


@pytest.mark.parametrize("gravity", [ba.SecondDegree(), ba.Multipole(4)])
def test_a_run_near_an_equilibrium_has_its_frequencies(gravity: ba.SecondDegree | ba.Multipole) -> None:
    """All seven: of distance, faces and poles. The size of the angular momentum is kept, by which they change."""
    system = ellipsoids(gravity)
    one = ba.analysis.relative_equilibrium(system, separation=2 * u.km)
    assert one.stable
    at = one.state
    start = ba.RelativeState(
        X=at.X,
        V=at.V + 1e-5 * at.V[1] * [1, 0, 1],
        R=Rotation.from_rotvec([3e-5, 2e-5, 5e-5]).as_matrix() @ at.R,
        Omega=at.Omega + 2e-5 * one.rate * [1, 1, 0],
        Omega2=at.Omega2 + 2e-5 * one.rate * [0, 1, 0],
    )
    step = one.period / 16
    run = ba.propagate(
        system,
        start.to_state(system),
        duration=200 * one.period,
        integrator=ba.Splitting(step * (1 + 1e-12), scheme="ss10"),
        save_every=step,
    )
    x, r = run.relative.X.value, run.relative.R
    series = (x[:, 0], x[:, 1], x[:, 2], r[:, 0, 1], r[:, 0, 2], r[:, 1, 2])
    lines = [ba.analysis.spectrum(run.time, values - values.mean(), lines=4).frequency.value for values in series]
    measured = np.concatenate(lines)
    assert len(one.frequencies) == 7
    apart = [np.abs(measured / frequency - 1).min() for frequency in one.frequencies.value]
    assert max(apart) < 1e-6


def test_an_unstable_one_is_left_at_its_rate() -> None:
    system = ellipsoids()
    one = ba.analysis.relative_equilibrium(system, separation=3 * u.km, secondary=("y", "z"))
    assert not one.stable
    at = one.state
    start = ba.RelativeState(
        X=at.X, V=at.V, R=Rotation.from_rotvec([0, 0, 1e-9]).as_matrix() @ at.R, Omega=at.Omega, Omega2=at.Omega2
    )
    grown = 8 / one.growth.value
    run = ba.propagate(
        system,
        start.to_state(system),
        duration=2 * grown * u.s,
        integrator=ba.Splitting(one.period / 100, scheme="ss10"),
        save_every=grown / 40 * u.s,
    )
    late = slice(40, 70)
    slope = np.polyfit(run.si.time[late], np.log(np.abs(run.relative.R[late, 0, 0])), 1)[0]
    assert slope == pytest.approx(one.growth.value, rel=1e-3)


def test_bodies_without_symmetry_lie_a_little_beside() -> None:
    clouds = [ba.PointCloud(np.random.default_rng(seed).normal(size=(9, 3)) * [200, 120, 80] * u.m) for seed in (1, 2)]
    bodies = [ba.RigidBody(n, c, mass=m * u.kg) for n, c, m in zip("AB", clouds, (1e12, 1e11), strict=True)]
    system = ba.System(bodies, ba.PointPairs())
    one = ba.analysis.relative_equilibrium(system, separation=3 * u.km)
    assert one.residual < 1e-14
    assert 0.001 < abs(one.state.X[1] / one.separation) < 0.1
    run = ba.propagate(
        system, one.state.to_state(system), duration=2 * one.period, integrator=ba.Splitting(one.period / 300)
    )
    np.testing.assert_allclose(run.relative.X.value, run.relative.X.value[:1] + np.zeros((len(run), 1)), atol=1e-4)


def test_what_is_none() -> None:
    system = ellipsoids()
    for arguments, match in (
        ({}, "exactly one"),
        ({"separation": 1 * u.km, "period": 1 * u.h}, "exactly one"),
        ({"separation": 3 * u.km, "primary": ("x", "x")}, "primary: expected two different axes"),
        ({"separation": 3 * u.km, "secondary": "xq"}, "secondary: expected two different axes"),
    ):
        with pytest.raises(InputError, match=match):
            ba.analysis.relative_equilibrium(system, **arguments)
    balls = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for n in "AB"]
    with pytest.raises(InputError, match="attract like points"):
        ba.analysis.relative_equilibrium(ba.System(balls), separation=5 * u.km)
    with pytest.raises(InputError, match="two bodies"):
        ba.analysis.relative_equilibrium(ba.catalogue.load("sn263")[0], separation=5 * u.km)
