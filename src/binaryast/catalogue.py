"""Real and classical systems by name, each a scenario file of the package with its sources."""

import tomllib
from importlib.resources import files

from binaryast.errors import InputError, did_you_mean
from binaryast.scenario import Scenario, loads
from binaryast.state import State
from binaryast.system import System

_ENTRIES = files("binaryast") / "entries"


def names() -> list[str]:
    """Return the names of all entries.

    Examples
    --------
    >>> import binaryast as ba
    >>> ba.catalogue.names()
    ['cubesat', 'dart', 'didymos', 'dumbbells', 'moshup', 'patroclus', 'sn263']
    """
    return sorted(file.name.removesuffix(".toml") for file in _ENTRIES.iterdir() if file.name.endswith(".toml"))


def load(name: str) -> tuple[System, State]:
    """Return the system and the start of an entry.

    Parameters
    ----------
    name : str
        One of `names`.

    Returns
    -------
    system : System
    state : State

    Raises
    ------
    InputError
        For an unknown name; the nearest is named.

    Examples
    --------
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> system.names
    ('Didymos', 'Dimorphos')
    """
    found = entry(name)
    return found.system, found.state


def entry(name: str) -> Scenario:
    """Return an entry as a whole: with its default step and duration, and the source of each number."""
    return loads(text(name), name=name, where=f"catalogue entry {name}")


def title(name: str) -> str:
    """Return the title of an entry, without building it."""
    return str(tomllib.loads(text(name))["title"])


def text(name: str) -> str:
    """Return the file of an entry, to start a scenario of one's own from."""
    known = names()
    if not isinstance(name, str):
        raise InputError(f"expected the name of a catalogue entry, got {name!r}; there are {', '.join(known)}")
    if name not in known:
        raise InputError(f"{name!r} is not in the catalogue{did_you_mean(name, known)}; it has {', '.join(known)}")
    return (_ENTRIES / f"{name}.toml").read_text(encoding="utf-8")
