"""The command line as a user meets it: what it writes, what it refuses, Ctrl-C, completion."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import astropy.units as u
import pytest

import binaryast as ba
from binaryast import cli, integrators


def files(folder: Path) -> list[str]:
    """Return the names of what is in a folder."""
    return sorted(path.name for path in folder.iterdir())


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.chdir(tmp_path)
    return tmp_path


def command(*arguments: str, **options) -> subprocess.CompletedProcess:
    """Run the command in a process of its own."""
    return subprocess.run(
        [sys.executable, "-m", "binaryast", *arguments],
        capture_output=True,
        text=True,
        check=False,
        timeout=300,
        **options,
    )


def test_the_main_job(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["run", "didymos", "--duration", "5d"]) == 0
    out = capsys.readouterr().out
    assert "Didymos and Dimorphos: completed" in out
    assert "mutual period 11.92" in out
    assert files(folder) == ["didymos.h5", "didymos.png"]
    assert ba.Trajectory.read("didymos.h5").status == "completed"


def test_json_is_one_object_and_nothing_else(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["run", "dumbbells", "--duration", "15s", "--step", "0.0002s", "--json", "--no-picture"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["status"] == "completed"
    assert result["steps"] == 75000
    assert result["max_relative_energy_error"] == pytest.approx(6.1188e-7, rel=1e-4)
    assert result["closest_approach"] == pytest.approx(0.3303, abs=1e-4)
    assert result["file"] == "dumbbells.h5"
    assert not (folder / "dumbbells.png").exists()


def test_options_take_the_place_of_the_entry(folder: Path, capsys: pytest.CaptureFixture) -> None:
    arguments = [
        "run",
        "moshup",
        "--duration",
        "2 d",
        "--step",
        "50s",
        "--save-every",
        "10 min",
        "--degree",
        "0",
        "-o",
        "a.h5",
    ]
    assert cli.main([*arguments, "--no-picture"]) == 0
    run = ba.Trajectory.read("a.h5")
    assert run.si.time[1] == 600
    assert isinstance(run.system.gravity, ba.PointMass)
    assert run.step.value == 50


def test_gravity_of_a_degree(folder: Path, capsys: pytest.CaptureFixture) -> None:
    arguments = ["run", "moshup", "--duration", "1d", "--no-picture", "--json", "--force", "-o", "a.h5"]
    figures = {}
    for degree, gravity in ((0, "PointMass()"), (2, "SecondDegree()"), (3, "Multipole(degree=3)")):
        assert cli.main([*arguments, "--degree", str(degree)]) == 0
        assert repr(ba.Trajectory.read("a.h5").system.gravity) == gravity
        figures[degree] = json.loads(capsys.readouterr().out)["max_next_degree_term"]
    assert figures[0] is None
    assert 1e-5 < figures[3] == pytest.approx(figures[2], rel=0.05)  # of ellipsoids, that is degree 4 both times


def test_going_on_from_a_file(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["run", "didymos", "--duration", "1d", "--no-picture"]) == 0
    assert cli.main(["run", "didymos.h5", "--duration", "1d", "--no-picture"]) == 0
    first, second = ba.Trajectory.read("didymos.h5"), ba.Trajectory.read("didymos-continued.h5")
    assert abs(second.position[0] - first.position[-1]).max().value < 1e-9
    assert cli.main(["run", "didymos-continued.h5", "--no-picture"]) == 2
    assert "--duration" in capsys.readouterr().err


def test_a_scenario_from_the_catalogue(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["show", "didymos", "--toml"]) == 0
    Path("mine.toml").write_text(capsys.readouterr().out)
    assert cli.main(["run", "mine.toml", "--duration", "1d"]) == 0
    assert Path("mine.h5").exists()
    assert Path("mine.png").exists()
    assert cli.main(["plot", "mine.h5", "--kind", "orbit", "-o", "orbit.svg"]) == 0
    assert Path("orbit.svg").exists()


def test_list_and_show(capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["list"]) == 0
    assert [line.split()[0] for line in capsys.readouterr().out.splitlines()] == ba.catalogue.names()
    assert cli.main(["show", "didymos"]) == 0
    out = capsys.readouterr().out
    assert "didymos_system_15.tpc" in out
    assert "separation 1184.1" in out
    assert "mass centre" not in out


def test_show_where_the_body_frame_is(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    text = ba.catalogue.text("didymos")
    first = text.index("shape = {")
    union = (
        'shape = { type = "Union", parts = [{ shape = { type = "Ellipsoid", a = "400 m", b = "390 m", '
        'c = "300 m" }, mass = "5e11 kg", offset = "[9, 0, -2] m", '
        "turn = [[0.8, -0.6, 0], [0.6, 0.8, 0], [0, 0, 1]] }] }"
    )
    file = tmp_path / "turned.toml"
    file.write_text(text[:first] + union + text[text.index("\n", first) :])
    assert cli.main(["show", str(file)]) == 0
    out = capsys.readouterr().out
    assert "mass centre [9, 0, -2] m, axes turned by 36.8699 deg in the shape's frame" in out
    assert out.count("mass centre") == 1


WRONG = {
    "a bare number": (["--step", "40"], "'40' has no unit"),
    "a wrong unit": (["--step", "40kg"], "is not a time"),
    "nonsense": (["--step", "soon"], "is not understood"),
    "a negative time": (["--duration", "-5d"], "positive"),
    "not a number": (["--duration", "nan d"], "finite"),
    "no solution": (["--step", "1500s"], "Didymos spins at 0.00077227 rad/s"),
    "a step longer than the run": (["--step", "600s", "--duration", "300s"], "longer than the run"),
    "an unknown option": (["--stp", "40s"], "unrecognized arguments"),
    "an unknown integrator": (["--integrator", "RK4"], "invalid choice"),
    "an order that is not there": (["--order", "3"], "invalid choice"),
    "an order of a splitting": (["--integrator", "Splitting", "--order", "4"], "--order: Splitting does not take it"),
    "a scheme of another method": (
        ["--integrator", "Splitting", "--scheme", "rkn8"],
        "did you mean 'rkn4'?; there are",
    ),
    "a scheme of another order": (["--order", "8", "--scheme", "kl6"], "scheme='kl6' has order 6, got order=8"),
    "too long a step for order 8": (["--order", "8", "--step", "1h"], "only below 1.652 at order 8 (kl8)"),
    "degree 1": (["--degree", "1"], "--degree: expected 0 (point masses) or 2 to 16, got 1"),
    "degree -2": (["--degree", "-2"], "--degree: expected 0 (point masses) or 2 to 16, got -2"),
    "degree 40": (["--degree", "40"], "--degree: expected 0 (point masses) or 2 to 16, got 40"),
    "degree 2.5": (["--degree", "2.5"], "invalid int value"),
    "no folder": (["-o", "nowhere/run.h5"], "no folder"),
    "another kind of file": (["-o", "run.png"], "ends in .h5"),
    "a folder for a file": (["-o", "."], "is a folder"),
}


@pytest.mark.parametrize("case", WRONG)
@pytest.mark.parametrize("as_json", [False, True])
def test_wrong_options(folder: Path, capsys: pytest.CaptureFixture, case: str, *, as_json: bool) -> None:
    options, says = WRONG[case]
    assert cli.main(["run", "didymos", "--duration", "1d", *options, *(["--json"] if as_json else [])]) == 2
    captured = capsys.readouterr()
    assert says in captured.err
    assert captured.err.count("\n") == 1
    if as_json:
        result = json.loads(captured.out)
        assert result["status"] == "error"
        assert says in result["message"]
    else:
        assert captured.out == ""
    assert files(folder) == []


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["run", "didimos"], "did you mean 'didymos'"),
        (["run", "none.toml"], "no such file"),
        (["run", "none.h5", "--duration", "1d"], "no such file"),
        (["plot", "none.h5"], "no such file"),
        (["show", "none"], "not in the catalogue"),
        ([], "required: COMMAND"),
        (["fly"], "invalid choice"),
        (["completion", "fish"], "invalid choice"),
    ],
)
def test_wrong_names(folder: Path, capsys: pytest.CaptureFixture, arguments: list[str], says: str) -> None:
    assert cli.main(arguments) == 2
    captured = capsys.readouterr()
    assert says in captured.err
    assert captured.err.count("\n") == 1
    assert captured.out == ""


SCENARIOS = {
    "negative mass": ('gm = "34.5980739686124 m3 / s2"', 'mass = "-5e11 kg"', "positive"),
    "negative axis": ('a = "425.5 m"', 'a = "-425.5 m"', "positive"),
    "a bare length": ('a = "425.5 m"', "a = 425.5", 'with a unit such as "425.5 m"'),
    "an inertia that no mass has": (
        'gm = "34.5980739686124 m3 / s2"',
        'gm = "34 m3 / s2"\ninertia = "[1e16, 1e16, 3e16] kg m2"',
        "triangle",
    ),
    "overlap": ('period = "11.921473 h"', 'separation = "500 m"', "overlap at the start"),
    "an unknown key": ('period = "11.921473 h"', 'perid = "11.921473 h"', "did you mean 'period'"),
}


@pytest.mark.parametrize("case", SCENARIOS)
def test_wrong_scenarios(folder: Path, capsys: pytest.CaptureFixture, case: str) -> None:
    old, new, says = SCENARIOS[case]
    Path("mine.toml").write_text(ba.catalogue.text("didymos").replace(old, new, 1))
    assert cli.main(["run", "mine.toml", "--duration", "1d"]) == 2
    captured = capsys.readouterr()
    assert says in captured.err
    assert captured.err.count("\n") == 1
    assert files(folder) == ["mine.toml"]


def test_an_attitude_that_is_not_a_rotation(folder: Path, capsys: pytest.CaptureFixture) -> None:
    text = ba.catalogue.text("dumbbells").replace("R = [[1, 0, 0]", "R = [[2, 0, 0]")
    Path("mine.toml").write_text(text)
    assert cli.main(["run", "mine.toml"]) == 2
    assert "not a rotation" in capsys.readouterr().err


def test_a_file_that_exists_is_refused_before_the_run(folder: Path, capsys: pytest.CaptureFixture) -> None:
    for name in ("didymos.h5", "didymos.png"):
        Path(name).write_text("precious")
        assert cli.main(["run", "didymos"]) == 2
        assert f"{name} exists already" in capsys.readouterr().err
        assert Path(name).read_text() == "precious"
        Path(name).unlink()
    Path("didymos.h5").write_text("old")
    assert cli.main(["run", "didymos", "--duration", "1d", "--force"]) == 0


def test_a_broken_file(folder: Path, capsys: pytest.CaptureFixture) -> None:
    Path("broken.h5").write_bytes(b"\x89HDF\r\n\x1a\n" + b"\0" * 100)
    assert cli.main(["plot", "broken.h5"]) == 2
    captured = capsys.readouterr()
    assert "not a readable HDF5 file" in captured.err
    assert captured.err.count("\n") == 1
    assert files(folder) == ["broken.h5"]


@pytest.mark.skipif(os.name == "nt", reason="the system has no limit on the size of files")
def test_no_room(folder: Path) -> None:
    shell = f"ulimit -f 20; exec {sys.executable} -m binaryast run didymos --duration 20d --no-picture"
    result = subprocess.run(["bash", "-c", shell], capture_output=True, text=True, check=False, cwd=folder)
    assert result.returncode == 2
    assert "could not be written" in result.stderr
    assert result.stderr.strip().count("\n") == 0
    assert files(folder) == []


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="the administrator may write everywhere")
def test_a_folder_that_cannot_be_written(folder: Path, capsys: pytest.CaptureFixture) -> None:
    locked = folder / "locked"
    locked.mkdir(mode=0o500)
    assert cli.main(["run", "didymos", "--duration", "1d", "-o", "locked/run.h5"]) == 2
    assert "nothing can be written" in capsys.readouterr().err


@pytest.mark.skipif(not Path("/proc").is_dir(), reason="there is no folder that nobody may write")
def test_a_folder_that_nobody_can_write(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["run", "didymos", "--duration", "1d", "-o", "/proc/run.h5"]) == 2
    captured = capsys.readouterr()
    assert "nothing can be written in /proc" in captured.err
    assert captured.err.count("\n") == 1
    assert files(folder) == []


@pytest.mark.filterwarnings("always")
def test_a_run_that_fails_says_so_and_keeps_what_there_was(folder: Path, capsys: pytest.CaptureFixture) -> None:
    arguments = ["run", "dumbbells", "--duration", "15s", "--step", "0.105s", "--no-picture"]
    assert cli.main(arguments) == cli.FAILED
    error = capsys.readouterr().err
    assert "warning: a step of" in error
    assert "error: step: body" in error
    assert ba.Trajectory.read("dumbbells.h5").status == "failed"


def test_a_folder_that_refuses_to_be_written(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The same, for whoever may write everywhere: the system call is made to fail."""

    def refuse(**_) -> None:
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr("binaryast.storage.tempfile.TemporaryFile", refuse)
    assert cli.main(["run", "didymos", "--duration", "1d"]) == 2
    captured = capsys.readouterr()
    assert "nothing can be written in" in captured.err
    assert captured.err.count("\n") == 1
    assert files(folder) == []


