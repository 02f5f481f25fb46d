"""Trajectories: rows and slices, what is conserved, files, tables, checks."""

import pickle
import subprocess
import sys
from pathlib import Path

import astropy.units as u
import h5py
import numpy as np
import pytest
from astropy.table import QTable
from astropy.time import Time

import binaryast as ba
from binaryast.errors import CheckError, InputError, StorageError


@pytest.fixture(scope="module")
def run(tumbling: tuple[ba.System, ba.State]) -> ba.Trajectory:
    system, state = tumbling
    start = ba.State(**state.arguments() | {"epoch": Time("2026-01-01T12:00:00", scale="tdb"), "frame": "ICRF"})
    return ba.propagate(system, start, duration=2 * u.day, integrator=ba.LGVI(20 * u.s), save_every=1 * u.h)


def test_rows_and_slices(run: ba.Trajectory) -> None:
    assert len(run) == 49
    state = run[-1]
    assert isinstance(state, ba.State)
    assert (state.epoch - run.epoch).to_value("d") == pytest.approx(2)
    part = run[10:20:2]
    assert isinstance(part, ba.Trajectory)
    np.testing.assert_array_equal(part.position, run.position[10:20:2])
    with pytest.raises(IndexError, match="49 rows"):
        run[49]
    with pytest.raises(InputError, match="slice"):
        run["time"]
    with pytest.raises(InputError, match="slice"):
        run[::0]
    with pytest.raises(IndexError, match="no rows"):
        run[5:5]


def test_conserved_quantities_are_those_of_the_paper(run: ba.Trajectory) -> None:
    """E, gamma_T and pi_T of section 5.1, from the reduced variables as printed (with the errata)."""
    m1, m2 = run.system.secondary.si.mass, run.system.primary.si.mass
    j1, j2 = np.diag(run.system.secondary.si.moments), np.diag(run.system.primary.si.moments)
    r = run.relative
    X, V, R, R2 = r.X.value, r.V.value, r.R, r.R2
    Omega, Omega2, V2 = r.Omega.value, r.Omega2.value, r.V2.value
    JR = R @ j1 @ np.swapaxes(R, 1, 2)
    energy = 0.5 * m1 * np.sum((V + V2) ** 2, axis=1) + 0.5 * m2 * np.sum(V2**2, axis=1) + run.potential_energy.value
    energy += 0.5 * np.einsum("ni,nij,nj->n", Omega, JR, Omega) + 0.5 * np.einsum("ni,ij,nj->n", Omega2, j2, Omega2)
    np.testing.assert_allclose(run.energy.value, energy, rtol=1e-12)
    body = m1 * m2 / (m1 + m2) * np.cross(X, V) + np.einsum("nij,nj->ni", JR, Omega) + Omega2 @ j2
    total = np.einsum("nij,nj->ni", R2, body)
    np.testing.assert_allclose(run.angular_momentum.value, total, rtol=1e-12)
    linear = np.einsum("nij,nj->ni", R2, m1 * (V + V2) + m2 * V2)
    np.testing.assert_allclose(run.linear_momentum.value, linear, atol=1e-6)
    assert run.angular_momentum.unit.is_equivalent(u.J * u.s)


def test_figures_cover_every_step(run: ba.Trajectory) -> None:
    saved = np.abs(run.energy - run.energy[0]).max()
    assert run.max_energy_error >= saved * 0.999
    assert run.max_rotation_error >= 0
    assert run.closest_approach <= run.separation.min()
    assert run.max_relative_energy_error == pytest.approx((run.max_energy_error / abs(run.energy[0])).value)
    assert run.max_energy_error_over_potential == pytest.approx(
        (run.max_energy_error / abs(run.potential_energy[0])).value
    )


def test_check_names_the_figure(run: ba.Trajectory) -> None:
    assert run.check(energy=1e-5, momentum=1e-12, rotation=1e-14) is run
    with pytest.raises(CheckError, match=r"max_relative_energy_error is .*expected at most 1e-20"):
        run.check(energy=1e-20)


