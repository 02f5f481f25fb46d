"""Runs that survive: what is on disk while they are under way, and how they go on after whatever stopped them."""

import itertools
import os
import signal
import subprocess
import sys
import warnings
from pathlib import Path
from random import Random

import astropy.units as u
import h5py
import numpy as np
import pytest
from validation import killing

import binaryast as ba
from binaryast import cli, propagation, reporting, run_file, storage, streaming
from binaryast.errors import AccuracyError, InputError, ResumeWarning, StorageError
from binaryast.gravity import PairPotential

DIDYMOS = ba.catalogue.load("didymos")
KICKS = [
    ba.Impulse(0 * u.h, [0, 0, 1] * u.mm / u.s, 1),
    ba.Impulse(7.3 * u.h, [0, 0, -2] * u.mm / u.s, "Dimorphos"),
    ba.Impact(30 * u.h, 579 * u.kg, [0, 0, -6] * u.km / u.s, 1, 2.5, [0, 20, 50] * u.m),
]
METHODS = {
    "LGVI": {"integrator": ba.LGVI(120 * u.s)},
    "LGVI, inertial, order 8": {"integrator": ba.LGVI(200 * u.s, order=8, frame="inertial")},
    "Splitting": {"integrator": ba.Splitting(400 * u.s)},
    "KeplerSplitting, with a corrector": {"integrator": ba.KeplerSplitting(300 * u.s, "aba104")},
    "RungeKutta": {"integrator": ba.RungeKutta(rtol=1e-10)},
    "RungeKutta of fixed steps": {"integrator": ba.RungeKutta(step=5 * u.min)},
    "Taylor": {"integrator": ba.Taylor()},
    "an accuracy": {"accuracy": 1e-7},
}


class Stopped(BaseException):
    """What stops a run in these tests, as nothing in the package catches it."""


@pytest.fixture
def stopping(monkeypatch: pytest.MonkeyPatch):
    """A function that has marks made at every look and the run stopped after so many of them; never below zero."""
    monkeypatch.setattr("binaryast.stepping.GROWTH", 1)
    mark = streaming.Stream._mark

    def after(marks: int) -> None:
        monkeypatch.setattr(streaming, "OFTEN", 10.0 if marks < 0 else -1.0)
        monkeypatch.setattr(streaming, "PART", -1.0)
        left = itertools.count(marks, -1)

        def stop(self, run) -> None:
            if next(left) == 0:
                raise Stopped
            mark(self, run)

        monkeypatch.setattr(streaming.Stream, "_mark", stop)

    return after


def same(one: ba.Trajectory, other: ba.Trajectory) -> None:
    """Raise where two runs differ in any bit of a row, or in a figure."""
    for name, array in one.si._asdict().items():
        assert array.tobytes() == getattr(other.si, name).tobytes(), name
    figures, others = one.attributes(), other.attributes()
    del figures["wall_time"], others["wall_time"]
    assert figures == others
    assert one.occurrences is not None
    assert other.occurrences is not None
    for name, array in one.occurrences._asdict().items():
        assert array.tobytes() == getattr(other.occurrences, name).tobytes(), name
    assert repr(one.watched) == repr(other.watched)


@pytest.mark.parametrize("marks", [0, 3])
@pytest.mark.parametrize("name", METHODS)
def test_a_run_goes_on_bit_for_bit(name: str, marks: int, stopping, tmp_path: Path) -> None:
    """With impulses, one at the start; stopped twice, and the last part of the file torn off."""
    arguments = {"duration": 2.1 * u.day, "save_every": 5 * u.h, "impulses": KICKS, **METHODS[name]}
    expected = ba.propagate(*DIDYMOS, **arguments)
    path = tmp_path / "run.h5"
    for go in (lambda: ba.propagate(*DIDYMOS, **arguments, file=path), lambda: ba.resume(path)):
        stopping(marks)
        with pytest.raises(Stopped):
            go()
    so_far = ba.Trajectory.read(path)
    assert so_far.status == "interrupted"
    rows = len(so_far)
    np.testing.assert_array_equal(so_far.si.position, expected.si.position[:rows])
    os.truncate(path, path.stat().st_size - 7)
    stopping(-1)
    run = ba.resume(path)
    same(run, expected)
    same(ba.Trajectory.read(path), expected)
    assert [file.name for file in tmp_path.iterdir()] == ["run.h5"]
    one, other = tmp_path / "whole.h5", tmp_path / "streamed.h5"
    expected.write(one)
    ba.propagate(*DIDYMOS, **arguments, file=other)
    assert killing.differences(one, path) == killing.differences(one, other) == []


