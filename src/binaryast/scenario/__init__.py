"""Scenario files: a system, its start and how to run it, as TOML with units in texts.

The words are those of the Python interface: ``type`` names a class or a way to make a state, the other keys are its
arguments. Only gravity by pairs and the orbits of several bodies have tables of their own. A surface of faces is read
from a file, whose path counts from that of the scenario: ``{ type = "Polyhedron", file = "rock.obj", unit = "km" }``,
with ``facets`` and ``mend`` as in `binaryast.Polyhedron.read`; and ``Layered`` has two shapes in it, ``outer = { .. }``
and ``inner = { .. }``. So has the gravity ``Adaptive`` two models, ``near = { .. }`` and ``far = { .. }``, or one, or
none::

    [[bodies]]                                    # as many as there are, the primary first
    name = "A"
    shape = { type = "Ellipsoid", a = "500 m", b = "450 m", c = "400 m" }
    density = "2000 kg / m3"                      # or mass, or gm; inertia overrides the shape's

    [[bodies]]
    name = "B"
    shape = { type = "Sphere", radius = "60 m" }
    mass = "2e9 kg"

    [[bodies]]
    name = "craft"
    shape = { type = "Point" }
    mass = "12 kg"

    [gravity]                                     # of all pairs that are not named below
    type = "Multipole"
    degree = 4

    [[gravity.pairs]]
    bodies = ["B", "craft"]
    type = "PointMass"

    [state]                                       # or circular_orbit, from_elements (two bodies), inertial, relative
    type = "from_orbits"
    spins = ["3 h", "synchronous", "none"]        # a point has none

    [[state.orbits]]                              # one for each body but the primary
    semi_major_axis = "2 km"

    [[state.orbits]]
    semi_major_axis = "8 km"
    eccentricity = 0.1
    about = "inner"

    [state.poles]                                 # of bodies whose z axis is not their orbit's
    A = [0, 0.1, 1]

    [run]
    duration = "5 d"
    step = "20 s"
    save_every = "10 min"                         # may be left out
    accuracy = 1e-8                               # may be left out; then the command picks method and step by itself
    integrator = { type = "LGVI", order = 8 }     # so may this: LGVI of order 2

    [[perturbations]]                             # or Planet, Flyby, ThirdBody, TidalTorque, Yorp, Byorp, ...
    type = "Sun"
    orbit = { semi_major_axis = "1.64 AU", eccentricity = 0.38, mean_anomaly = "232 deg" }

    [[impulses]]                                  # or type = "Impulse", with time, body and delta_v
    type = "Impact"
    time = "1 d"
    body = "B"
    mass = "500 kg"
    velocity = "[0, -6, 0] km / s"
    beta = 2                                      # may be left out: 1
    point = "[10, 55, 0] m"                       # so may this: through the mass centre

    [[events]]                                    # or Contact, Separation, Escape, PlaneCrossing: see binaryast.events
    type = "Crossing"
    quantity = "radial_velocity"
    bodies = ["A", "B"]
    direction = 1                                 # these may be left out
    terminal = false
    accuracy = "1 ms"
    interval = "10 min"
"""

import inspect
import tomllib
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from astropy.units import Quantity

from binaryast.errors import InputError, ScenarioError, StorageError
from binaryast.events import Event
from binaryast.impulses import AnyImpulse
from binaryast.integrators import KINDS, Integrator, Stepping
from binaryast.scenario.motion import events_of, impulses_of, state_of
from binaryast.scenario.systems import system_of
from binaryast.state import State
from binaryast.storage import NEWER, as_path
from binaryast.system import System
from binaryast.tables import Found, call, check_keys, choice, table_of, text_of, time
from binaryast.toml_lines import line_of, lines_of
from binaryast.units import brief
from binaryast.values import Value

FORMAT_VERSION = 1  # what a file may say that it is written for


@dataclass(frozen=True, eq=False)
class Scenario(Value):
    """What a scenario file says.

    Attributes
    ----------
    name, title : str
        The file's stem, and one line.
    system, state : System, State
        The bodies, their gravity and where they start.
    integrator : Integrator or None
        How to run it, where no accuracy is asked for; there is one, or an accuracy, or both.
    accuracy : float or None
        The accuracy at which the command runs it.
    duration, save_every : Quantity
        How long, and how often to save; ``save_every`` may be None.
    impulses : tuple of Impulse and Impact
        In order of time.
    events : tuple of Event
        What is looked for.
    sources : tuple of dict
        ``what``, ``source`` and where known ``uncertainty`` and ``note`` of each number.
    text : str
        The file itself.
    """

    name: str
    title: str
    system: System
    state: State
    integrator: Integrator | None
    accuracy: float | None
    duration: Quantity
    save_every: Quantity | None
    impulses: tuple[AnyImpulse, ...]
    events: tuple[Event, ...]
    sources: tuple[dict[str, str], ...] = field(repr=False)
    text: str = field(repr=False)


