"""Runs cases one after the other: what each found, how long it took, and what kept it from running."""

import time
import traceback
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from validation.case import Case, Check, Effort, Findings


@dataclass(frozen=True)
class Outcome:
    """A case that was run: what it found, or the problem that kept it from that, and the time it took [s]."""

    case: Case
    findings: Findings | None
    problem: str
    seconds: float

    @property
    def checks(self) -> list[Check]:
        """The checks, none where the case did not run."""
        return list(self.findings.checks) if self.findings else []

    @property
    def failed(self) -> list[Check]:
        """The checks that failed."""
        return [check for check in self.checks if not check.passed]

    @property
    def passed(self) -> bool:
        """Whether the case ran, checked something, and every check passed."""
        return bool(self.checks) and not self.failed

    @property
    def verdict(self) -> str:
        """In a few words."""
        if self.problem:
            return "not run" if self.case.missing else "ERROR"
        return "pass" if self.passed else "FAIL"

    @property
    def tightest(self) -> Check | None:
        """The check that is nearest to its tolerance, or furthest beyond it."""
        return max(self.checks, key=_share, default=None)


def _share(check: Check) -> float:
    """Return the error over the tolerance; what is not a number is beyond all."""
    share = abs(check.error) / check.tolerance
    return share if share == share else float("inf")


def run(cases: Iterable[Case], effort: Effort) -> Iterator[Outcome]:
    """Run cases; one that raises does not keep the others from running."""
    for case in cases:
        began = time.perf_counter()
        findings, problem = None, ""
        if case.missing:
            missing = " and ".join(case.missing)
            problem = f"{missing} not installed: pip install '.[validation]', or conda install -c conda-forge heyoka.py"
        else:
            try:
                findings = case.run(effort)
            except Exception as error:  # the package under test may do anything
                problem = f"{type(error).__name__}: {error}"
                traceback.print_exc()
        yield Outcome(case, findings, problem, time.perf_counter() - began)
