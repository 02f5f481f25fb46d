"""Passages found between rows, the period that eclipses show, and budgets."""

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError

PERIOD = 2 * np.pi * np.sqrt(20e3**3 / (5e14 * ba.constants.G))


def kepler(rows: int) -> ba.Trajectory:
    bodies = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=m * u.kg) for n, m in (("A", 4e14), ("B", 1e14))]
    system = ba.System(bodies, gravity=ba.PointMass())
    start = ba.State.from_elements(
        system, semi_major_axis=20 * u.km, eccentricity=0.1, inclination=50 * u.deg, true_anomaly=40 * u.deg,
        spins=["synchronous", "synchronous"],
    )  # fmt: skip
    step = PERIOD / rows * u.s
    return ba.propagate(
        system, start, duration=20.3 * PERIOD * u.s, integrator=ba.KeplerSplitting(step), save_every=step
    )


def test_the_interpolant_has_order_eight(tumbling: tuple[ba.System, ba.State]) -> None:
    """Seven in rates. A tumbling pair, against rows of a run that saves them."""
    integrator = ba.Splitting(10 * u.s, scheme="ss10")
    fine = ba.propagate(*tumbling, duration=12 * u.h, integrator=integrator, save_every=100 * u.s)
    middle = slice(40, -40)
    errors = []
    for every in (4, 8):
        between = fine[::every].interpolated(fine.si.time[middle])
        pairs = zip(between[1:5], fine.si[1:5], strict=True)
        errors.append([np.abs(one - two[middle]).max() / np.abs(two).max() for one, two in pairs])
    orders = np.log2(np.array(errors[1]) / np.array(errors[0]))
    assert np.all(orders > [7.5, 6.5, 7.5, 6.5])
    assert np.all(orders < 8.5)


@pytest.mark.parametrize("rows", [16, 32])
def test_passages_of_keplers_orbit(rows: int) -> None:
    """Periapses come a period apart, with the eighth power of the time between rows as error."""
    run = kepler(rows)
    tolerance = 3e-6 if rows == 16 else 2e-8
    at = ba.analysis.crossings(run, "periapsis")
    assert len(at) == 20
    np.testing.assert_allclose(np.diff(at.si.time) / PERIOD, 1, atol=tolerance)
    np.testing.assert_allclose(at.separation.to_value("km"), 18, rtol=tolerance)
    far = ba.analysis.crossings(run, "apoapsis")
    np.testing.assert_allclose(far.separation.to_value("km"), 22, rtol=tolerance)
    found = ba.analysis.stroboscopic_period(run)
    assert found.period.to_value("s") == pytest.approx(PERIOD, rel=tolerance)
    assert found.spread / found.period < tolerance
    from_afar = ba.analysis.stroboscopic_period(run, pole=[1, 0, 0])
    assert from_afar.period.to_value("s") == pytest.approx(PERIOD, rel=tolerance)
    node = ba.analysis.crossings(run, lambda rows: rows.si.position[:, 1, 2])
    np.testing.assert_allclose(np.diff(node.si.time) / PERIOD, 1, atol=tolerance)


def test_a_section_of_a_synchronous_orbit_is_a_point() -> None:
    """Spheres that turn evenly show at the periapsis, each time, the equation of the centre of the start."""
    section = ba.analysis.poincare_section(kepler(32))
    assert np.ptp(section.angle.value) < 1e-3
    assert np.abs(section.radial_velocity.value).max() < 1e-9
    np.testing.assert_allclose(section.rate.value, section.rate.value[0], rtol=1e-6)


def test_passages_that_are_not() -> None:
    run = kepler(32)
    for arguments, match in (
        (("periapse",), "did you mean 'periapsis'"),
        ((lambda rows: 1.0,), "a finite number for each"),
        ((lambda rows: rows.si.time + 1,), "passes nowhere"),
    ):
        with pytest.raises(InputError, match=match):
            ba.analysis.crossings(run, *arguments)
    with pytest.raises(InputError, match="save more often"):
        ba.analysis.crossings(run[::8], "periapsis")
    with pytest.raises(InputError, match="at least two passages"):
        ba.analysis.stroboscopic_period(run[:50])
    pole = np.cross(run.si.position[0, 1], run.si.velocity[0, 1])
    with pytest.raises(InputError, match="along the orbit's pole"):
        ba.analysis.stroboscopic_period(run, pole=pole)


def test_no_passage_is_looked_for_across_an_impulse(tumbling: tuple[ba.System, ba.State]) -> None:
    kick = ba.Impulse(time=12 * u.h, body="B", delta_v=[0, 0, 20] * u.mm / u.s)
    run = ba.propagate(
        *tumbling, duration=4 * u.day, integrator=ba.LGVI(20 * u.s), save_every=10 * u.min, impulses=[kick]
    )
    whole = ba.analysis.crossings(run, "periapsis").si.time
    parts = np.concatenate([ba.analysis.crossings(leg, "periapsis").si.time for leg in run.legs])
    np.testing.assert_array_equal(whole, parts)
    with pytest.raises(InputError, match="impulses"):
        ba.analysis.stroboscopic_period(run)


def test_budgets_add_up(tumbling: tuple[ba.System, ba.State]) -> None:
    run = ba.propagate(*tumbling, duration=2 * u.day, integrator=ba.LGVI(20 * u.s))
    energies = ba.analysis.energy_budget(run)
    total = energies.translational.sum(axis=1) + energies.rotational.sum(axis=1) + energies.potential
    np.testing.assert_allclose(total.value, run.energy.value, rtol=1e-13)
    np.testing.assert_allclose(
        energies.orbit.value, (energies.total - energies.rotational.sum(axis=1)).value, rtol=1e-9
    )
    momenta = ba.analysis.angular_momentum_budget(run)
    size = np.linalg.norm(momenta.total[0].value)
    together = (momenta.orbital + momenta.spin).sum(axis=1)
    np.testing.assert_allclose(together.value, momenta.total.value, atol=1e-13 * size)
    along = (momenta.orbital - momenta.orbital[0]).sum(axis=1) @ momenta.total[0].value / size**2
    given = -momenta.exchange.value.sum(axis=1)
    np.testing.assert_allclose(along.value, given, atol=1e-14)
    assert np.abs(given).max() > 3e-5
    with pytest.raises(InputError, match="Trajectory"):
        ba.analysis.energy_budget("run")
