"""Going on with a run that was stopped: by Ctrl-C, with its process, for want of room."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version
from pathlib import Path
from typing import Any

from binaryast import run_file, storage
from binaryast.errors import InputError, ResumeWarning
from binaryast.events import Event, checked
from binaryast.gravity import PairPotential
from binaryast.propagation import Inputs, follow
from binaryast.reporting import provenance
from binaryast.run_file import RunFile
from binaryast.storage import as_path
from binaryast.streaming import Stream
from binaryast.system import System
from binaryast.trajectory import Trajectory
from binaryast.units import brief

DECIDE_BITS = ("binaryast", "kernels", "python", "numpy", "scipy", "numba", "heyoka", "machine")


def resume(
    path: str | Path, *, system: System | None = None, events: Sequence[Event] | None = None, progress: bool = False
) -> Trajectory:
    """Go on with a run that was stopped, from its last mark, to the end that was asked for.

    What comes out is, in every bit of every row and figure, what the run would have given without a stop, on the same
    machine with the same versions; else it is that to round-off, and a warning says so.

    Parameters
    ----------
    path : path
        The file that `binaryast.propagate` was given.
    system : System, optional
        The same system again, where its gravity or a force is a function of yours, which no file can keep.
    events : sequence of Event, optional
        The same events again, where one is a function of yours.
    progress : bool
        Whether to show a bar.

    Returns
    -------
    Trajectory
        The whole run, as from `binaryast.propagate`; its wall time is that of all parts.

    Raises
    ------
    StorageError
        Where the file is missing, broken at its start, in use by another process, or that of a run that is over.
    InputError
        Where a function of yours is lost and nothing is given again, or something else than the run was begun with.

    Warns
    -----
    ResumeWarning
        Where another version or machine began the run, or a part of the file is damaged and is computed again.

    Examples
    --------
    >>> import binaryast as ba
    >>> run = ba.resume("didymos.h5")  # doctest: +SKIP
    >>> run.status  # doctest: +SKIP
    'completed'
    """
    path = as_path(path)
    with run_file.opened(path) as file:
        _compare_versions(file)
        storage.remove_parts(path)
        if file.damaged:
            text = f"{path} is damaged after {file.end} bytes: what follows is computed again"
            warnings.warn(text, ResumeWarning, stacklevel=2)
        inputs = Inputs(**{"interval": None, "integrator": None} | file.inputs)
        system = _same(path, file.content.values["system"], system)
        inputs = inputs._replace(events=tuple(_same_events(path, inputs.events, events, system)))
        return follow(system, inputs, Stream(file), progress=progress)


def _compare_versions(file: RunFile) -> None:
    """Warn where what decides about the last bits is not what it was."""
    before, now = file.content.provenance, provenance()
    if "heyoka" in before:
        now["heyoka"] = version("heyoka")
    for name in DECIDE_BITS:
        if name in before and name in now and before[name] != now[name]:
            text = f"{file.path} was begun with {name} {before[name]}, this is {now[name]}: it is the same to round-off"
            warnings.warn(text, ResumeWarning, stacklevel=3)


def _same(path: Path, kept: System, given: System | None) -> System:
    """Return the system of a run: that of its file, or the one that is given again, after a look at both."""
    if given is None:
        gravities = [pair.gravity for pair in kept.pairs]
        for one in (*gravities, *kept.perturbations):
            _refuse_lost(path, one, "the system again, binaryast.resume(path, system=system)")
        return kept
    if not isinstance(given, System):
        raise InputError(f"system: expected an object of class System, got {brief(given)}")
    kinds = [[type(one) for one in system.perturbations] for system in (given, kept)]
    alike = replace(given, gravity=kept.gravity, perturbations=kept.perturbations)  # which may hold functions
    if kinds[0] != kinds[1] or repr(alike) != repr(kept):
        raise InputError(f"system: expected that of {path}, {brief(repr(kept))}, got {brief(repr(given))}")
    return given


def _same_events(path: Path, kept: tuple[Event, ...], given: Sequence[Event] | None, system: System) -> Sequence[Event]:
    """Return the events of a run: those of its file, or those that are given again."""
    if given is None:
        for one in kept:
            _refuse_lost(path, one, "the events again, binaryast.resume(path, events=events)")
        return kept
    again = checked(given, system)
    if [type(one) for one in again] != [type(one) for one in kept]:
        raise InputError(f"events: expected those of {path}, {brief(repr(kept))}, got {brief(repr(again))}")
    return again


def _refuse_lost(path: Path, one: Any, remedy: str) -> None:
    """Raise where a file could not keep a function."""
    function = getattr(one, "function", None)
    if isinstance(function, str):
        kind = "gravity" if isinstance(one, PairPotential) else type(one).__name__
        raise InputError(f"{path}: its {kind}, {function}, is a function that the file could not keep: give {remedy}")
