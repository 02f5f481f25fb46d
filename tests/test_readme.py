"""The README's promises: its Python runs, its commands are the ones that CI runs, its bounds are the ones tried."""

import os
import re
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"```(\w+)\n(.*?)```", README, flags=re.DOTALL)


def test_its_python_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    first, *more = [text for language, text in BLOCKS if language == "python"]
    assert len([line for line in first.splitlines() if line.strip()]) <= 13
    names: dict = {}
    exec(first, names)
    assert names["again"].status == "completed"
    for code in more:
        exec(code, names)
    plt.close("all")


def test_ci_runs_its_test_command_and_nothing_else() -> None:
    command = next(text.strip() for language, text in BLOCKS if language == "sh" and "pytest" in text)
    lines = (ROOT / ".ci" / "run").read_text().splitlines()
    assert lines[-1] == command
    assert all(line.startswith(("#!", "set ", "cd ")) for line in lines[:-1])
    assert os.access(ROOT / ".ci" / "run", os.X_OK)


def test_its_commands_are_one_line_each() -> None:
    first, second = [text.strip() for language, text in BLOCKS if language == "sh"][:2]
    assert "\n" not in first + second
    assert "binaryast run didymos" in first


def test_what_it_shows_is_there() -> None:
    for path in re.findall(r"\]\(([^)#]+)\)", README):
        assert (ROOT / path).exists(), path


def test_every_dependency_has_a_lower_bound_that_is_tried() -> None:
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    optional = project["optional-dependencies"]
    every = project["dependencies"] + [item for extra in optional.values() for item in extra]
    wanted = [item for item in every if not item.startswith("binaryast[")]
    pattern = r"([\w-]+)>=([\d.]+)(?:,<[\d.]+)?(?:; sys_platform == 'linux')?"
    bounds = dict(re.fullmatch(pattern, item).groups() for item in wanted)  # type: ignore[union-attr]
    lines = (ROOT / "tests" / "lowest.txt").read_text().splitlines()
    tried = dict(re.fullmatch(r"([\w-]+)==([\d.]+)\.\*", line).groups() for line in lines if not line.startswith("#"))  # type: ignore[union-attr]
    assert tried == bounds