@pytest.mark.skipif(os.name == "nt", reason="signals are sent in another way")
def test_ctrl_c_keeps_what_was_computed(folder: Path) -> None:
    before = signal.signal(
        signal.SIGINT, signal.SIG_DFL
    )  # tests in the background are deaf to it, and so their children
    process = subprocess.Popen(
        [
            sys.executable,
            "-m",
            "binaryast",
            "run",
            "didymos",
            "--duration",
            "2000000d",
            "--step",
            "40s",
            "--no-picture",
        ],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
    )
    signal.signal(signal.SIGINT, before)
    try:
        assert process.stderr is not None
        shown = ""
        while "simulated" not in shown:  # the bar appears after a second of running
            piece = process.stderr.read(20)
            assert piece, f"it ended too early: {shown}"
            shown += piece
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
    finally:
        process.kill()
    assert process.returncode == cli.INTERRUPTED
    assert "interrupted" in out
    assert "Go on with: binaryast resume didymos.h5" in err
    assert "Traceback" not in err
    run = ba.Trajectory.read(folder / "didymos.h5")
    assert run.status == "interrupted"
    assert 0 < run.time[-1].to_value("d") < 2e6


def test_ctrl_c_before_there_is_anything(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("binaryast.catalogue.entry", stopped)
    assert cli.main(["run", "didymos"]) == cli.INTERRUPTED
    assert capsys.readouterr().err == "binaryast: error: stopped before there was anything to keep\n"
    assert files(folder) == []


def test_a_reader_who_has_seen_enough(folder: Path) -> None:
    shell = f"set -o pipefail; {sys.executable} -m binaryast show didymos --toml | head -1"
    result = subprocess.run(["bash", "-c", shell], capture_output=True, text=True, check=False)
    assert "Traceback" not in result.stderr
    assert result.stdout.startswith("title")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_output_that_takes_no_more(folder: Path) -> None:
    shell = f"{sys.executable} -m binaryast list > /dev/full"
    result = subprocess.run(["bash", "-c", shell], capture_output=True, text=True, check=False)
    assert result.returncode == cli.FAILED
    assert result.stderr == "binaryast: error: standard output: No space left on device\n"


@pytest.mark.parametrize("shell", ["bash", "zsh"])
def test_completion(capsys: pytest.CaptureFixture, shell: str) -> None:
    assert cli.main(["completion", shell]) == 0
    script = capsys.readouterr().out
    assert "didymos" in script
    assert "--save-every" in script
    if shell == "bash":
        completing = script + '\nCOMP_WORDS=(binaryast run did); COMP_CWORD=2; _shtab_binaryast; echo "${COMPREPLY[@]}"'
        result = subprocess.run(["bash", "-c", completing], capture_output=True, text=True, check=False)
        assert "didymos" in result.stdout.split()


def test_python_m_binaryast() -> None:
    result = command("--version")
    assert result.returncode == 0
    assert result.stdout.startswith("binaryast ")


def test_the_kinds_of_pictures_are_those_of_plotting(capsys: pytest.CaptureFixture) -> None:
    from binaryast.plotting import KINDS

    assert cli.main(["plot", "x.h5", "--kind", "portrait"]) == 2
    message = capsys.readouterr().err
    assert all(kind in message for kind in KINDS)


def test_a_run_is_safe_whatever_happens_to_its_picture(
    folder: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*_, **__) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("binaryast.plotting.save", stopped)
    assert cli.main(["run", "didymos", "--duration", "1d"]) == cli.INTERRUPTED
    captured = capsys.readouterr()
    assert "the run is in didymos.h5" in captured.err
    assert "completed" in captured.out
    assert files(folder) == ["didymos.h5"]


def test_a_triple(folder: Path, capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["run", "sn263", "--duration", "20d", "--json"]) == 0
    result = json.loads(capsys.readouterr().out)
    assert result["names"] == ["Alpha", "Gamma", "Beta"]
    assert result["mutual_period"] is None
    assert result["periods"]["Gamma"] == pytest.approx(16.35 * 3600, rel=0.01)
    assert result["periods"]["Beta"] == pytest.approx(149.4 * 3600, rel=0.02)
    assert files(folder) == ["sn263.h5", "sn263.png"]
    assert cli.main(["run", "sn263.h5", "--duration", "5d", "--no-picture"]) == 0
    assert "period of Gamma 16.3" in capsys.readouterr().out
    assert cli.main(["plot", "sn263.h5", "--kind", "separation", "-o", "distance.png"]) == 0
    assert cli.main(["show", "sn263"]) == 0
    shown = capsys.readouterr().out
    assert "Beta (about Alpha)" in shown
    assert "Becker" in shown


def test_frame_and_integrator(folder: Path, capsys: pytest.CaptureFixture) -> None:
    arguments = ["--duration", "12h", "--json", "--no-picture", "--force"]
    separations = []
    for options in (["--frame", "relative"], ["--frame", "inertial"], ["--integrator", "RungeKutta"]):
        assert cli.main(["run", "didymos", *options, *arguments]) == 0
        assert options[1] in json.loads(capsys.readouterr().out)["integrator"]
        separations.append(ba.Trajectory.read("didymos.h5").separation[-1].value)
    assert separations[0] == pytest.approx(separations[1], rel=1e-13)
    assert separations[0] == pytest.approx(separations[2], rel=1e-6)
    assert cli.main(["run", "sn263", "--frame", "relative", *arguments]) == 2
    assert "for a pair" in json.loads(capsys.readouterr().out)["message"]
    assert cli.main(["run", "didymos", "--integrator", "RungeKutta", *arguments]) == 0
    capsys.readouterr()
    for options, expected in (
        ([], "RungeKutta(rtol=1e-12, atol=1e-12, step=None"),
        (["--frame", "inertial"], "frame='inertial'"),
        (["--integrator", "RungeKutta", "--step", "100s"], "step=<Quantity 100. s>"),
        ([], "step=<Quantity 100. s>, method='DOP853', frame='inertial'"),
        (["--step", "50s"], "LGVI(step=<Quantity 50. s>"),
    ):
        assert cli.main(["run", "didymos.h5", *options, *arguments, "-o", "didymos.h5"]) == 0
        assert expected in json.loads(capsys.readouterr().out)["integrator"]
    assert cli.main(["run", "didymos", "--integrator", "RungeKutta", *arguments]) == 0
    assert cli.main(["run", "didymos.h5", "--integrator", "LGVI", *arguments]) == 2
    assert "--step" in capsys.readouterr().err
    assert cli.main(["run", "sn263", "--duration", "2h", "--no-picture"]) == 0  # its save_every is longer


def test_list_integrators(capsys: pytest.CaptureFixture) -> None:
    assert cli.main(["list", "--integrators"]) == 0
    printed = capsys.readouterr().out
    for name, kind in integrators.KINDS.items():
        assert f"{name} " in printed
        assert kind.title in printed
        assert all(line in printed for line in kind.variants())
    assert tuple(integrators.KINDS) == cli.INTEGRATORS


@pytest.mark.parametrize(
    ("options", "expected"),
    [
        (["--step", "100s", "--order", "8"], ba.LGVI(100 * u.s, order=8)),
        (["--scheme", "yoshida4"], ba.LGVI(40 * u.s, scheme="yoshida4")),
        (["--integrator", "Splitting", "--step", "20min"], ba.Splitting(20 * u.min)),
        (["--integrator", "Splitting", "--frame", "inertial"], ba.Splitting(40 * u.s, frame="inertial")),
        (["--integrator", "KeplerSplitting", "--scheme", "aba104"], ba.KeplerSplitting(40 * u.s, scheme="aba104")),
    ],
)
def test_integrators_by_options(folder: Path, options: list[str], expected: ba.LGVI) -> None:
    assert cli.main(["run", "didymos", "--duration", "1h", "--no-picture", *options]) == 0
    run = ba.Trajectory.read("didymos.h5")
    assert repr(run.integrator) == repr(expected)
    assert run.step <= expected.step * (1 + 1e-9)
