"""Runs in the hands of other packages: pandas, xarray, astropy's dates and directions, SciPy's rotations, notebooks."""

import re
import xml.etree.ElementTree as ET

import astropy.units as u
import numpy as np
import pytest
from astropy.coordinates import SkyCoord
from astropy.time import Time
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast import exports

EPOCH = Time("2022-09-26T23:14:24", scale="utc")


@pytest.fixture(scope="module")
def run() -> ba.Trajectory:
    """Half a day of Didymos from a date, in axes of the ICRF."""
    system, _ = ba.catalogue.load("didymos")
    pole = SkyCoord(69.326861266 * u.deg, -72.724550396 * u.deg)
    spins = [2.26 * u.h, "synchronous"]
    state = ba.State.circular_orbit(system, period=11.921473 * u.h, pole=pole, spins=spins, epoch=EPOCH)
    return ba.propagate(system, state, duration=12 * u.h, integrator=ba.LGVI(40 * u.s), save_every=1 * u.h)


def test_a_pole_may_be_a_direction_in_the_sky(run: ba.Trajectory) -> None:
    _, state = ba.catalogue.load("didymos")
    assert run.frame == "ICRF"
    assert run.si.position[0] == pytest.approx(state.si.position, abs=1e-9)
    galactic = SkyCoord(69.326861266 * u.deg, -72.724550396 * u.deg).galactic
    again = ba.State.circular_orbit(
        run.system, period=11.921473 * u.h, pole=galactic, spins=[2.26 * u.h, "synchronous"]
    )
    assert again.si.position == pytest.approx(state.si.position, abs=1e-9)


def test_dates(run: ba.Trajectory) -> None:
    assert run.epochs.scale == "tdb"
    assert np.abs((run.epochs - EPOCH).to_value("s") - run.si.time).max() < 1e-9
    bare = ba.catalogue.load("didymos")[1]
    other = ba.propagate(run.system, bare, duration=1 * u.h, integrator=ba.LGVI(40 * u.s))
    with pytest.raises(ba.BinaryastError, match=r"epochs: the run has no epoch: give its first ba.State an epoch="):
        _ = other.epochs


def test_poles_are_directions_in_the_sky(run: ba.Trajectory) -> None:
    given = SkyCoord(69.326861266 * u.deg, -72.724550396 * u.deg)
    assert run.orbit_pole().separation(given).max() < 1e-4 * u.arcsec
    assert run.pole("Didymos").separation(given).max() < 1e-4 * u.arcsec
    assert len(run.pole(1)) == len(run)
    system, state = ba.catalogue.load("moshup")
    local = ba.propagate(system, state, duration=1 * u.h, integrator=ba.LGVI(60 * u.s))
    with pytest.raises(ba.BinaryastError, match=r"the axes of this run are 'local', .* give .* frame='ICRF'"):
        local.pole(0)


def test_what_does_not_turn_has_no_pole() -> None:
    bodies = [ba.RigidBody(name, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for name in ("one", "two")]
    state = ba.State(
        [[0, 0, 0], [5, 0, 0]] * u.km, np.zeros((2, 3)) * u.m / u.s, [np.eye(3)] * 2, np.zeros((2, 3)) * u.rad / u.s,
        frame="ICRF",
    )  # fmt: skip
    run = ba.propagate(ba.System(bodies), state, duration=100 * u.s, integrator=ba.LGVI(10 * u.s))
    with pytest.raises(ba.BinaryastError, match="pole: one does not turn at some row"):
        run.pole("one")
    with pytest.raises(ba.BinaryastError, match="orbit_pole: the bodies move on a line"):
        run.orbit_pole()


def test_rotations_go_in_and_out(run: ba.Trajectory) -> None:
    assert isinstance(run.rotation("Dimorphos"), Rotation)
    assert run.rotation("Dimorphos").as_matrix() == pytest.approx(run.si.attitude[:, 1], abs=1e-15)
    state = run[3]
    again = ba.State(state.position, state.velocity, state.rotation, state.spin)
    assert again.si.attitude == pytest.approx(state.si.attitude, abs=1e-15)


def test_pandas(run: ba.Trajectory) -> None:
    pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert frame.index.name == "time"
    assert frame.index.to_numpy().tolist() == run.si.time.tolist()
    assert frame["Dimorphos.y"].to_numpy().tolist() == run.si.position[:, 1, 1].tolist()
    assert frame.attrs["units"]["energy"] == "J"
    assert frame.attrs["units"]["Didymos.qw"] == ""
    assert frame.attrs["epoch"] == f"{run.epoch.isot} TDB"


def test_xarray(run: ba.Trajectory) -> None:
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data.position.attrs["units"] == "m"
    assert data.attitude.dims == ("time", "body", "axis", "body_axis")
    assert data.attitude.to_numpy() == pytest.approx(run.si.attitude, abs=0)
    assert data.spin.sel(body="Didymos", body_axis="z").to_numpy().tolist() == run.si.spin[:, 0, 2].tolist()
    assert str(data.tdb.to_numpy()[0])[:19] == "2022-09-26T23:15:33"
    assert data.attrs["frame"] == "ICRF"


def test_what_is_not_installed_is_one_clear_line(run: ba.Trajectory, monkeypatch: pytest.MonkeyPatch) -> None:
    def missing(name: str) -> None:
        raise ImportError(name)

    monkeypatch.setattr(exports, "import_module", missing)
    for method in ("to_pandas", "to_xarray"):
        package = method.removeprefix("to_")
        with pytest.raises(ba.errors.MissingPackageError, match=rf"{method}: {package} is not installed: pip install"):
            getattr(run, method)()


def test_notebooks_show_what_matters(run: ba.Trajectory) -> None:
    for thing, words in (
        (run, ["Didymos, Dimorphos", "completed", "12 h, 13 rows", "error of energy", "2022-09-26", "<polyline"]),
        (run.system, ["System of 2 bodies", "Ellipsoid(a=425.5 m", "Multipole(degree=4)"]),
        (run.system.bodies[1], ["Dimorphos", "density", "kg m²"]),
        (run[0], ["State in axes ICRF", "2.26 h", "11.92"]),
        (run[:1], ["1 rows"]),
    ):
        shown = thing._repr_html_()
        for word in words:
            assert word in shown, word
        ET.fromstring(shown)  # well-formed
        assert "Quantity" not in shown


def test_names_are_escaped() -> None:
    bodies = [ba.RigidBody(name, ba.Sphere(1 * u.km), mass=1e12 * u.kg) for name in ("<script>1</script>", "a & b")]
    system = ba.System(bodies)
    state = ba.State.circular_orbit(system, separation=5 * u.km, spins=[5 * u.h, 5 * u.h])
    run = ba.propagate(system, state, duration=100 * u.s, integrator=ba.LGVI(10 * u.s))
    for thing in (run, system, bodies[0], bodies[1]):
        shown = thing._repr_html_()
        assert "<script>" not in shown
        assert not re.search(r"&(?!amp;|lt;|gt;|quot;|#)", shown)


def test_many_bodies_are_counted_not_listed() -> None:
    bodies = [ba.RigidBody(f"grain {i}", ba.Point(), mass=1 * u.kg) for i in range(20)]
    shown = ba.System(bodies, gravity=ba.PointMass())._repr_html_()
    assert "grain 11" in shown
    assert "grain 12" not in shown
    assert "and 8 more" in shown