def load(path: str | Path) -> Scenario:
    """Read a scenario file.

    Parameters
    ----------
    path : path
        A TOML file; ``binaryast show NAME --toml`` prints one to start from.

    Returns
    -------
    Scenario

    Raises
    ------
    StorageError
        Where there is no such file.
    ScenarioError
        Where it is not a scenario: the key, what was found and what was expected.
    """
    path = as_path(path)
    try:
        text = path.read_text(encoding="utf-8")
    except FileNotFoundError:
        raise StorageError(f"{path}: no such file") from None
    except (OSError, ValueError) as error:
        raise StorageError(f"{path}: cannot be read as text: {error}") from None
    return loads(text, name=path.stem, where=str(path), folder=path.parent)


def loads(text: str, *, name: str, where: str, folder: Path = Path()) -> Scenario:
    """Return the scenario that a text says.

    ``where`` is what its errors begin with, ``folder`` where the paths in it count from.
    """
    try:
        tables = tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise ScenarioError(f"{where}: not TOML: {brief(error)}") from None
    found = Found()
    scenario = found.attempt(_scenario, tables, name, text, folder)
    if not found.mistakes:
        return scenario  # type: ignore[no-any-return]
    lines = lines_of(text)
    placed = sorted(((line_of(one, lines) or 0, one) for one in found.mistakes), key=lambda item: item[0])
    said = [f"line {line}: {one}" if line else one for line, one in placed]
    count = "" if len(said) == 1 else f"{len(said)} mistakes: "
    raise ScenarioError(f"{where}: {count}{' | '.join(said)}")


def _scenario(tables: dict[str, Any], name: str, text: str, folder: Path) -> Scenario:
    """Build everything that the tables say; what is wrong with them is found as a whole, as far as it can be."""
    found = Found()
    known = ["format_version", "title", "bodies", "gravity", "perturbations", "state", "run"]
    known += ["impulses", "events", "sources"]
    found.attempt(check_keys, tables, known, ("bodies", "state", "run"), "")
    found.attempt(_check_version, tables.get("format_version", FORMAT_VERSION))
    system = found.attempt(system_of, tables, folder)
    run = found.attempt(_run, tables) or {}
    scenario = {
        "name": name,
        "title": found.attempt(text_of, tables.get("title", name), "title"),
        "system": system,
        "state": found.attempt(state_of, tables, system),
        "impulses": found.attempt(impulses_of, tables.get("impulses", []), system, run.get("duration")),
        "events": found.attempt(events_of, tables.get("events", []), system),
        "sources": found.attempt(_sources, tables.get("sources", [])),
        "text": text,
    }
    found.said()
    return Scenario(**scenario, **run)


def _check_version(value: Any) -> None:
    """Raise where a newer version of the package is meant."""
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise InputError(f"format_version: expected a whole number from 1 to {FORMAT_VERSION}, got {brief(value)}")
    if value > FORMAT_VERSION:
        raise InputError(f"format_version: expected 1 to {FORMAT_VERSION}, got {value}: {NEWER}")


def _run(tables: dict[str, Any]) -> dict[str, Any]:
    """Return how to run it: integrator, accuracy, duration and how often to save."""
    if "run" not in tables:
        return {}
    found, run = Found(), table_of(tables, "run")
    found.attempt(check_keys, run, ("duration", "step", "save_every", "accuracy", "integrator"), ("duration",), "run.")
    result = {
        "integrator": found.attempt(_integrator, run),
        "accuracy": found.attempt(_accuracy, run["accuracy"]) if "accuracy" in run else None,
        "duration": found.attempt(time, run["duration"], "run.duration") if "duration" in run else None,
        "save_every": found.attempt(time, run["save_every"], "run.save_every") if "save_every" in run else None,
    }
    found.said()
    return result


def _integrator(run: dict[str, Any]) -> Integrator | None:
    """Return how to run it: the integrator's table, its step beside it; None where there is an accuracy alone."""
    if "accuracy" in run and "step" not in run and "integrator" not in run:
        return None
    table = table_of(run, "integrator", "run.") or {"type": "LGVI"}
    kind = KINDS[choice(table, KINDS, "run.integrator")]
    arguments = {key: value for key, value in table.items() if key != "type"}
    if "step" not in run and issubclass(kind, Stepping):
        raise InputError("run.step is missing: expected a step, or an accuracy such as accuracy = 1e-8")
    if "step" in run and "step" not in inspect.signature(kind).parameters:
        raise InputError(f"run.step: {kind.__name__} chooses its steps itself: leave it out")
    step = {"step": time(run["step"], "run.step")} if "step" in run else {}
    return call(kind, step, arguments, "run.integrator")  # type: ignore[no-any-return]


def _accuracy(value: Any) -> float:
    """Return an accuracy: what it may be is said where it is used."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"run.accuracy: expected a number such as 1e-8, got {brief(value)}")
    return float(value)


def _sources(value: Any) -> tuple[dict[str, str], ...]:
    """Return where the numbers come from."""
    if not isinstance(value, list):
        raise InputError(f"sources: expected tables [[sources]], got {brief(value)}")
    found = Found()
    made = [found.attempt(_source, source, f"sources[{i}]") for i, source in enumerate(value)]
    found.said()
    return tuple(made)


def _source(table: Any, where: str) -> dict[str, str]:
    """Return where a number comes from."""
    if not isinstance(table, dict):
        raise InputError(f"{where}: expected a table, got {brief(table)}")
    check_keys(table, ("what", "source", "uncertainty", "note"), ("what", "source"), f"{where}.")
    return {key: text_of(value, f"{where}.{key}") for key, value in table.items()}
