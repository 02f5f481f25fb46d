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

    [[impulses]]                                  # or type = "Impulse", with time, body and delta_v
    type = "Impact"
    time = "1 d"
    body = "B"
    mass = "500 kg"
    velocity = "[0, -6, 0] km / s"
    beta = 2                                      # may be left out: 1
    point = "[10, 55, 0] m"                       # so may this: through the mass centre
"""

import inspect
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from astropy.time import Time
from astropy.units import Quantity

from binaryast import coefficients, gravity, impulses, shapes, unions
from binaryast.adaptive import Adaptive
from binaryast.bodies import RigidBody
from binaryast.errors import InputError, ScenarioError, StorageError, did_you_mean
from binaryast.integrators import KINDS, Integrator, Stepping
from binaryast.layered import Layered
from binaryast.orbits import Orbit
from binaryast.polyhedron import Polyhedron
from binaryast.polyhedron_pair import PolyhedronPair
from binaryast.polyhedron_point import PolyhedronPoint
from binaryast.state import RelativeState, State
from binaryast.storage import as_path
from binaryast.system import OTHERS, System
from binaryast.units import brief, parse, quantity, to_si
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
STATES = ("circular_orbit", "from_elements", "from_orbits", "inertial", "relative")
PLAIN = (  # arguments that have no unit
    *("weights", "parts", "table", "C", "S", "normalised", "condon_shortley", "turn", "degree"),
    *("density_ratio", "outer", "inner", "file", "facets", "unit", "mend"),
    *("accuracy", "near", "far", "parallel"),
    *("order", "scheme", "method", "rtol", "atol", "tolerance"),
    *("body", "beta"),
    *("eccentricity", "about", "R", "R2", "attitude", "epoch", "frame"),
)
EXAMPLES = {  # what a text with a unit looks like
    "time": "1 d",
    "delta_v": "[0, -2.6, 0] mm / s",
    "point": "[10, 55, 0] m",
    "mass": "2e9 kg",
    "density": "2000 kg / m3",
    "offset": "[60, 0, 0] m",
    "X": "[1, 0, 0] km",
    "velocity": "[[0, 0, 0], [0, 17, 0]] cm / s",
    "position": "[[0, 0, 0], [1, 0, 0]] km",
    "spin": "[[0, 0, 1], [0, 0, 1]] deg / min",
    "spins": "2.26 h",
    "pole": "10 deg",
    "inclination": "10 deg",
    "longitude_of_ascending_node": "10 deg",
    "argument_of_periapsis": "10 deg",
    "true_anomaly": "10 deg",
    "mean_anomaly": "10 deg",
    "period": "12 h",
    "V": "[0, 1, 0] m / s",
    "V2": "[0, 1, 0] m / s",
    "Omega": "[0, 0, 1] deg / min",
    "Omega2": "[0, 0, 1] deg / min",
}


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
    try:
        return _scenario(tables, name, text, folder)
    except InputError as error:
        raise ScenarioError(f"{where}: {error}") from None


def _scenario(tables: dict[str, Any], name: str, text: str, folder: Path) -> Scenario:
    """Build everything that the tables say."""
    _known(tables, ("title", "bodies", "gravity", "state", "run", "impulses", "sources"), "")
    _needed(tables, ("bodies", "state", "run"), "")
    bodies = tables["bodies"]
    if not isinstance(bodies, list) or not all(isinstance(body, dict) for body in bodies):
        raise InputError("bodies: expected a table [[bodies]] for each body, the primary first")
    models = _gravity(_table(tables, "gravity"))
    system = System([_body(body, f"bodies[{i}]", folder) for i, body in enumerate(bodies)], models)
    run = _table(tables, "run")
    _known(run, ("duration", "step", "save_every", "accuracy", "integrator"), "run.")
    _needed(run, ("duration",), "run.")
    duration = _time(run["duration"], "run.duration")
    return Scenario(
        name=name,
        title=_text(tables.get("title", name), "title"),
        system=system,
        state=_state(_table(tables, "state"), system),
        integrator=_integrator(run),
        accuracy=_accuracy(run["accuracy"]) if "accuracy" in run else None,
        duration=duration,
        save_every=_time(run["save_every"], "run.save_every") if "save_every" in run else None,
        impulses=_impulses(tables.get("impulses", []), system, float(duration.value)),
        sources=_sources(tables.get("sources", [])),
        text=text,
    )


def _body(table: dict[str, Any], where: str, folder: Path) -> RigidBody:
    """Return a body."""
    _known(table, ("name", "shape", "mass", "density", "gm", "inertia"), f"{where}.")
    _needed(table, ("name", "shape"), f"{where}.")
    units = {"mass": "kg", "density": "kg / m3", "gm": "m3 / s2", "inertia": "kg m2"}
    given = {key: _text(table[key], f"{where}.{key}", unit) for key, unit in units.items() if key in table}
    shape = _shape(_table(table, "shape", f"{where}."), f"{where}.shape", folder)
    quantities = {key: parse(text, f"{where}.{key}", f"1 {units[key]}") for key, text in given.items()}
    return RigidBody(table["name"], shape, **quantities)


def _shape(table: dict[str, Any], where: str, folder: Path) -> Any:
    """Return a shape, with the shapes inside it and what it needs from files."""
    kind = _choice(table, SHAPES, where)
    table = {
        key: _shape(value, f"{where}.{key}", folder) if isinstance(value, dict) else value
        for key, value in table.items()
    }
    if kind == "Union" and "parts" in table:
        table["parts"] = _parts(table["parts"], f"{where}.parts", folder)
    if kind != "Polyhedron":
        return _typed(table, SHAPES, where)
    arguments = {key: value for key, value in table.items() if key != "type"}
    return _call(_polyhedron, {"folder": folder}, arguments, where)


def _polyhedron(folder: Path, file: Any, unit: Any, facets: Any = None, mend: Any = False) -> Polyhedron:
    """Return the polyhedron of a file."""
    if not isinstance(mend, bool):
        raise InputError(f"mend: expected true or false, got {brief(mend)}")
    faces = None if facets is None else folder / _text(facets, "facets")
    return Polyhedron.read(folder / _text(file, "file"), unit, facets=faces, mend=mend)


def _parts(tables: Any, where: str, folder: Path) -> list[unions.Part]:
    """Return the parts of a union."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"{where}: expected tables, each with a shape and a mass, got {brief(tables)}")
    parts = []
    for i, table in enumerate(tables):
        _needed(table, ("shape",), f"{where}[{i}].")
        shape = _shape(_table(table, "shape", f"{where}[{i}]."), f"{where}[{i}].shape", folder)
        others = {key: value for key, value in table.items() if key != "shape"}
        parts.append(_call(unions.Part, {"shape": shape}, others, f"{where}[{i}]"))
    return parts


