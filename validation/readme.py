"""The table of the validation in the README: written from a report, and held against one."""

import re
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

from validation.case import Check
from validation.report import number
from validation.runner import Outcome

README = Path(__file__).parents[1] / "README.md"
BAR = "\\|"  # a bar in a cell of Markdown
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
BEGIN, END = "<!-- written by python -m validation --readme -->", "<!-- end -->"
FACTOR = 3  # within which two runs agree


class Row(NamedTuple):
    """A row of the table: case, what was compared with the figure itself, error and tolerance."""

    case: str
    what: str
    error: str
    tolerance: str


def table(outcomes: Sequence[Outcome]) -> str:
    """Return the table: the headline checks of all cases."""
    lines = ["| case | what | error | tolerance |", "|---|---|---|---|"]
    for row, _ in _headlines(outcomes):
        lines.append(f"| {' | '.join(cell.replace('|', BAR) for cell in row)} |")
    return "\n".join(lines)


def _headlines(outcomes: Sequence[Outcome]) -> list[tuple[Row, Check]]:
    """Return the rows, each with the check that it shows."""
    found = []
    for outcome in outcomes:
        for check in outcome.checks:
            if check.headline:
                what = f"{check.what}: {check.shown}" if check.shown else check.what
                found.append((Row(outcome.case.name, what, number(check.error), number(check.tolerance)), check))
    return found


def write(outcomes: Sequence[Outcome]) -> None:
    """Write the table into the README, between its two marks."""
    text = README.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN), text.index(END)
    README.write_text(f"{text[:begin]}{BEGIN}\n{table(outcomes)}\n{text[end:]}", encoding="utf-8")


def rows() -> list[Row]:
    """Return what the README says now."""
    text = README.read_text(encoding="utf-8")
    lines = text[text.index(BEGIN) : text.index(END)].splitlines()[3:]
    cells = [[cell.strip().replace(BAR, "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]
    return [Row(*line) for line in cells]


def disagreements(outcomes: Sequence[Outcome]) -> list[str]:
    """Return where the README's table and a run are apart: rows that one of them lacks, errors, tolerances, figures.

    Errors agree where neither is three times the other; those of round-off where both are small beside the tolerance,
    too. Of a case that could not be run nothing is said.
    """
    not_run = [outcome.case.name for outcome in outcomes if not outcome.findings]
    said = [row for row in rows() if row.case not in not_run]
    found = []
    for row, check in _headlines(outcomes):
        match = next((old for old in said if old.case == row.case and _plain(old.what) == _plain(row.what)), None)
        if match is None:
            found.append(f"{row.case}: {row.what}: not in the README")
            continue
        said.remove(match)
        if not _agree(match, row, check):
            found.append(f"{row.case}: the README says {match[1:]}, a run {row[1:]}")
    return found + [f"{row.case}: {row.what}: in the README only" for row in said]


def _agree(old: Row, new: Row, check: Check) -> bool:
    """Whether two rows say the same, but for what differs from machine to machine."""
    least = check.tolerance / 5 if check.roundoff or check.printed else 0.0
    one, two = (max(float(row.error), least) for row in (old, new))
    figures = zip(NUMBER.findall(old.what), NUMBER.findall(new.what), strict=True)
    same = all(abs(float(a) - float(b)) <= 1e-3 * abs(float(a)) for a, b in figures)
    return same and old.tolerance == new.tolerance and max(one, two) <= FACTOR * min(one, two)


def _plain(text: str) -> str:
    """Return a text without its figures."""
    return NUMBER.sub("#", text)
