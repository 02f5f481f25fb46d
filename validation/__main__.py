"""The command ``python -m validation``: runs cases, writes the report, exits with 1 where a case does not pass."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

from binaryast.errors import InputError, did_you_mean
from validation import cases, plant, readme, report, runner
from validation.case import Case, Effort
from validation.runner import Outcome

EFFORTS = {Effort.QUICK: ["--quick"], Effort.WHOLE: [], Effort.LONG: ["--long"]}


def parser() -> argparse.ArgumentParser:
    """Return the parser of the command line."""
    result = argparse.ArgumentParser(
        prog="python -m validation",
        description="Run cases against oracles and write a report; exit with 1 where a case does not pass.",
    )
    result.add_argument("cases", nargs="*", metavar="CASE", help="names of cases; all by default")
    effort = result.add_mutually_exclusive_group()
    effort.add_argument("--quick", action="store_const", const=Effort.QUICK, dest="effort", help="under 2 minutes")
    effort.add_argument("--long", action="store_const", const=Effort.LONG, dest="effort", help="what takes longest too")
    result.add_argument("--list", action="store_true", help="list the cases and their questions")
    result.add_argument(
        "-o", "--output", type=Path, default=Path("validation-report"), metavar="FOLDER", help="where the report goes"
    )
    result.add_argument("--readme", action="store_true", help="write the table of the README anew")
    result.add_argument(
        "--plant", action="store_true", help="plant mistakes in a copy of the sources, and see that a case fails"
    )
    result.add_argument(
        "--mistake", action="append", default=[], metavar="NAME", help="plant this one only; may be given again"
    )
    result.set_defaults(effort=Effort.WHOLE)
    return result


def chosen(names: Sequence[str]) -> list[Case]:
    """Return the cases of these names, or all."""
    known = {case.name: case for case in cases.ALL}
    for name in names:
        if name not in known:
            raise InputError(f"{name!r} is no case{did_you_mean(name, known)} (there are {', '.join(known)})")
    return [known[name] for name in dict.fromkeys(names)] or list(cases.ALL)


def show(outcome: Outcome) -> None:
    """Print what a case found, in a line, and a line for each failure."""
    count = f"{len(outcome.checks) - len(outcome.failed)}/{len(outcome.checks)}"
    print(f"{outcome.verdict:11} {outcome.case.name:22} {count:>7} checks {outcome.seconds:7.1f} s", flush=True)
    if outcome.problem:
        print(f"            {outcome.problem}")
    for check in outcome.failed:
        print(f"            {check.what}: {report.number(check.error)}, expected at most {check.tolerance:.1e}")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command; return the exit status: 1 where a case does not pass, 2 for wrong input."""
    try:
        return run(parser().parse_args(arguments))
    except InputError as error:
        print(f"validation: {error}", file=sys.stderr)
        return 2


def run(given: argparse.Namespace) -> int:
    """Do what was asked; return the exit status."""
    if given.list:
        for case in cases.ALL:
            print(f"{case.name:22} {case.question}")
        return 0
    if given.plant or given.mistake:
        return plant.main(given.mistake, [case.name for case in chosen(given.cases) if not case.missing])
    if given.readme and given.cases:
        raise InputError("--readme writes the table of all cases: expected no names, got " + ", ".join(given.cases))
    report.prepare(given.output)
    outcomes = []
    for outcome in runner.run(chosen(given.cases), given.effort):
        show(outcome)
        outcomes.append(outcome)
    command = " ".join(["python -m validation", *given.cases, *EFFORTS[given.effort]])
    for path in report.write(given.output, outcomes, command):
        print(path)
    print(report.summary(outcomes))
    if not all(outcome.passed for outcome in outcomes):
        return 1
    if given.readme:
        readme.write(outcomes)
    return 0


if __name__ == "__main__":
    sys.exit(main())