def _gravity(table: dict[str, Any]) -> Any:
    """Return the model, second degree where the file says nothing; or models by pairs, the first one for the others."""
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
        _needed(pair, ("bodies",), f"{where}.")
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


def _typed(table: dict[str, Any], kinds: dict[str, Any], where: str) -> Any:
    """Return the object of a class named by ``type``, whose other keys are its arguments."""
    kind = kinds[_choice(table, kinds, where)]
    arguments = {key: value for key, value in table.items() if key != "type"}
    return _call(kind, {}, arguments, where)


def _integrator(run: dict[str, Any]) -> Integrator | None:
    """Return how to run it: the integrator's table, its step beside it; None where there is an accuracy alone."""
    if "accuracy" in run and "step" not in run and "integrator" not in run:
        return None
    table = _table(run, "integrator", "run.") or {"type": "LGVI"}
    kind = KINDS[_choice(table, KINDS, "run.integrator")]
    arguments = {key: value for key, value in table.items() if key != "type"}
    if "step" not in run and issubclass(kind, Stepping):
        raise InputError("run.step is missing: expected a step, or an accuracy such as accuracy = 1e-8")
    if "step" in run and "step" not in inspect.signature(kind).parameters:
        raise InputError(f"run.step: {kind.__name__} chooses its steps itself: leave it out")
    step = {"step": _time(run["step"], "run.step")} if "step" in run else {}
    return _call(kind, step, arguments, "run.integrator")  # type: ignore[no-any-return]


def _accuracy(value: Any) -> float:
    """Return an accuracy: what it may be is said where it is used."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise InputError(f"run.accuracy: expected a number such as 1e-8, got {brief(value)}")
    return float(value)


def _impulses(tables: Any, system: System, end: float) -> tuple[impulses.AnyImpulse, ...]:
    """Return the impulses, each of which must be before the end [s]."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"impulses: expected tables [[impulses]], got {brief(tables)}")
    found = [_typed(table, impulses.KINDS, f"impulses[{i}]") for i, table in enumerate(tables)]
    return impulses.in_order(found, system, end)


def _state(table: dict[str, Any], system: System) -> State:
    """Return the start, made in one of the ways of `STATES`."""
    kind = _choice(table, STATES, "state")
    arguments = {key: value for key, value in table.items() if key != "type"}
    if "epoch" in arguments:
        arguments["epoch"] = _epoch(arguments["epoch"])
    if kind == "from_orbits":
        return _call(State.from_orbits, {"system": system} | _orbits(arguments), arguments, "state")  # type: ignore[no-any-return]
    if kind == "inertial":
        return _call(State, {}, arguments, "state")  # type: ignore[no-any-return]
    if kind == "relative":
        relative: RelativeState = _call(RelativeState, {}, arguments, "state")
        return relative.to_state(system)
    return _call(getattr(State, kind), {"system": system}, arguments, "state")  # type: ignore[no-any-return]


def _orbits(arguments: dict[str, Any]) -> dict[str, Any]:
    """Take the tables [[state.orbits]] and [state.poles] out of the arguments; return what they say."""
    tables, poles = arguments.pop("orbits", None), arguments.pop("poles", None)
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError("state.orbits: expected a table [[state.orbits]] for each body but the primary")
    orbits = [_call(Orbit, {}, table, f"state.orbits[{i}]") for i, table in enumerate(tables)]
    if poles is None:
        return {"orbits": orbits, "poles": None}
    if not isinstance(poles, dict):
        raise InputError(f"state.poles: expected a table of poles by the names of bodies, got {brief(poles)}")
    return {"orbits": orbits, "poles": {k: _argument(v, "pole", f"state.poles.{k}") for k, v in poles.items()}}


