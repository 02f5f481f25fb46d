"""Every error and warning of the package, under one root each."""

import difflib
from collections.abc import Iterable


class BinaryastError(Exception):
    """Root of all errors of the package; its text is one line that says how to mend it."""


class InputError(BinaryastError, ValueError):
    """A value that cannot be: negative mass, a matrix that is not a rotation, a step longer than the run."""


class UnitError(InputError):
    """A bare number where a quantity is expected, or a quantity of another kind."""


class StepError(InputError):
    """A step for which the method has no solution, or one longer than what it has to divide."""


class AccuracyError(InputError):
    """An accuracy that cannot be reached: the motion is too sensitive, or no trial run comes to its end."""


class ContactError(InputError):
    """Bodies that overlap at the start."""


class MeshError(InputError):
    """A mesh that is not one sound surface: open, turned inside out, in contact with itself, ..."""


class ScenarioError(InputError):
    """A scenario file that cannot be understood."""


class StorageError(BinaryastError, OSError):
    """A file that is missing, broken, in the way, or cannot be written."""


class MissingPackageError(BinaryastError, ImportError):
    """A package, or a program, that only some things need, and that is not installed."""


class CheckError(BinaryastError, AssertionError):
    """A run whose errors are larger than what `binaryast.Trajectory.check` was asked to accept."""


class BinaryastWarning(UserWarning):
    """Root of all warnings of the package: each is something that the user can change."""


class StepWarning(BinaryastWarning):
    """A step that works but is doubtful."""


class GravityWarning(BinaryastWarning):
    """A gravity that is cut at a low degree for bodies so near to each other."""


class InterpolationWarning(BinaryastWarning):
    """Rows that are too far apart for what is interpolated between them."""


class MeshWarning(BinaryastWarning):
    """A mesh that was mended on request: what was done to it."""


class DensityWarning(BinaryastWarning):
    """A mass that does not go with a mesh: its length unit is wrong, or the mass is."""


class EndWarning(BinaryastWarning):
    """A run that ended before its time."""


class ResumeWarning(BinaryastWarning):
    """A run that goes on, but not bit for bit, or from further back than it had come."""


def did_you_mean(word: str, words: Iterable[str]) -> str:
    """Return a question that names the nearest of the words that are known, nothing if none is near."""
    near = difflib.get_close_matches(word, list(words), n=1, cutoff=0.5)
    return f": did you mean {near[0]!r}?" if near else ""
