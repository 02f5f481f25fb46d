"""The table of the validation in the README: written from a report, and held against one."""

import re
from collections.abc import Sequence
from pathlib import Path

from validation.case import Check
from validation.report import number
from validation.runner import Outcome

README = Path(__file__).parents[1] / "README.md"
BEGIN, END = "<!-- written by python -m validation --readme -->", "<!-- end -->"
FACTOR = 3  # within which two runs agree


def table(outcomes: Sequence[Outcome]) -> str:
    """Return the table: the headline checks of all cases."""
    lines = ["| case | what | error | tolerance |", "|---|---|---|---|"]
    for outcome in outcomes:
        for check in _headlines(outcome):
            what = f"{check.what}: {check.shown}" if check.shown else check.what
            what = what.replace("|", "\\|")
            lines.append(f"| {outcome.case.name} | {what} | {number(check.error)} | {number(check.tolerance)} |")
    return "\n".join(lines)


def _headlines(outcome: Outcome) -> list[Check]:
    return [check for check in outcome.checks if check.headline]


def write(outcomes: Sequence[Outcome]) -> None:
    """Write the table into the README, between its two marks."""
    text = README.read_text(encoding="utf-8")
    begin, end = text.index(BEGIN), text.index(END)
    README.write_text(f"{text[:begin]}{BEGIN}\n{table(outcomes)}\n{text[end:]}", encoding="utf-8")


def rows() -> dict[tuple[str, str], float]:
    """Return what the README says now: the error of each case and check."""
    text = README.read_text(encoding="utf-8")
    found = {}
    for line in text[text.index(BEGIN) : text.index(END)].splitlines()[3:]:
        case, what, error, _ = (cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1])
        found[case, what.replace("\\|", "|")] = float(error)
    return found


def disagreements(outcomes: Sequence[Outcome]) -> list[str]:
    """Return where the README's table and a run are apart: rows that one of them lacks, errors that differ.

    Two errors agree where neither is three times the other; where they are round-off, all that is below half of the
    tolerance is the same.
    """
    said = rows()
    measured = {(outcome.case.name, check.what): check for outcome in outcomes for check in _headlines(outcome)}
    found = []
    for (case, what), check in measured.items():
        key = next((key for key in said if key[0] == case and key[1].startswith(what)), None)
        if key is None:
            found.append(f"{case}: {what}: not in the README")
            continue
        least = check.tolerance / 2 if check.roundoff else 0.0
        one, two = (max(error, least) for error in (said.pop(key), abs(check.error)))
        if not max(one, two) <= FACTOR * min(one, two):
            found.append(f"{case}: {what}: {number(one)} in the README, {number(two)} now")
    return found + [f"{case}: {what}: in the README only" for case, what in said]
