"""What a case of the validation is: a question, an oracle, checks of an error against a tolerance, figures."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from enum import IntEnum
from importlib import util
from importlib.metadata import PackageNotFoundError, version

from matplotlib.figure import Figure


class Effort(IntEnum):
    """How much is run: what the tests run, the whole, or what takes longer than a coffee."""

    QUICK = 0
    WHOLE = 1
    LONG = 2


@dataclass(frozen=True)
class Check:
    """One error beside what it may be.

    Attributes
    ----------
    what : str
        What was compared, unique in its case.
    error, tolerance : float
        The error that was measured, and the largest that passes: no more than ten times what is expected.
    why : str
        Where the error comes from: a reader sees that it is understood.
    shown : str
        The figure itself, where it says more than its error: a slope, a frequency.
    headline : bool
        Whether the README shows it. Such a check runs with every effort, and gives the same figure with each.
    roundoff : bool
        Whether the error is round-off, whose digits differ from machine to machine.
    printed : bool
        Whether the tolerance is what the oracle's printed digits leave, so that the error may be far below it; also of
        a count, which is a whole number.
    """

    what: str
    error: float
    tolerance: float
    why: str
    shown: str = ""
    headline: bool = False
    roundoff: bool = False
    printed: bool = False

    @property
    def passed(self) -> bool:
        """Whether the error is within the tolerance; what is not a number is not."""
        return abs(self.error) <= self.tolerance


@dataclass(frozen=True)
class Picture:
    """A figure with its name and a caption that says what to see."""

    name: str
    figure: Figure
    caption: str


@dataclass(frozen=True)
class Findings:
    """What a case found: its checks, pictures, and paragraphs that explain."""

    checks: Sequence[Check]
    pictures: Sequence[Picture] = ()
    notes: Sequence[str] = ()


@dataclass(frozen=True)
class Case:
    """A question put to the package and to an oracle that shares nothing with it.

    Attributes
    ----------
    name : str
        What the command line calls it.
    question : str
        What is asked, in one sentence.
    oracle : str
        Who answers: a code, a closed form, published numbers.
    run : callable
        Takes an `Effort`, returns `Findings`.
    needs : sequence of str
        Packages that must be installed, whose versions the report names.
    """

    name: str
    question: str
    oracle: str
    run: Callable[[Effort], Findings] = field(repr=False)
    needs: Sequence[str] = ()

    @property
    def missing(self) -> list[str]:
        """The packages that it needs and that are not here."""
        return [name for name in self.needs if util.find_spec(name) is None]

    @property
    def oracle_and_version(self) -> str:
        """The oracle, with the versions of the packages that it is made of."""
        versions = [f"{name} {version_of(name)}" for name in self.needs]
        return f"{self.oracle} ({', '.join(versions)})" if versions else self.oracle


def version_of(package: str) -> str:
    """Return the version of a package, or that it has none or is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return "not installed" if util.find_spec(package) is None else "of unknown version"
