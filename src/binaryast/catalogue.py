"""Real and classical systems by name, each a scenario file of the package with its sources."""

import difflib
import tomllib
from importlib.resources import files

from binaryast.errors import InputError
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
    ['didymos', 'dumbbells', 'moshup', 'patroclus']
    """
    return sorted(entry.name.removesuffix(".toml") for entry in _ENTRIES.iterdir() if entry.name.endswith(".toml"))


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
    entry = scenario(name)
    return entry.system, entry.state


def scenario(name: str) -> Scenario:
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
        near = difflib.get_close_matches(name, known, n=1, cutoff=0.5)
        question = f": did you mean {near[0]!r}?" if near else ""
        raise InputError(f"{name!r} is not in the catalogue{question}; it has {', '.join(known)}")
    return (_ENTRIES / f"{name}.toml").read_text(encoding="utf-8")