@ba.event
def halfway(p, t, position, velocity, attitude, spin):
    return attitude[1, 0, 0]


@ba.force
def wind(p, t, position, velocity, attitude, spin, force, torque):
    force[1, 1] += p[0]


SUN = ba.Sun(ba.Orbit(1.6442 * u.au, 0.38385, 3 * u.deg, 70 * u.deg, true_anomaly=10 * u.deg))
TIDE = ba.TidalTorque("Didymos", raised_by="Dimorphos", love_number=0.1, time_lag=100 * u.s)
LOOKED_FOR = [
    ba.events.Crossing("radial_velocity", bodies=("Didymos", "Dimorphos")),
    ba.events.PlaneCrossing([1, 0, 0]),
    ba.events.UserEvent(halfway),
    ba.events.Separation(1198.8 * u.m, direction=1, terminal=True),
]


@pytest.mark.parametrize("name", [name for name in METHODS if "impulse" not in name])
def test_what_happens_and_what_acts_from_outside_go_on(
    name: str, stopping, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Events, one of which ends the run within a step, and forces; with many rows, of which few are in memory."""
    system, state = DIDYMOS
    if not isinstance(METHODS[name].get("integrator"), (ba.RungeKutta, ba.Taylor)):
        system = ba.System(system.bodies, perturbations=[SUN, TIDE, ba.Force(wind, [1.0])])
    arguments = {"duration": 1.2 * u.day, "save_every": 5 * u.min, "events": LOOKED_FOR, "impulses": KICKS[:2]}
    arguments |= METHODS[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        expected = ba.propagate(system, state, **arguments)
        assert expected.status == "event"
        assert len(expected.events) > 5
        path = tmp_path / "run.h5"
        monkeypatch.setattr("binaryast.stepping.ROWS_AT_ONCE", 8)
        monkeypatch.setattr(streaming, "ROWS_AT_ONCE", 8)
        monkeypatch.setattr(run_file, "ROWS_AT_ONCE", 8)
        for go in (lambda: ba.propagate(system, state, **arguments, file=path), lambda: ba.resume(path)):
            stopping(7)
            with pytest.raises(Stopped):
                go()
        so_far = ba.Trajectory.read(path)
        assert so_far.occurrences is not None
        assert expected.occurrences is not None
        count = len(so_far.events)
        assert so_far.occurrences.time.tobytes() == expected.occurrences.time[:count].tobytes()
        stopping(-1)
        same(ba.resume(path), expected)
        same(ba.Trajectory.read(path), expected)
        expected.write(tmp_path / "whole.h5")
    assert killing.differences(tmp_path / "whole.h5", path) == []


def test_several_bodies_go_on_bit_for_bit(stopping, tmp_path: Path) -> None:
    system, state = ba.catalogue.load("sn263")
    arguments = {"duration": 20 * u.day, "accuracy": 1e-5}
    stopping(5)
    with pytest.raises(Stopped):
        ba.propagate(system, state, **arguments, file=tmp_path / "run.h5")
    stopping(-1)
    same(ba.resume(tmp_path / "run.h5"), ba.propagate(system, state, **arguments))


@pytest.mark.parametrize("name", ba.catalogue.names())
def test_a_file_brings_back_every_bit_of_a_system(name: str) -> None:
    system, state = ba.catalogue.load(name)
    again = storage.unpack(storage.pack({"system": system, "state": state}))
    assert [pair.parameters.tobytes() for pair in again["system"].pairs] == [
        p.parameters.tobytes() for p in system.pairs
    ]
    for one, other in zip(again["system"].bodies, system.bodies, strict=True):
        assert (one.si.mass, one.si.gm) == (other.si.mass, other.si.gm)
        assert one.si.moments.tobytes() == other.si.moments.tobytes()
    assert [a.tobytes() for a in again["state"].si] == [a.tobytes() for a in state.si]


def test_it_survives_being_killed(tmp_path: Path) -> None:
    """Three times at random moments; python -m validation --long has twenty."""
    kick = "ba.Impulse(350.1 * u.day, [0, 0, -2] * u.mm / u.s, 1)"
    how = f"duration=1000 * u.day, save_every=1 * u.day, integrator=ba.LGVI(40 * u.s), impulses=[{kick}]"
    expected = tmp_path / "whole.h5"
    lasts = killing.whole(expected, "didymos", how)
    random, path, kills = Random(10), tmp_path / "killed.h5", 0
    while kills < 3:
        if not killing.killed(path, "didymos", how, random.uniform(0.05, 0.9) * lasts):
            continue  # it was over already: processes do not take the same time twice
        kills += 1
        assert ba.Trajectory.read(path).status == "interrupted"
        ba.resume(path)
        assert killing.differences(expected, path) == []
        path.unlink()


def test_a_file_is_there_from_the_first_step_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Any reader of HDF5 opens it, and ours sees the rows so far."""
    path, seen = tmp_path / "run.h5", []
    advance = propagation.SteppedRun._advance

    def look(self, *arguments):
        with h5py.File(path) as file:
            seen.append((file.attrs["status"], len(file["time"]), len(ba.Trajectory.read(path))))
        return advance(self, *arguments)

    monkeypatch.setattr(propagation.SteppedRun, "_advance", look)
    monkeypatch.setattr(streaming, "OFTEN", -1.0)
    monkeypatch.setattr(streaming, "PART", -1.0)
    run = ba.propagate(*DIDYMOS, duration=1 * u.day, save_every=1 * u.h, integrator=ba.LGVI(40 * u.s), file=path)
    assert seen[0] == ("interrupted", 1, 1)
    assert seen[-1][1] == 1 < seen[-1][2] < len(run) == 25


def test_rows_leave_memory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Many rows go to the file in pieces, and stay there where they are large."""
    monkeypatch.setattr(run_file, "ROWS_AT_ONCE", 64)
    monkeypatch.setattr("binaryast.stepping.ROWS_AT_ONCE", 64)
    monkeypatch.setattr(streaming, "ROWS_AT_ONCE", 64)
    monkeypatch.setattr(storage, "IN_MEMORY", 1 << 12)
    arguments = {"duration": 1 * u.day, "save_every": 40 * u.s, "integrator": ba.LGVI(40 * u.s)}
    run = ba.propagate(*DIDYMOS, **arguments, file=tmp_path / "run.h5")
    assert isinstance(run.si.position.base, np.memmap) or isinstance(run.si.position, np.memmap)
    same(run, ba.propagate(*DIDYMOS, **arguments))


def one_line(error: StorageError) -> None:
    assert "\n" not in str(error)


def stopped_run(path: Path, stopping, marks: int = 6) -> dict:
    arguments = {"duration": 2 * u.day, "save_every": 1 * u.h, "integrator": ba.LGVI(40 * u.s)}
    stopping(marks)
    with pytest.raises(Stopped):
        ba.propagate(*DIDYMOS, **arguments, file=path)
    stopping(-1)
    return arguments


def test_garbled_and_torn_files(stopping, tmp_path: Path) -> None:
    """Wherever a byte is changed or the file is cut off: one line, or what came before."""
    path = tmp_path / "run.h5"
    arguments = stopped_run(path, stopping)
    data, expected = path.read_bytes(), ba.propagate(*DIDYMOS, **arguments)
    header = storage.end_of_header(path)
    assert header is not None
    random = Random(3)
    for at in [random.randrange(len(data)) for _ in range(12)] + [header, header + 9, len(data) - 1]:
        path.write_bytes(data[:at] + bytes([data[at] ^ 0x41]) + data[at + 1 :])
        try:
            rows = ba.Trajectory.read(path)
        except StorageError as error:
            one_line(error)
        else:
            np.testing.assert_array_equal(rows.si.position, expected.si.position[: len(rows)])
        if at < storage.SEAL_SIZE and data[at] == 0:
            continue  # unused bytes
        if at < header:
            with pytest.raises(StorageError, match=r"run\.h5"):
                ba.resume(path)
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ResumeWarning)
            same(ba.resume(path), expected)
    for size in [random.randrange(header, len(data)) for _ in range(4)] + [header]:
        path.write_bytes(data[:size])
        rows = ba.Trajectory.read(path)
        np.testing.assert_array_equal(rows.si.position, expected.si.position[: len(rows)])
        same(ba.resume(path), expected)
    path.write_bytes(data[: header // 2])
    with pytest.raises(StorageError, match="damaged"):
        ba.resume(path)


def test_damage_in_the_middle_is_said(stopping, tmp_path: Path) -> None:
    path = tmp_path / "run.h5"
    arguments = stopped_run(path, stopping)
    with run_file.opened(path) as file:
        place = file.stretches[0].pieces[-1][0]
    data = bytearray(path.read_bytes())
    data[place + 100] ^= 1
    path.write_bytes(data)
    with pytest.raises(StorageError, match=r"rows before are sound: read them with verify=False, or have the rest"):
        ba.Trajectory.read(path)
    assert 0 < len(ba.Trajectory.read(path, verify=False)) < 49
    with pytest.warns(ResumeWarning, match="what follows is computed again"):
        same(ba.resume(path), ba.propagate(*DIDYMOS, **arguments))


def test_what_cannot_go_on(stopping, tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    over = ba.propagate(*DIDYMOS, duration=1 * u.h, integrator=ba.LGVI(40 * u.s)).write(tmp_path / "over.h5")
    with pytest.raises(StorageError, match=r"the run is over \(completed\): to follow the motion further"):
        ba.resume(over)
    assert cli.main(["resume", str(over)]) == cli.WRONG_INPUT
    assert capsys.readouterr().err.count("\n") == 1
    with pytest.raises(StorageError, match="no such file"):
        ba.resume(tmp_path / "none.h5")
    (tmp_path / "text.h5").write_text("text")
    with pytest.raises(StorageError, match="not a file that binaryast wrote"):
        ba.resume(tmp_path / "text.h5")
    path = tmp_path / "run.h5"
    stopped_run(path, stopping)
    with run_file.opened(path):
        command = [sys.executable, "-m", "binaryast", "resume", path]
        second = subprocess.run(command, capture_output=True, text=True, check=False)
    assert "another process is writing it" in second.stderr
    assert second.returncode == cli.WRONG_INPUT
    with pytest.raises(InputError, match="system: expected that of"):
        ba.resume(path, system=ba.catalogue.load("moshup")[0])
    path.write_bytes(path.read_bytes().replace(b"binaryast run 1 ", b"binaryast run 2 ", 1))
    with pytest.raises(StorageError, match="a run file of version 2, expected 1 to 1: a newer binaryast wrote it"):
        ba.resume(path)


def test_another_version_is_said(stopping, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.h5"
    arguments = stopped_run(path, stopping)
    now = reporting.provenance()
    monkeypatch.setattr("binaryast.resuming.provenance", lambda: now | {"numpy": "99.0"})
    with pytest.warns(ResumeWarning, match=r"was begun with numpy .*, this is 99\.0: it is the same to round-off"):
        same(ba.resume(path), ba.propagate(*DIDYMOS, **arguments))


def test_a_function_of_ones_own_is_given_again(stopping, tmp_path: Path) -> None:
    @ba.pair_potential
    def kepler(p, x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33):
        d = (x * x + y * y + z * z) ** 0.5
        return -p[0] / d, p[0] * x / d**3, p[0] * y / d**3, p[0] * z / d**3, 0.0, 0.0, 0.0

    kepler.__module__ = "__main__"
    kepler.py_func.__module__ = "__main__"
    gravity = PairPotential(kepler, [ba.constants.G * 5.18e11 * 4.47e9])
    system = ba.System(DIDYMOS[0].bodies, gravity)
    arguments = {"duration": 1 * u.day, "integrator": ba.LGVI(40 * u.s)}
    path = tmp_path / "run.h5"
    stopping(3)
    with pytest.raises(Stopped):
        ba.propagate(system, DIDYMOS[1], **arguments, file=path)
    stopping(-1)
    with pytest.raises(InputError, match=r"is a function that the file could not keep: give the system again"):
        ba.resume(path)
    same(ba.resume(path, system=system), ba.propagate(system, DIDYMOS[1], **arguments))


def test_marks_that_this_version_does_not_know(stopping, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.h5"
    stopped_run(path, stopping)
    monkeypatch.setattr("binaryast.stepping.CHECKPOINT", ("something else",))
    with pytest.raises(StorageError, match=r"this version does not know the marks of binaryast .*: install that one"):
        ba.resume(path)


def test_a_file_that_may_not_be_changed(stopping, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.h5"
    stopped_run(path, stopping)
    data = path.read_bytes()
    with pytest.raises(StorageError, match="it is a run that was stopped: go on with binaryast resume"):
        ba.propagate(*DIDYMOS, duration=1 * u.day, accuracy=1e-8, file=path)

    def refuse(*_, **__) -> None:
        raise PermissionError(13, "Permission denied")

    with monkeypatch.context() as patch:
        patch.setattr("binaryast.storage.tempfile.TemporaryFile", refuse)
        with pytest.raises(StorageError, match=r"nothing can be written in .*denied"):
            ba.resume(path)
    with monkeypatch.context() as patch:
        patch.setattr("binaryast.run_file.RunFile", refuse)
        with pytest.raises(StorageError, match=r"cannot be opened to go on with: .*denied"):
            ba.resume(path)
    assert path.read_bytes() == data


def test_ctrl_c_and_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture) -> None:
    """The state at which it stops is a row of what is read, but not of what follows."""
    monkeypatch.chdir(tmp_path)
    advance, calls = propagation.SteppedRun._advance, itertools.count()

    def press(self, *arguments):
        if next(calls) == 2:
            os.kill(os.getpid(), signal.SIGINT)
        return advance(self, *arguments)

    arguments = {"duration": 2 * u.day, "save_every": 7 * u.h, "integrator": ba.LGVI(40 * u.s)}
    with monkeypatch.context() as patch:
        patch.setattr(propagation.SteppedRun, "_advance", press)
        run = ba.propagate(*DIDYMOS, **arguments, file="run.h5")
    assert run.status == "interrupted"
    assert "binaryast resume goes on with it" in run.message
    assert 0 < run.si.time[-1] < 2 * 86400
    assert run.si.time[-1] % (7 * 3600)
    assert cli.main(["resume", "run.h5", "--no-picture", "--json"]) == 0
    assert '"status": "completed"' in capsys.readouterr().out
    same(ba.Trajectory.read("run.h5"), ba.propagate(*DIDYMOS, **arguments))


def test_what_is_replaced_comes_back_where_the_run_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.h5"
    path.write_text("precious")
    with pytest.raises(StorageError, match="exists already"):
        ba.propagate(*DIDYMOS, duration=1 * u.day, accuracy=1e-8, file=path)
    with pytest.raises(AccuracyError):
        ba.propagate(*DIDYMOS, duration=30 * u.day, accuracy=1e-14, file=path, force=True)
    assert path.read_text() == "precious"

    def interrupted(*_) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(propagation.choosing, "plan", interrupted)
    with pytest.raises(KeyboardInterrupt):
        ba.propagate(*DIDYMOS, duration=30 * u.day, accuracy=1e-8, file=path, force=True)
    assert path.read_text() == "precious"
    assert [file.name for file in tmp_path.iterdir()] == ["run.h5"]


NO_ROOM = """
import resource, signal, sys
import astropy.units as u
import binaryast as ba
system, state = ba.catalogue.load("didymos")
resource.setrlimit(resource.RLIMIT_FSIZE, (int(sys.argv[2]), resource.RLIM_INFINITY))
try:
    how = {"duration": 20 * u.day, "save_every": 1 * u.h, "integrator": ba.LGVI(40 * u.s)}
    ba.propagate(system, state, **how, file=sys.argv[1], force=True)
except ba.errors.StorageError as error:
    print(error)
"""


@pytest.mark.skipif(sys.platform == "win32", reason="the system has no limit on the size of files")
@pytest.mark.parametrize("limit", [40_000, 150_000, 210_000])
def test_no_room(limit: int, tmp_path: Path) -> None:
    """For the first rows, for more of them, or for the final file: all goes on when there is room."""
    path = tmp_path / "run.h5"
    path.write_text("precious")
    command = [sys.executable, "-c", NO_ROOM, str(path), str(limit)]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert "make room, and" in result.stdout
    assert result.stdout.strip().count("\n") == 0
    assert (tmp_path / "run.h5.before").read_text() == "precious"
    assert len(ba.Trajectory.read(path)) >= 1
    run = ba.resume(path)
    same(run, ba.propagate(*DIDYMOS, duration=20 * u.day, save_every=1 * u.h, integrator=ba.LGVI(40 * u.s)))
    assert [file.name for file in tmp_path.iterdir()] == ["run.h5"]


def test_a_file_of_the_first_version_is_read() -> None:
    """As it was written before there were run files."""
    run = ba.Trajectory.read(Path(__file__).parent / "data" / "format-1.h5")
    assert (run.status, len(run), len(run.legs), run.steps) == ("completed", 11, 3, 40)
    assert [type(one).__name__ for one in run.impulses] == ["Impulse", "Impact"]
    np.testing.assert_allclose(run.si.position[-1, 1], [1159.6406462250363, 183.51010136112578, -8.218179023572418])
    again = ba.propagate(
        run.system, run[0], duration=2 * u.day, accuracy=1e-6, save_every=6 * u.h, impulses=run.impulses
    )
    np.testing.assert_allclose(again.si.position, run.si.position, atol=1e-6)
