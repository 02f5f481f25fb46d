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

from binaryast import coefficients, events, gravity, impulses, perturbations, shapes, unions
from binaryast.adaptive import Adaptive
from binaryast.bodies import RigidBody
from binaryast.elements import Orbit
from binaryast.errors import InputError, ScenarioError, StorageError
from binaryast.integrators import KINDS, Integrator, Stepping
from binaryast.layered import Layered
from binaryast.polyhedron import Polyhedron
from binaryast.polyhedron_pair import PolyhedronPair
from binaryast.polyhedron_point import PolyhedronPoint
from binaryast.state import RelativeState, State
from binaryast.storage import NEWER, as_path
from binaryast.system import OTHERS, System
from binaryast.tables import Found, argument, call, check_keys, choice, epoch, table_of, text_of, time
from binaryast.toml_lines import line_of, lines_of
from binaryast.units import brief, parse
from binaryast.values import Value

SHAPES = {
    kind.__name__: kind
    for kind in (
        shapes.Ellipsoid,
        shapes.Sphere,
        shapes.Dumbbell,
        shapes.PointCloud,
        shapes.Point,
        Polyhedron,
        Layered,
        unions.Union,
        coefficients.InertiaIntegrals,
        coefficients.StokesCoefficients,
    )
}
GRAVITIES = {
    kind.__name__: kind
    for kind in (
        gravity.SecondDegree,
        gravity.Multipole,
        gravity.PointPairs,
        gravity.PointMass,
        gravity.EllipsoidPair,
        PolyhedronPair,
        PolyhedronPoint,
        Adaptive,
    )
}
FORMAT_VERSION = 1  # what a file may say that it is written for
STATES = ("circular_orbit", "from_elements", "from_orbits", "inertial", "relative")


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
    impulses: tuple[impulses.AnyImpulse, ...]
    events: tuple[events.Event, ...]
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
    system = found.attempt(_system, tables, folder)
    run = found.attempt(_run, tables) or {}
    scenario = {
        "name": name,
        "title": found.attempt(text_of, tables.get("title", name), "title"),
        "system": system,
        "state": found.attempt(_state, tables, system),
        "impulses": found.attempt(_impulses, tables.get("impulses", []), system, run.get("duration")),
        "events": found.attempt(_events, tables.get("events", []), system),
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


def _system(tables: dict[str, Any], folder: Path) -> System | None:
    """Return the bodies and their gravity; None where there are no bodies, which is said elsewhere."""
    found = Found()
    models = found.attempt(_gravity, tables)
    outside = found.attempt(_perturbations_of, tables)
    if "bodies" not in tables:
        found.said()
        return None
    bodies = tables["bodies"]
    if not isinstance(bodies, list) or not all(isinstance(body, dict) for body in bodies):
        found.mistakes.append("bodies: expected a table [[bodies]] for each body, the primary first")
        found.said()
    made = [found.attempt(_body, body, f"bodies[{i}]", folder) for i, body in enumerate(bodies)]
    found.said()
    return System(made, models, outside or ())


def _body(table: dict[str, Any], where: str, folder: Path) -> RigidBody:
    """Return a body."""
    found = Found()
    units = {"mass": "kg", "density": "kg / m3", "gm": "m3 / s2", "inertia": "kg m2"}
    found.attempt(check_keys, table, ("name", "shape", *units, "pulls"), ("name", "shape"), f"{where}.")
    quantities = {
        key: found.attempt(_with_unit, table[key], f"{where}.{key}", unit)
        for key, unit in units.items()
        if key in table
    }
    shape: Any = found.attempt(_shape_of, table, where, folder) if "shape" in table else None
    found.said()
    try:
        return RigidBody(table["name"], shape, **quantities, pulls=table.get("pulls", True))
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _with_unit(value: Any, where: str, unit: str) -> Quantity:
    return parse(text_of(value, where, unit), where, f"1 {unit}")


def _shape_of(table: dict[str, Any], where: str, folder: Path) -> Any:
    return _shape(table_of(table, "shape", f"{where}."), f"{where}.shape", folder)


def _shape(table: dict[str, Any], where: str, folder: Path) -> Any:
    """Return a shape, with the shapes inside it and what it needs from files."""
    kind = choice(table, SHAPES, where)
    table = {
        key: _shape(value, f"{where}.{key}", folder) if isinstance(value, dict) else value
        for key, value in table.items()
    }
    if kind == "Union" and "parts" in table:
        table["parts"] = _parts(table["parts"], f"{where}.parts", folder)
    if kind != "Polyhedron":
        return _typed(table, SHAPES, where)
    arguments = {key: value for key, value in table.items() if key != "type"}
    return call(_polyhedron, {"folder": folder}, arguments, where)


def _polyhedron(folder: Path, file: Any, unit: Any, facets: Any = None, mend: Any = False) -> Polyhedron:
    """Return the polyhedron of a file."""
    if not isinstance(mend, bool):
        raise InputError(f"mend: expected true or false, got {brief(mend)}")
    faces = None if facets is None else folder / text_of(facets, "facets")
    return Polyhedron.read(folder / text_of(file, "file"), unit, facets=faces, mend=mend)


def _parts(tables: Any, where: str, folder: Path) -> list[unions.Part]:
    """Return the parts of a union."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{where}: expected tables, each with a shape and a mass, got {brief(tables)}")
    parts = []
    for i, table in enumerate(tables):
        check_keys(table, table, ("shape",), f"{where}[{i}].")
        shape = _shape(table_of(table, "shape", f"{where}[{i}]."), f"{where}[{i}].shape", folder)
        others = {key: value for key, value in table.items() if key != "shape"}
        parts.append(call(unions.Part, {"shape": shape}, others, f"{where}[{i}]"))
    return parts


def _gravity(tables: dict[str, Any]) -> Any:
    """Return the model, second degree where the file says nothing; or models by pairs, the first one for the others."""
    table = table_of(tables, "gravity")
    pairs = table.get("pairs")
    others = {key: value for key, value in table.items() if key != "pairs"} or {"type": "SecondDegree"}
    model = _model(others, "gravity")
    if pairs is None:
        return model
    if not isinstance(pairs, list) or not all(isinstance(pair, dict) for pair in pairs):
        raise InputError(f"gravity.pairs: expected tables [[gravity.pairs]], got {brief(pairs)}")
    models: dict[Any, Any] = {OTHERS: model}
    for i, pair in enumerate(pairs):
        where = f"gravity.pairs[{i}]"
        check_keys(pair, pair, ("bodies",), f"{where}.")
        names = pair["bodies"]
        if not isinstance(names, list) or len(names) != 2 or not all(isinstance(name, str) for name in names):
            raise InputError(f"{where}.bodies: expected the names of two bodies, got {brief(names)}")
        if tuple(names) in models:
            raise InputError(f"{where}.bodies: the pair of {names[0]} and {names[1]} is given twice")
        models[tuple(names)] = _model({k: v for k, v in pair.items() if k != "bodies"}, where)
    return models


def _model(table: dict[str, Any], where: str) -> Any:
    """Return a model of gravity, with the models inside it."""
    table = {key: _model(value, f"{where}.{key}") if isinstance(value, dict) else value for key, value in table.items()}
    return _typed(table, GRAVITIES, where)


def _perturbations_of(tables: dict[str, Any]) -> list[perturbations.Perturbation]:
    """Return what acts from outside."""
    outside = tables.get("perturbations", [])
    if not isinstance(outside, list) or not all(isinstance(table, dict) for table in outside):
        raise InputError(f"perturbations: expected tables [[perturbations]], got {brief(outside)}")
    found = Found()
    made = [found.attempt(_perturbation, table, f"perturbations[{i}]") for i, table in enumerate(outside)]
    found.said()
    return made


def _perturbation(table: dict[str, Any], where: str) -> perturbations.Perturbation:
    """Return a perturbation, with the orbit, the Sun and the epoch in it."""
    table = dict(table)
    if "orbit" in table:
        orbit = table_of(table, "orbit", f"{where}.")
        table["orbit"] = call(Orbit, {}, orbit, f"{where}.orbit")
    if "sun" in table:
        table["sun"] = _perturbation(table_of(table, "sun", f"{where}."), f"{where}.sun")
    if "epoch" in table:
        table["epoch"] = epoch(table["epoch"], f"{where}.epoch")
    return _typed(table, perturbations.KINDS, where)  # type: ignore[no-any-return]


def _typed(table: dict[str, Any], kinds: dict[str, Any], where: str) -> Any:
    """Return the object of a class named by ``type``, whose other keys are its arguments."""
    kind = kinds[choice(table, kinds, where)]
    arguments = {key: value for key, value in table.items() if key != "type"}
    return call(kind, {}, arguments, where)


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


def _impulses(tables: Any, system: System | None, duration: Quantity | None) -> tuple[impulses.AnyImpulse, ...]:
    """Return the impulses, each of which must be before the end."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"impulses: expected tables [[impulses]], got {brief(tables)}")
    found = Found()
    made = [found.attempt(_typed, table, impulses.KINDS, f"impulses[{i}]") for i, table in enumerate(tables)]
    found.said()
    return () if system is None or duration is None else impulses.in_order(made, system, float(duration.value))


def _events(tables: Any, system: System | None) -> tuple[events.Event, ...]:
    """Return the events that are looked for."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"events: expected tables [[events]], got {brief(tables)}")
    found = Found()
    made = [found.attempt(_event, table, f"events[{i}]") for i, table in enumerate(tables)]
    found.said()
    return () if system is None else events.checked(made, system)


def _event(table: dict[str, Any], where: str) -> events.Event:
    """Return an event; its accuracy is a time."""
    kind = events.KINDS[choice(table, events.KINDS, where)]
    times: dict[str, Any] = {
        key: time(table[key], f"{where}.{key}") for key in ("accuracy", "interval") if key in table
    }
    others = {key: value for key, value in table.items() if key not in ("type", *times)}
    return call(kind, times, others, where)  # type: ignore[no-any-return]


def _state(tables: dict[str, Any], system: System | None) -> State | None:
    """Return the start, made in one of the ways of `STATES`; where there is no system, only look at what is said."""
    if "state" not in tables:
        return None
    table = table_of(tables, "state")
    kind = choice(table, STATES, "state")
    arguments = {key: value for key, value in table.items() if key != "type"}
    found, look = Found(), system is None
    if "epoch" in arguments:
        arguments["epoch"] = found.attempt(epoch, arguments["epoch"])
    ready: dict[str, Any] = {} if kind in ("inertial", "relative") else {"system": system}
    if kind == "from_orbits":
        ready |= found.attempt(_orbits, arguments) or {"orbits": None, "poles": None}
    makers = {"inertial": State, "relative": RelativeState}
    maker = makers[kind] if kind in makers else getattr(State, kind)
    look_only = look or bool(found.mistakes)
    made = found.attempt(lambda: call(maker, ready, arguments, "state", only_look=look_only))
    found.said()
    return made.to_state(system) if kind == "relative" and system is not None else made  # type: ignore[no-any-return]


def _orbits(arguments: dict[str, Any]) -> dict[str, Any]:
    """Take the tables [[state.orbits]] and [state.poles] out of the arguments; return what they say."""
    tables, poles, found = arguments.pop("orbits", None), arguments.pop("poles", None), Found()
    orbits: list[Any] = []
    if isinstance(tables, list) and all(isinstance(table, dict) for table in tables):
        orbits = [found.attempt(call, Orbit, {}, table, f"state.orbits[{i}]") for i, table in enumerate(tables)]
    else:
        found.mistakes.append("state.orbits: expected a table [[state.orbits]] for each body but the primary")
    if poles is not None and not isinstance(poles, dict):
        found.mistakes.append(f"state.poles: expected a table of poles by the names of bodies, got {brief(poles)}")
    elif poles is not None:
        poles = {k: found.attempt(argument, v, "pole", f"state.poles.{k}") for k, v in poles.items()}
    found.said()
    return {"orbits": orbits, "poles": poles}


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
