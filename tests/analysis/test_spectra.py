"""Refined frequency analysis: of sums of lines, and of the sphere and ellipsoid whose frequencies are known."""

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from validation.cases import libration

import binaryast as ba
from binaryast.errors import InputError

FREQUENCIES = np.array([1.00179277, 0.66660891, 2.00358554, 0.3351838])
AMPLITUDES = np.array([1.0, 0.5, 1e-2, 1e-3])
PHASES = np.array([0.3, 2.0, -1.0, 3.0])


@pytest.mark.parametrize("turns", [20, 100])
@pytest.mark.parametrize("kind", ["real", "complex"])
def test_lines_of_a_sum_are_found_to_round_off(kind: str, turns: int) -> None:
    t = np.linspace(5.0, 5.0 + 2 * np.pi * turns, 32 * turns)
    values = (AMPLITUDES * np.exp(1j * (np.outer(t - 5.0, FREQUENCIES) + PHASES))).sum(axis=1)
    found = ba.analysis.spectrum(t * u.s, (values.real + 0.2 if kind == "real" else values) * u.deg, lines=4)
    assert found.amplitude.unit == u.deg
    np.testing.assert_allclose(found.frequency.value, FREQUENCIES, rtol=1e-12)
    np.testing.assert_allclose(found.amplitude.value, AMPLITUDES, rtol=1e-11)
    np.testing.assert_allclose(found.phase.value, PHASES, rtol=0, atol=1e-10)
    assert found.rest.value < 1e-12


def test_noise_costs_what_it_must() -> None:
    """A line in noise of 1e-3 of it: the error of a frequency is of noise/(amplitude T sqrt(N)), not of 1/T."""
    t = np.linspace(0, 2 * np.pi * 100, 4000)
    noise = np.random.default_rng(3).normal(size=len(t)) * 1e-3
    found = ba.analysis.spectrum(t * u.s, np.cos(0.7 * t) + noise, lines=1)
    error = abs(found.frequency[0].value - 0.7)
    assert error < 10 * 1e-3 / (t[-1] * np.sqrt(len(t)))


def test_lines_are_named_by_the_smallest_combination() -> None:
    t = np.linspace(0, 600, 3000)
    values = np.cos(t) + 0.5 * np.cos(0.61 * t) + 0.1 * np.cos(0.39 * t) + 0.01 * np.cos(0.777 * t)
    found = ba.analysis.spectrum(t * u.s, values, lines=4)
    assert found.names({"n": 1 * u.rad / u.s, "w": 0.61 * u.rad / u.s}) == ("n", "w", "n - w", "")
    assert found.names({"n": 1 * u.rad / u.s}, largest=1) == ("n", "", "", "")
    np.testing.assert_allclose(found.period.to_value("s")[0], 2 * np.pi, rtol=1e-12)


def test_what_has_no_spectrum() -> None:
    t = np.linspace(0, 600, 3000) * u.s
    for time, values, lines, match in (
        (t.value, t.value, 2, "with a unit"),
        (t, t.value[1:], 2, "shape"),
        (t**2 / u.s, t.value, 2, "equally spaced"),
        (t[:9], t.value[:9], 2, "at least 16"),
        (t, t.value, 0, "how many"),
        (t, t.value * np.nan, 2, "finite"),
    ):
        with pytest.raises(InputError, match=match):
            ba.analysis.spectrum(time, values, lines=lines)
    assert len(ba.analysis.spectrum(t, np.ones(len(t))).frequency) == 0


@pytest.fixture(scope="module")
def librating() -> ba.Trajectory:
    """The sphere and the ellipsoid, with both small oscillations excited."""
    theory = libration.closed_form(libration.SEPARATION)
    n, r = theory.rate, theory.separation
    start = ba.RelativeState(
        X=[r, 0, 0] * u.m,
        V=[1e-5 * n * r, n * r, 0] * u.m / u.s,
        R=Rotation.from_rotvec([0, 0, 1e-5]).as_matrix(),
        Omega=[0, 0, n] * u.rad / u.s,
        Omega2=[0, 0, 0] * u.rad / u.s,
    )
    period = 2 * np.pi / n * u.s
    system = libration.system()
    step = period / 32
    return ba.propagate(
        system,
        start.to_state(system),
        duration=60 * period,
        integrator=ba.Splitting(step * (1 + 1e-12), scheme="ss10"),
        save_every=step,
    )


def test_frequencies_of_the_sphere_and_the_ellipsoid(librating: ba.Trajectory) -> None:
    """1.00179277 n and 0.66660891 n, from the angle of the face alone."""
    n = libration.closed_form(libration.SEPARATION).rate
    found = ba.analysis.libration_spectrum(librating, lines=5)
    measured = np.sort(found.frequency.value[:2] / n)[::-1]
    np.testing.assert_allclose(measured, libration.KNOWN, rtol=8e-9)
    proper = ba.analysis.proper_frequencies(librating)
    assert proper["orbit"].value / n == pytest.approx(1, rel=1e-6)
    assert proper["distance"].value / n == pytest.approx(libration.KNOWN[0], rel=1e-6)
    assert proper["libration"].value / n == pytest.approx(libration.KNOWN[1], rel=1e-6)
    assert set(found.names(proper)[:2]) == {"distance", "libration"}
    assert ba.analysis.orbit_spectrum(librating).names(proper)[0] == "orbit"


def test_a_run_with_impulses_has_no_spectrum(tumbling: tuple[ba.System, ba.State]) -> None:
    kick = ba.Impulse(time=6 * u.h, body="B", delta_v=[0, 0, 1] * u.mm / u.s)
    run = ba.propagate(*tumbling, duration=1 * u.day, integrator=ba.LGVI(20 * u.s), impulses=[kick])
    with pytest.raises(InputError, match="impulses"):
        ba.analysis.libration_spectrum(run)
    assert len(ba.analysis.separation_spectrum(run.legs[1], lines=2).frequency) == 2
