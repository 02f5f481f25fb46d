"""What is read off a run, and the pictures of it."""

from pathlib import Path

import astropy.units as u
import matplotlib.pyplot as plt
import numpy as np
import pytest

import binaryast as ba
from binaryast.errors import InputError, StorageError
from binaryast.plotting import KINDS


@pytest.fixture(scope="module")
def run(tumbling: tuple[ba.System, ba.State]) -> ba.Trajectory:
    return ba.propagate(*tumbling, duration=5 * u.day, integrator=ba.LGVI(20 * u.s), save_every=30 * u.min)


def kepler(eccentricity: float) -> tuple[ba.System, ba.State]:
    bodies = [ba.RigidBody(n, ba.Sphere(1 * u.km), mass=m * u.kg) for n, m in (("A", 4e14), ("B", 1e14))]
    system = ba.System(bodies, gravity=ba.PointMass())
    state = ba.State.from_elements(
        system,
        semi_major_axis=20 * u.km,
        eccentricity=eccentricity,
        inclination=50 * u.deg,
        spins=["synchronous", "synchronous"],
    )
    return system, state


@pytest.mark.parametrize("eccentricity", [0.0, 0.3])
def test_the_mutual_period_of_keplers_orbit(eccentricity: float) -> None:
    period = 2 * np.pi * np.sqrt(20e3**3 / (5e14 * ba.constants.G))
    turns = 40
    run = ba.propagate(
        *kepler(eccentricity), duration=turns * period * u.s, integrator=ba.LGVI(10 * u.s), save_every=period / 50 * u.s
    )
    assert ba.analysis.mutual_period(run).to_value("s") == pytest.approx(
        period, rel=1e-5 if eccentricity == 0 else 1e-3
    )
    assert ba.analysis.orbit_angle(run)[-1].value == pytest.approx(2 * np.pi * turns, rel=1e-5)


def test_libration_of_an_eccentric_orbit_is_the_equation_of_the_centre() -> None:
    """Spheres turn evenly; seen from the line of centres their x axis librates by 2 e sin M."""
    run = ba.propagate(*kepler(0.01), duration=3 * u.day, integrator=ba.LGVI(10 * u.s), save_every=10 * u.min)
    assert np.abs(ba.analysis.libration_angle(run).value).max() == pytest.approx(0.02, rel=0.02)


def test_what_cannot_be_read_off(run: ba.Trajectory) -> None:
    with pytest.raises(InputError, match="at least one"):
        ba.analysis.mutual_period(run[:5])
    with pytest.raises(InputError, match="at least 2"):
        ba.analysis.orbit_angle(run[:1])
    with pytest.raises(InputError, match="save more often"):
        ba.analysis.mutual_period(run[::9])
    system, state = ba.catalogue.load("didymos")  # rows a little more than a turn apart look slow
    long = ba.propagate(system, state, duration=500 * u.day, integrator=ba.LGVI(60 * u.s), save_every=12 * u.h)
    for read in (ba.analysis.mutual_period, ba.analysis.orbit_angle, ba.analysis.libration_angle):
        with pytest.raises(InputError, match="save more often"):
            read(long)


@pytest.mark.parametrize("kind", KINDS)
def test_each_picture_takes_axes_or_makes_them(run: ba.Trajectory, kind: str) -> None:
    made = KINDS[kind](run)
    assert made.has_data()
    _, ax = plt.subplots()
    assert KINDS[kind](run, ax) is ax
    assert ax.get_xlabel()
    assert ax.get_ylabel()
    plt.close("all")


def test_the_orbit_seen_from_the_primary(run: ba.Trajectory) -> None:
    ax = ba.plotting.orbit(run, frame="primary")
    assert "A" in ax.get_title()
    with pytest.raises(InputError, match="frame"):
        ba.plotting.orbit(run, frame="secondary")
    plt.close("all")


def test_the_overview_has_all_of_them(run: ba.Trajectory) -> None:
    figure = ba.plotting.overview(run)
    assert len(figure.axes) == 8
    plt.close("all")


@pytest.mark.parametrize("suffix", ["png", "pdf", "svg"])
def test_pictures_in_files(run: ba.Trajectory, tmp_path: Path, suffix: str) -> None:
    path = ba.plotting.save(run, tmp_path / f"run.{suffix}")
    assert path.stat().st_size > 10_000
    with pytest.raises(StorageError, match="exists"):
        ba.plotting.save(run, path)
    assert plt.get_fignums() == []


def test_pictures_that_cannot_be(run: ba.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="kind"):
        ba.plotting.save(run, tmp_path / "run.png", kind="portrait")
    with pytest.raises(InputError, match="ends in png, pdf, svg"):
        ba.plotting.save(run, tmp_path / "run.xyz")
    assert list(tmp_path.iterdir()) == []


def test_point_clouds_are_drawn_too(tmp_path: Path) -> None:
    cloud = ba.PointCloud(np.vstack([np.eye(3), -np.eye(3)]) * 100 * u.m)
    system = ba.System([ba.RigidBody(n, cloud, mass=1e11 * u.kg) for n in "AB"], gravity=ba.PointPairs())
    state = ba.State.circular_orbit(system, separation=1 * u.km, spins=["synchronous", "synchronous"])
    run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(60 * u.s))
    assert ba.plotting.save(run, tmp_path / "cloud.png").exists()


def test_a_fall_on_a_line_can_be_drawn(tmp_path: Path) -> None:
    bodies = [ba.RigidBody(n, ba.Sphere(100 * u.m), mass=1e10 * u.kg) for n in ("$A$", "B_$")]
    zero = np.zeros((2, 3))
    state = ba.State([[-200, 0, 0], [200, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, zero * u.rad / u.s)
    run = ba.propagate(ba.System(bodies), state, duration=1 * u.h, integrator=ba.LGVI(5 * u.s))
    assert ba.plotting.save(run, tmp_path / "fall.png").exists()


@pytest.mark.parametrize("rows", [slice(0, 1), slice(0, 2)])
def test_short_runs_can_be_drawn(run: ba.Trajectory, tmp_path: Path, rows: slice) -> None:
    assert ba.plotting.save(run[rows], tmp_path / "short.png").exists()
    assert run[rows].summary()


def test_something_else_than_a_run() -> None:
    for read in (ba.analysis.orbit_angle, ba.plotting.separation, ba.plotting.overview):
        with pytest.raises(InputError, match=r"expected a ba\.Trajectory"):
            read("run")
