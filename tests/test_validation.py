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
    """Where an error is round-off, or what printed digits leave, it may happen to be smaller than it says."""
    checks = [check for check in outcome_of(case, outcomes).checks if not check.roundoff]
    assert [check.what for check in checks if check.tolerance > LOOSEST * abs(check.error)] == []


def test_the_readme_says_what_is_found(outcomes: dict[str, Outcome]) -> None:
    found = [outcome_of(case, outcomes) for case in cases.ALL]
    assert readme.disagreements(found) == []


def test_a_readme_that_says_something_else_is_seen(monkeypatch: pytest.MonkeyPatch) -> None:
    check = Check("what", 1e-6, 5e-6, "why", headline=True)
    outcome = made(check)
    for said, count in ((1.2e-6, 0), (2.9e-6, 0), (3.1e-6, 1), (0.3e-6, 1), (float("nan"), 1)):
        monkeypatch.setattr(readme, "rows", lambda said=said: {("made", "what"): said})
        assert len(readme.disagreements([outcome])) == count
    monkeypatch.setattr(readme, "rows", lambda: {("made", "another"): 1e-6})
    assert len(readme.disagreements([outcome])) == 2


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
        (made(Check("good", 0, 1, ""), needs=("no-such-package",)), "did not run"),
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
    assert first.verdict == "did not run"
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
        (["mad"], "'mad' is no case: did you mean 'made'?; there are made, bad"),
        (["--plant", "--mistake", "x"], "no mistake"),
    ],
)
def test_wrong_names(small: Path, arguments: list[str], said: str, capsys: pytest.CaptureFixture) -> None:
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
    html, markdown = report.write(tmp_path, [outcome], Effort.QUICK)
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