def _call(function: Callable[..., Any], ready: dict[str, Any], arguments: dict[str, Any], where: str) -> Any:
    """Call a constructor with arguments from a file, after a look at their names."""
    parameters = [p for p in inspect.signature(function).parameters.values() if p.name not in ready]
    _known(arguments, [p.name for p in parameters], f"{where}.")
    _needed(arguments, [p.name for p in parameters if p.default is inspect.Parameter.empty], f"{where}.")
    given = {key: _argument(value, key, f"{where}.{key}") for key, value in arguments.items()}
    try:
        return function(**ready, **given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def _argument(value: Any, key: str, where: str) -> Any:
    """Return an argument of a constructor: a quantity from its text, lists of them, and what is in `PLAIN` as it is."""
    if key in PLAIN:
        return value
    example = EXAMPLES.get(key, "1 m")
    if isinstance(value, list) and (key == "spins" or any(isinstance(item, str) for item in value)):
        return [_argument(item, key, f"{where}[{i}]") for i, item in enumerate(value)]
    if isinstance(value, list) and key == "pole":  # three numbers
        return value
    if isinstance(value, list):
        raise InputError(f'{where}: expected one text with a unit such as "{example}", got {brief(value)}')
    if value == "synchronous" or (value == "none" and where.startswith("state.spins")):
        return value
    return parse(_text(value, where, example.lstrip("[0123456789., ]")), where, example)


def _time(value: Any, where: str) -> Quantity:
    """Return a time that is longer than nothing."""
    return quantity(to_si(parse(_text(value, where, "s"), where, "1 s"), "s", where, sign="positive"), "s")


def _epoch(value: Any) -> Time:
    """Return an epoch: an ISO date and time, followed by its scale, TDB by default."""
    if isinstance(value, datetime) and value.tzinfo is not None:
        value = f"{value.astimezone(UTC).replace(tzinfo=None).isoformat()} UTC"
    words = str(value).split()
    scale = words.pop().lower() if len(words) > 1 and words[-1].isalpha() else "tdb"
    try:
        return Time("T".join(words), scale=scale)
    except Exception:  # astropy has several, none of them short
        raise InputError(
            f'state.epoch: {brief(value)!r} is no date: expected such as "2022-09-26T23:14:24 UTC"'
        ) from None


def _table(tables: dict[str, Any], key: str, where: str = "") -> dict[str, Any]:
    """Return a table, empty where it is missing."""
    table = tables.get(key, {})
    if not isinstance(table, dict):
        raise InputError(f"{where}{key}: expected a table, got {brief(table)}")
    return table


def _text(value: Any, where: str, unit: str = "") -> str:
    if not isinstance(value, str):
        number = value if isinstance(value, (int, float)) else 1
        kind = f'a text with a unit such as "{number} {unit}"' if unit else "a text in quotes"
        raise InputError(f"{where}: expected {kind}, got {brief(value)}")
    return value


def _sources(value: Any) -> tuple[dict[str, str], ...]:
    """Return where the numbers come from."""
    if not isinstance(value, list):
        raise InputError(f"sources: expected tables [[sources]], got {brief(value)}")
    return tuple(_source(source, f"sources[{i}]") for i, source in enumerate(value))


def _source(table: Any, where: str) -> dict[str, str]:
    """Return where a number comes from."""
    if not isinstance(table, dict):
        raise InputError(f"{where}: expected a table, got {brief(table)}")
    _known(table, ("what", "source", "uncertainty", "note"), f"{where}.")
    _needed(table, ("what", "source"), f"{where}.")
    return {key: _text(value, f"{where}.{key}") for key, value in table.items()}


def _choice(table: dict[str, Any], choices: Iterable[str], where: str) -> str:
    """Return the value of ``type``, which must be one of the choices."""
    if "type" not in table:
        more = "; for single pairs there is [[gravity.pairs]]" if where == "gravity" else ""
        raise InputError(f"{where}.type is missing: expected one of {', '.join(choices)}{more}")
    kind = _text(table["type"], f"{where}.type")
    if kind not in choices:
        raise InputError(
            f"{where}.type: {kind!r} is not known{did_you_mean(kind, choices)}; expected one of {', '.join(choices)}"
        )
    return kind


def _known(table: dict[str, Any], keys: Iterable[str], where: str) -> None:
    """Raise for the first key that is not known, naming the nearest."""
    keys = list(keys)
    for key in table:
        if key not in keys:
            raise InputError(
                f"{where}{key}: unknown key{did_you_mean(key, keys)}; known are {', '.join(keys) or 'none'}"
            )


def _needed(table: dict[str, Any], keys: Iterable[str], where: str) -> None:
    for key in keys:
        if key not in table:
            raise InputError(f"{where}{key} is missing")