def test_file_and_back(run: ba.Trajectory, tmp_path: Path) -> None:
    path = run.write(tmp_path / "run.h5")
    again = ba.Trajectory.read(path)
    for one, two in zip(again.si, run.si, strict=True):
        np.testing.assert_array_equal(one, two)
    assert again.summary() == run.summary()
    assert again.epoch == run.epoch
    assert again.integrator.step == run.integrator.step
    assert again.system.primary.si.gm == run.system.primary.si.gm
    np.testing.assert_array_equal(again.system.parameters, run.system.parameters)
    assert again.provenance == run.provenance
    with h5py.File(path) as file:
        assert file.attrs["format_version"] == 1
        assert file["position"].attrs["unit"] == "m"
        assert file["position"].shape == (49, 2, 3)
        assert {"energy", "angular_momentum", "attitude", "spin", "rotation_error"} <= set(file)


@pytest.mark.parametrize("name", ["run.h5", "Ä ö ß.h5", "with space.hdf5"])
def test_names_of_files(run: ba.Trajectory, tmp_path: Path, name: str) -> None:
    assert len(ba.Trajectory.read(run.write(tmp_path / name))) == len(run)


@pytest.mark.parametrize("name", [None, 3, "a\0b", "x" * 400])
def test_names_that_no_file_has(run: ba.Trajectory, name: object) -> None:
    with pytest.raises(StorageError):
        run.write(name)


def test_a_file_of_before_gravity_had_degrees(run: ba.Trajectory, tmp_path: Path) -> None:
    path = run.write(tmp_path / "run.h5")
    assert ba.Trajectory.read(path).max_next_degree_term == run.max_next_degree_term
    with h5py.File(path, "r+") as file:
        del file.attrs["max_next_degree_term"]
    again = ba.Trajectory.read(path, verify=False)
    assert again.max_next_degree_term is None
    assert "next degrees of gravity: not known" in again.summary()


def test_a_run_goes_on_from_a_file(run: ba.Trajectory, tmp_path: Path) -> None:
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    more = ba.propagate(again.system, again[-1], duration=1 * u.h, integrator=again.integrator)
    assert more.epoch == run[-1].epoch


@pytest.mark.parametrize("name", ["dumbbells", "cloud", "user"])
def test_every_kind_of_system_is_kept(name: str, tmp_path: Path) -> None:
    system, state = ba.catalogue.load("dumbbells")
    if name == "cloud":
        cloud = ba.PointCloud(np.vstack([np.eye(3), -np.eye(3), [[2, 1, 0]]]) * u.cm, np.arange(1, 8))
        system = ba.System([system.primary, ba.RigidBody("cloud", cloud, gm=0.3 * u.m**3 / u.s**2)], ba.PointPairs())
    if name == "user":
        from tests.contracts.test_gravity import repelled

        system = ba.System(system.bodies, ba.PairPotential(repelled, [1.0, 0.0]))
    run = ba.propagate(system, state, duration=0.1 * u.s, integrator=ba.LGVI(0.01 * u.s))
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    np.testing.assert_array_equal(again.system.parameters, run.system.parameters)
    assert pickle.loads(pickle.dumps(again)).summary() == run.summary()


