"""The validation, quickly: every case passes, the README says what it finds, and a planted mistake is seen."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from validation import __main__ as command
from validation import cases, plant, readme, report, runner
from validation.case import Case, Check, Effort, Findings
from validation.oracles import gubas
from validation.runner import Outcome

GUBAS = Path(__file__).parents[2] / "shared" / "gubas"
LOOSEST = 10  # a tolerance over the error that is measured
ELSEWHERE = 30  # times that for round-off: on another machine it may happen to cancel


@pytest.fixture(scope="module")
def outcomes() -> dict[str, Outcome]:
    """Every case as it is first asked for."""
    return {}


def outcome_of(case: Case, outcomes: dict[str, Outcome]) -> Outcome:
    if case.missing:
        pytest.skip(f"{', '.join(case.missing)} is not installed")
    if case.name not in outcomes:
        (outcomes[case.name],) = runner.run([case], Effort.QUICK)
    return outcomes[case.name]


@pytest.mark.parametrize("case", cases.ALL, ids=lambda case: case.name)
def test_case(case: Case, outcomes: dict[str, Outcome]) -> None:
    outcome = outcome_of(case, outcomes)
    assert not outcome.problem
    assert [f"{check.what}: {check.error:.3g} > {check.tolerance:g}" for check in outcome.failed] == []
    assert outcome.passed
    whats = [check.what for check in outcome.checks]
    assert len(set(whats)) == len(whats)
    assert any(check.headline for check in outcome.checks)
    assert all(check.why for check in outcome.checks)


@pytest.mark.parametrize("case", cases.ALL, ids=lambda case: case.name)
def test_no_tolerance_is_loose(case: Case, outcomes: dict[str, Outcome]) -> None:
    loose = []
    for check in outcome_of(case, outcomes).checks:
        few_roundings = check.roundoff and check.tolerance < 1e-14  # which may happen to cancel
        most = LOOSEST * abs(check.error) * (ELSEWHERE if check.roundoff else 1)
        if not check.printed and not few_roundings and check.tolerance > most:
            loose.append(f"{check.what}: {check.tolerance:.2g} for {check.error:.2g}")
    assert loose == []


def test_the_readme_says_what_is_found(outcomes: dict[str, Outcome]) -> None:
    missing, there = ([case for case in cases.ALL if bool(case.missing) == absent] for absent in (True, False))
    found = [*(outcome_of(case, outcomes) for case in there), *runner.run(missing, Effort.QUICK)]
    assert readme.disagreements(found) == []


def test_a_readme_that_says_something_else_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    def count(check: Check, *row: str) -> int:
        monkeypatch.setattr(readme, "rows", lambda: [readme.Row("made", *row)])
        return len(readme.disagreements([made(check)]))

    check = Check("at 3 s", 1e-6, 5e-6, "why", shown="7.0001 m", headline=True)
    for error, wrong in (("1.2e-06", 0), ("2.9e-06", 0), ("3.1e-06", 1), ("3.0e-07", 1), ("nan", 1)):
        assert count(check, "at 3 s: 7.0000 m", error, "5.0e-06") == wrong
    assert count(check, "at 3 s: 7.1 m", "1.0e-06", "5.0e-06") == 1
    assert count(check, "at 3 s: 7.0 m", "1.0e-06", "6.0e-06") == 1
    assert count(check, "at 3 m: 7.0 m", "1.0e-06", "5.0e-06") == 2
    rounding = Check("x", 1e-16, 2e-15, "why", headline=True, roundoff=True)
    assert count(rounding, "x", "3.0e-16", "2.0e-15") == 0
    assert count(rounding, "x", "1.9e-15", "2.0e-15") == 1


def test_without_rebound_and_heyoka_the_others_run(tmp_path: Path) -> None:
    code = (
        "import sys, importlib.util as util\n"
        "find = util.find_spec\n"
        "util.find_spec = lambda name, *a: None if name in ('rebound', 'heyoka') else find(name, *a)\n"
        "sys.modules['rebound'] = sys.modules['heyoka'] = None\n"
        "from validation.__main__ import main\n"
        f"sys.exit(main(['f2bptoolkit', 'kepler', '--quick', '-o', {str(tmp_path)!r}]))\n"
    )
    root = Path(__file__).parents[1]
    result = subprocess.run([sys.executable, "-c", code], cwd=root, capture_output=True, text=True, check=False)
    assert result.returncode == 1
    assert "pass        f2bptoolkit" in result.stdout
    assert "not run     kepler" in result.stdout
    assert "rebound not installed: pip install" in result.stdout


def test_names_and_needs() -> None:
    names = [case.name for case in cases.ALL]
    assert len(set(names)) == len(names)
    assert all(case.question.endswith("?") for case in cases.ALL)


def made(*checks: Check, needs: tuple[str, ...] = ()) -> Outcome:
    case = Case("made", "Is it right?", "nothing", lambda _: Findings(checks), needs)
    (outcome,) = runner.run([case], Effort.QUICK)
    return outcome


@pytest.mark.parametrize(
    ("outcome", "verdict"),
    [
        (made(Check("good", 1e-9, 2e-9, "")), "pass"),
        (made(Check("negative", -1e-9, 2e-9, "")), "pass"),
        (made(Check("bad", 3e-9, 2e-9, ""), Check("good", 0, 1, "")), "FAIL"),
        (made(Check("no number", float("nan"), 1, "")), "FAIL"),
        (made(), "FAIL"),
        (made(Check("good", 0, 1, ""), needs=("no_such_package",)), "not run"),
    ],
)
def test_verdicts(outcome: Outcome, verdict: str) -> None:
    assert outcome.verdict == verdict
    assert outcome.passed == (verdict == "pass")


def test_a_case_that_raises_does_not_stop_the_others(capsys: pytest.CaptureFixture) -> None:
    def broken(_: Effort) -> Findings:
        raise ZeroDivisionError("no")

    good = made(Check("good", 0, 1, "")).case
    first, second = runner.run([Case("broken", "Is it?", "nothing", broken), good], Effort.QUICK)
    assert first.verdict == "ERROR"
    assert first.problem == "ZeroDivisionError: no"
    assert second.passed
    assert "ZeroDivisionError" in capsys.readouterr().err


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Path:
    """A validation of two made-up cases, one of which fails."""
    monkeypatch.chdir(tmp_path)
    good = made(Check("a < b | c", 1e-9, 2e-9, "why")).case
    bad = Case("bad", "Is it right?", "nothing", lambda _: Findings([Check("far off", 1.0, 1e-9, "why")]))
    monkeypatch.setattr(cases, "ALL", (good, bad))
    return tmp_path


def test_command_says_which_case_fails(small: Path, capsys: pytest.CaptureFixture) -> None:
    assert command.main(["--quick"]) == 1
    out = capsys.readouterr().out
    assert "FAIL        bad" in out
    assert "far off: 1.0e+00, expected at most 1.0e-09" in out
    assert "1 of 2 cases pass, 1 of 2 checks. Not passed: bad." in out
    assert command.main(["made", "--quick", "-o", "elsewhere"]) == 0
    assert (small / "elsewhere" / "report.html").exists()


def test_command_lists(small: Path, capsys: pytest.CaptureFixture) -> None:
    assert command.main(["--list"]) == 0
    assert "made                   Is it right?" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["mad"], "'mad' is no case: did you mean 'made'? (there are made, bad)"),
        (["--mistake", "x"], "'x' is no mistake"),
        (["made", "--readme"], "--readme writes the table of all cases"),
        (["-o", "file"], "the report cannot be written to file"),
    ],
)
def test_wrong_names(small: Path, arguments: list[str], said: str, capsys: pytest.CaptureFixture) -> None:
    (small / "file").touch()
    assert command.main(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert said in line


def test_report_pages(small: Path) -> None:
    command.main(["--quick"])
    html, markdown = ((small / "validation-report" / f"report.{kind}").read_text() for kind in ("html", "md"))
    assert "a &lt; b | c" in html
    assert "a < b \\| c" in markdown
    for page in (html, markdown):
        assert "bad" in page
        assert "1 of 2 cases pass" in page
    assert "src=" not in html.replace('src="data:', "")


def test_figures_are_in_the_pages(tmp_path: Path, outcomes: dict[str, Outcome]) -> None:
    outcome = outcome_of(next(case for case in cases.ALL if case.name == "discrete-law"), outcomes)
    report.prepare(tmp_path)
    html, markdown = report.write(tmp_path, [outcome], "python -m validation discrete-law")
    assert html.read_text().count("data:image/svg+xml;base64,") == 1
    assert "](figures/discrete-law.svg)" in markdown.read_text()
    assert (tmp_path / "figures" / "discrete-law.svg").read_bytes().startswith(b"<?xml")


@pytest.mark.parametrize("name", [name for name in plant.MISTAKES if name != "none"])
def test_every_mistake_fits_the_sources(name: str) -> None:
    mistake = plant.MISTAKES[name]
    assert (plant.SOURCE / mistake.file).read_text().count(mistake.right) == 1
    assert mistake.wrong != mistake.right


@pytest.mark.parametrize(("name", "seen_by"), [("none", []), ("wrong-G", ["gubas"]), ("sign-of-M", ["gubas"])])
def test_a_planted_mistake_is_seen(name: str, seen_by: list[str]) -> None:
    """All of them are planted by ``python -m validation --plant``; these two and none, against one case, here."""
    sight = plant.attempt(name, ["gubas"])
    assert sight.seen_by == seen_by
    assert sight.passed == (not seen_by)


def test_the_kept_rows_are_gubas_own() -> None:
    if not GUBAS.is_dir():
        pytest.skip("the reference runs of GUBAS are not here")
    for path in gubas.FOLDER.glob("gubas_N*.csv"):
        degree, kind = path.stem.removeprefix("gubas_N").split("_", 1)
        kept, whole = (gubas.Rows.read(p) for p in (path, GUBAS / f"ellipsoids_excited_N{degree}_{kind}_2d.csv"))
        at = np.searchsorted(whole.time, kept.time)
        for one, two in zip(kept, whole, strict=True):
            np.testing.assert_array_equal(one, two[at])


def test_as_a_command(tmp_path: Path) -> None:
    root = Path(__file__).parents[1]
    arguments = [sys.executable, "-m", "validation", "f2bptoolkit", "--quick", "-o", str(tmp_path)]
    result = subprocess.run(arguments, cwd=root, capture_output=True, text=True, check=False)
    assert result.returncode == 0, result.stderr
    assert "1 of 1 cases pass" in result.stdout
