"""Against reference runs of GUBAS, the field's standard code, where they lie beside the project."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import Gravity, Multipole, SecondDegree
from binaryast.kernels.moments import exponents
from tests.conftest import attitude_angle

FOLDER = Path(__file__).parents[2] / "shared" / "gubas"
pytestmark = pytest.mark.skipif(not FOLDER.is_dir(), reason="the reference runs of GUBAS are not here")
KM, MEGAJOULE = 1000.0, 1e6
SECOND = SecondDegree()


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


def start(reference: dict[str, np.ndarray], gravity: Gravity = SECOND) -> tuple[ba.System, ba.State]:
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(a * u.m, b * u.m, c * u.m), density=2400 * u.kg / u.m**3)
        for name, (a, b, c) in {"A": (420, 400, 330), "B": (100, 80, 60)}.items()
    ]
    system = ba.System(bodies, gravity=gravity)
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


POINT_VALUES = {  # U [MJ], dU/dX [MJ/km], M [MJ]
    2: (
        -162.7105142220118,
        [147.00974423592021, 20.156826766543912, -6.9957460271174607],
        [0.017168494556464312, -0.10893762085003092, 0.050894017692121818],
    ),
    4: (
        -162.73326183193132,
        [147.1094317367178, 20.174431061339376, -7.0245691171366529],
        [0.019151129466029253, -0.11504999710931431, 0.05226528055045021],
    ),
}


@pytest.mark.parametrize("gravity", [SECOND, Multipole(2), Multipole(4)], ids=repr)
def test_energy_force_and_moment_at_the_start(gravity: Gravity) -> None:
    system, state = start(rows("ellipsoids_excited_N2_lgvi_h10_2d.csv"), gravity)
    relative = state.relative()
    found = system.mutual_gravity(relative.X, relative.R)
    energy, force, moment = POINT_VALUES[gravity.cut_at]
    assert found.energy.value == pytest.approx(energy * MEGAJOULE, rel=1e-14)
    np.testing.assert_allclose(found.gradient.value, np.array(force) * MEGAJOULE / KM, rtol=1e-13)
    np.testing.assert_allclose(found.moment.value, np.array(moment) * MEGAJOULE, rtol=1e-11)


@pytest.mark.parametrize("which", ["primary", "secondary"])
def test_inertia_integrals(which: str) -> None:
    """T_ijk of our ellipsoids, and a body made of GUBAS's."""
    table = np.loadtxt(FOLDER / f"inertia_integrals_ellipsoids_{which}_N4.csv", delimiter=",")
    body = getattr(start(rows("ellipsoids_excited_N2_lgvi_h10_2d.csv"))[0], which)
    i, j, k = exponents(4).T
    ours = body.si.mass * body.moments(4) / KM ** (i + j + k)
    np.testing.assert_allclose(ours, table[k * 5 + i, j], rtol=1e-13, atol=0)
    given = ba.RigidBody("given", ba.InertiaIntegrals(table, 1 * u.km), mass=table[0, 0] * u.kg)
    np.testing.assert_allclose(given.moments(4), body.moments(4), rtol=1e-13)
    np.testing.assert_allclose(given.si.moments, body.si.moments, rtol=1e-13)


def test_the_adaptive_run_at_degree_4() -> None:
    """Two days of tumbling: GUBAS's RK78 and SciPy's DOP853, both to some 1e-13 a step."""
    reference = rows("ellipsoids_excited_N4_rk78_tol1e-13_2d.csv")
    system, state = start(reference, Multipole(4))
    flow = ba.equations.continuous(system, frame="relative", form="hamiltonian")
    y, time = flow.from_state(state), reference["t"]
    tolerances = {"rtol": 1e-13, "atol": 1e-14 * flow.scales(y)}
    solution = solve_ivp(flow.rhs, (0, time[-1]), y, method="DOP853", t_eval=time[::20], **tolerances)
    states = [flow.to_state(column).relative() for column in solution.y.T]
    x = np.array([relative.X.value for relative in states])
    distances = np.linalg.norm(reference["X"][::20], axis=1)
    assert (np.linalg.norm(x - reference["X"][::20], axis=1) / distances).max() < 1e-8  # 1.7e-9
    assert attitude_angle(np.array([relative.R for relative in states]), reference["C"][::20]) < 1e-7  # 1.1e-8 rad
    assert attitude_angle(np.array([relative.R2 for relative in states]), reference["Q"][::20]) < 1e-9  # 3e-11 rad


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