def test_a_users_potential_that_cannot_be_imported_leaves_the_data_readable(tmp_path: Path) -> None:
    system, state = ba.catalogue.load("dumbbells")

    @ba.pair_potential
    def local(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
        return -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0

    run = ba.propagate(
        ba.System(system.bodies, ba.PairPotential(local)), state, duration=0.1 * u.s, integrator=ba.LGVI(0.01 * u.s)
    )
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    np.testing.assert_array_equal(again.position, run.position)
    with pytest.raises(InputError, match="cannot be imported"):
        ba.propagate(again.system, again[-1], duration=0.1 * u.s, integrator=again.integrator)


def test_a_users_own_model_leaves_the_data_readable(tmp_path: Path) -> None:
    class Mine(ba.PointPairs):
        pass

    system, state = ba.catalogue.load("dumbbells")
    run = ba.propagate(ba.System(system.bodies, Mine()), state, duration=0.1 * u.s, integrator=ba.LGVI(0.01 * u.s))
    again = ba.Trajectory.read(run.write(tmp_path / "run.h5"))
    np.testing.assert_array_equal(again.position, run.position)
    with pytest.raises(InputError, match="Mine cannot be imported"):
        ba.propagate(again.system, again[-1], duration=0.1 * u.s, integrator=again.integrator)


def test_table(run: ba.Trajectory, tmp_path: Path) -> None:
    run.to_table().write(tmp_path / "run.ecsv")
    table = QTable.read(tmp_path / "run.ecsv")
    np.testing.assert_array_equal(table["B.x"], run.position[:, 1, 0])
    assert table["A.spin_z"].unit == u.rad / u.s
    assert table.meta["epoch"].endswith("TDB")


def test_an_existing_file_is_not_replaced_by_chance(run: ba.Trajectory, tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    path.write_text("precious")
    with pytest.raises(StorageError, match="exists already"):
        run.write(path)
    assert path.read_text() == "precious"
    run.write(path, force=True)
    assert len(ba.Trajectory.read(path)) == len(run)


def test_folders_that_are_not_there(run: ba.Trajectory, tmp_path: Path) -> None:
    with pytest.raises(StorageError, match="no folder"):
        run.write(tmp_path / "nowhere" / "run.h5")
    with pytest.raises(StorageError, match="is a folder"):
        run.write(tmp_path)


@pytest.mark.parametrize(
    "damage", ["missing", "empty", "text", "truncated", "foreign", "newer", "hollow", "garbled", "kilometres"]
)
def test_broken_files(run: ba.Trajectory, tmp_path: Path, damage: str) -> None:
    path = tmp_path / "run.h5"
    if damage != "missing":
        run.write(path)
        data = path.read_bytes()
    if damage == "empty":
        path.write_bytes(b"")
    if damage == "text":
        path.write_text("not HDF5 at all")
    if damage == "truncated":
        path.write_bytes(data[: len(data) // 2])
    if damage == "foreign":
        with h5py.File(path, "w") as file:
            file["x"] = 1
    if damage == "newer":
        with h5py.File(path, "r+") as file:
            file.attrs["format_version"] = 99
    if damage == "hollow":
        with h5py.File(path, "r+") as file:
            del file["spin"]
    if damage == "garbled":
        with h5py.File(path, "r+") as file:
            file["system"].attrs["class"] = "Sistem"
    if damage == "kilometres":
        with h5py.File(path, "r+") as file:
            file["position"].attrs["unit"] = "km"
    with pytest.raises(StorageError, match=r"run\.h5") as caught:
        ba.Trajectory.read(path)
    assert "\n" not in str(caught.value)
    if damage == "kilometres":  # a change that makes sense is read on request, units and all
        assert ba.Trajectory.read(path, verify=False).position[0, 1, 0] == 1000 * run.position[0, 1, 0]
    else:
        with pytest.raises(StorageError, match=r"run\.h5"):
            ba.Trajectory.read(path, verify=False)


@pytest.mark.parametrize("seed", range(5))
def test_flipped_bits_are_seen(run: ba.Trajectory, tmp_path: Path, seed: int) -> None:
    path = run.write(tmp_path / "run.h5")
    data = bytearray(path.read_bytes())
    data[np.random.default_rng(seed).integers(len(data))] ^= 0x10
    path.write_bytes(data)
    with pytest.raises(StorageError, match=r"run\.h5"):
        ba.Trajectory.read(path)


def test_a_file_is_plain_hdf5(run: ba.Trajectory, tmp_path: Path) -> None:
    with h5py.File(run.write(tmp_path / "run.h5")) as file:
        np.testing.assert_array_equal(file["spin"], run.si.spin)
        assert file.attrs["status"] == "completed"


WRITE_WITHOUT_ROOM = """
import resource, sys
import binaryast as ba
run = ba.Trajectory.read(sys.argv[1])
resource.setrlimit(resource.RLIMIT_FSIZE, (10_000, 10_000))
try:
    run.write(sys.argv[2], force=True)
except ba.errors.StorageError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="the system has no limit on the size of files")
def test_no_room(run: ba.Trajectory, tmp_path: Path) -> None:
    kept = run.write(tmp_path / "run.h5")
    before = kept.read_bytes()
    result = subprocess.run(
        [sys.executable, "-c", WRITE_WITHOUT_ROOM, str(kept), str(kept)], capture_output=True, text=True, check=True
    )
    assert "could not be written" in result.stdout
    assert kept.read_bytes() == before
    assert [path.name for path in tmp_path.iterdir()] == ["run.h5"]
