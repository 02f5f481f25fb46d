"""Against reference runs of GUBAS, the field's standard code, where they lie beside the project."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest

import binaryast as ba

FOLDER = Path(__file__).parents[2] / "shared" / "gubas"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the reference runs of GUBAS are not here")
KM, MEGAJOULE = 1000.0, 1e6


def rows(name: str) -> dict[str, np.ndarray]:
    """Return GUBAS's columns in SI: t, X, V, Omega2, Omega, Q (A -> N), C (B -> A), U, E, H."""
    table = np.loadtxt(FOLDER / name, delimiter=",", skiprows=1)
    return {
        "t": table[:, 0],
        "X": table[:, 1:4] * KM,
        "V": table[:, 4:7] * KM,
        "Omega2": table[:, 7:10],
        "Omega": table[:, 10:13],
        "Q": table[:, 13:22].reshape(-1, 3, 3),
        "C": table[:, 22:31].reshape(-1, 3, 3),
        "U": table[:, 31] * MEGAJOULE,
        "E": table[:, 32] * MEGAJOULE,
        "H": table[:, 33:36] * MEGAJOULE,
    }


def start(reference: dict[str, np.ndarray]) -> tuple[ba.System, ba.State]:
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(a * u.m, b * u.m, c * u.m), density=2400 * u.kg / u.m**3)
        for name, (a, b, c) in {"A": (420, 400, 330), "B": (100, 80, 60)}.items()
    ]
    system = ba.System(bodies, gravity=ba.SecondDegree())
    from scipy.spatial.transform import Rotation

    clean = {key: Rotation.from_matrix(reference[key][0]).as_matrix() for key in "QC"}
    relative = ba.RelativeState(
        X=reference["X"][0] * u.m,
        V=reference["V"][0] * u.m / u.s,
        R=clean["C"],
        Omega=reference["Omega"][0] * u.rad / u.s,
        Omega2=reference["Omega2"][0] * u.rad / u.s,
        R2=clean["Q"],
    )
    return system, relative.to_state(system)


def test_energy_force_and_moment_at_the_start() -> None:
    system, state = start(rows("ellipsoids_excited_N2_lgvi_h10_2d.csv"))
    relative = state.relative()
    gravity = system.mutual_gravity(relative.X, relative.R)
    assert gravity.energy.value == pytest.approx(-162.7105142220118 * MEGAJOULE, rel=1e-14)
    force = np.array([147.00974423592021, 20.156826766543912, -6.9957460271174607]) * MEGAJOULE / KM
    np.testing.assert_allclose(gravity.gradient.value, force, rtol=1e-13)
    moment = np.array([0.017168494556464312, -0.10893762085003092, 0.050894017692121818]) * MEGAJOULE
    np.testing.assert_allclose(gravity.moment.value, moment, rtol=1e-11)


def test_the_same_map_gives_the_same_rows() -> None:
    """GUBAS's variational integrator at 10 s, to 36 000 s; later the tumbling secondary magnifies round-off."""
    reference = rows("ellipsoids_excited_N2_lgvi_h10_2d.csv")
    run = ba.propagate(*start(reference), duration=36000 * u.s, integrator=ba.LGVI(10 * u.s), save_every=600 * u.s)
    relative, count = run.relative, len(run)
    np.testing.assert_allclose(reference["t"][:count], run.si.time)
    errors = np.linalg.norm(relative.X.value - reference["X"][:count], axis=1)
    assert errors.max() < 1e-9 * 1100
    assert np.abs(relative.R - reference["C"][:count]).max() < 1e-9
    assert np.abs(relative.R2 - reference["Q"][:count]).max() < 1e-9
    np.testing.assert_allclose(run.angular_momentum.value, reference["H"][:count], rtol=1e-9, atol=1e4)


def test_the_adaptive_run_is_converged_to() -> None:
    reference = rows("ellipsoids_excited_N2_rk78_tol1e-13_2d.csv")
    at = np.argmin(np.abs(reference["t"] - 36000))
    time = reference["t"][at]
    system, state = start(reference)
    ends = [
        ba.propagate(system, state, duration=time * u.s, integrator=ba.LGVI(h * u.s)).relative.X[-1].value
        for h in (4, 2)
    ]
    errors = [np.linalg.norm(end - reference["X"][at]) for end in ends]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.05)
    assert np.linalg.norm((4 * ends[1] - ends[0]) / 3 - reference["X"][at]) < 1e-3
