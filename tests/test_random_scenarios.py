"""Scenario files at random: python -m validation --long tries ten thousand."""

import sys
from pathlib import Path

import pytest
from validation import random_scenarios

from binaryast import cli


@pytest.mark.skipif(sys.platform == "win32", reason="Ctrl-C is sent in another way")
def test_each_ends_in_a_run_or_in_one_line(monkeypatch: pytest.MonkeyPatch) -> None:
    statuses, main = [], cli.main

    def counted(arguments) -> int:
        statuses.append(main(arguments))
        return statuses[-1]

    monkeypatch.setattr(cli, "main", counted)
    assert random_scenarios.tried(200) == 200
    assert statuses.count(0) > 20  # some are sound, or only worse
    assert statuses.count(cli.WRONG_INPUT) > 100


def test_what_is_wrong_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(_) -> int:
        raise ZeroDivisionError("somewhere")

    assert not random_scenarios.trouble(random_scenarios.PLAIN, tmp_path)
    assert not random_scenarios.trouble("[[bodies]]", tmp_path)
    monkeypatch.setattr(cli, "main", raising)
    assert random_scenarios.trouble(random_scenarios.PLAIN, tmp_path) == "ZeroDivisionError: somewhere"
    monkeypatch.setattr(cli, "main", lambda _: cli.WRONG_INPUT)
    assert random_scenarios.trouble(random_scenarios.PLAIN, tmp_path) == "status 2, and 0 lines of errors"
