"""Tables of a TOML file: which keys they may have, and their values as the arguments of a constructor."""

import inspect
from collections.abc import Callable, Iterable, Sequence
from datetime import UTC, datetime
from typing import Any

from astropy.time import Time
from astropy.units import Quantity

from binaryast.errors import InputError, did_you_mean
from binaryast.units import brief, parse, quantity, to_si

PLAIN = (  # arguments that have no unit
    *("weights", "parts", "table", "C", "S", "normalised", "condon_shortley", "turn", "degree"),
    *("density_ratio", "outer", "inner", "file", "facets", "unit", "mend"),
    *("accuracy", "near", "far", "parallel"),
    *("order", "scheme", "method", "rtol", "atol", "tolerance"),
    *("body", "beta"),
    *("raised_by", "love_number", "quality_factor", "coefficient", "normal", "specular", "diffuse"),
    *("first_term_only", "ecliptic", "orbit", "sun"),
    *("bodies", "origin", "axes", "normal", "quantity", "direction", "terminal"),
    *("eccentricity", "about", "R", "R2", "attitude", "epoch", "frame"),
)
EXAMPLES = {  # what a text with a unit looks like
    "time": "1 d",
    "delta_v": "[0, -2.6, 0] mm / s",
    "point": "[10, 55, 0] m",
    "value": "5 deg",
    "distance": "2 km",
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
    "gm": "398600 km3 / s2",
    "speed": "8 km / s",
    "time_lag": "10 s",
    "radius": "400 m",
    "area": "10 m2",
    "torque": "1e-3 N m",
    "acceleration": "1e-8 rad / d2",
    "force": "1e-3 N",
    "times": "[0, 1, 2, 3, 4, 5] d",
    "positions": "[[1, 0, 0], [1, 0.1, 0]] AU",
    "semi_major_axis": "1.64 AU",
    "V": "[0, 1, 0] m / s",
    "V2": "[0, 1, 0] m / s",
    "Omega": "[0, 0, 1] deg / min",
    "Omega2": "[0, 0, 1] deg / min",
}


class MistakesError(InputError):
    """Several things that are wrong with a file, each in a line of its own."""

    def __init__(self, found: Sequence[str]) -> None:
        super().__init__(" | ".join(found))
        self.found = list(found)


class Found:
    """What has been found wrong so far: a file is looked at as a whole before anything is said."""

    def __init__(self) -> None:
        self.mistakes: list[str] = []

    def attempt(self, function: Callable[..., Any], *arguments: Any) -> Any:
        """Return what a function returns, or None and take note of what it finds wrong."""
        try:
            return function(*arguments)
        except InputError as error:
            self.mistakes += error.found if isinstance(error, MistakesError) else [str(error)]
            return None

    def said(self) -> None:
        """Raise where there is something to say."""
        if len(self.mistakes) == 1:
            raise InputError(self.mistakes[0])
        if self.mistakes:
            raise MistakesError(self.mistakes)


def call(
    function: Callable[..., Any],
    ready: dict[str, Any],
    arguments: dict[str, Any],
    where: str,
    *,
    only_look: bool = False,
) -> Any:
    """Call a constructor with arguments from a file, after a look at their names and values; or only look at them."""
    found = Found()
    parameters = [p for p in inspect.signature(function).parameters.values() if p.name not in ready]
    known = [p.name for p in parameters]
    needed = [p.name for p in parameters if p.default is inspect.Parameter.empty]
    found.attempt(check_keys, arguments, known, needed, f"{where}.")
    given = {}
    for key, value in arguments.items():
        if key in known:
            given[key] = found.attempt(argument, value, key, f"{where}.{key}")
    found.said()
    if only_look:
        return None
    try:
        return function(**ready, **given)
    except InputError as error:
        raise InputError(f"{where}: {error}") from None


def argument(value: Any, key: str, where: str) -> Any:
    """Return an argument of a constructor: a quantity from its text, lists of them, and what is in `PLAIN` as it is."""
    if key in PLAIN:
        return value
    example = EXAMPLES.get(key, "1 m")
    if isinstance(value, list) and (key == "spins" or any(isinstance(item, str) for item in value)):
        return [argument(item, key, f"{where}[{i}]") for i, item in enumerate(value)]
    if isinstance(value, list) and key == "pole":  # three numbers
        return value
    if isinstance(value, list):
        raise InputError(f'{where}: expected one text with a unit such as "{example}", got {brief(value)}')
    if value == "synchronous" or (value == "none" and where.startswith("state.spins")):
        return value
    return parse(text_of(value, where, example.lstrip("[0123456789., ]")), where, example)


def time(value: Any, where: str) -> Quantity:
    """Return a time that is longer than nothing."""
    return quantity(to_si(parse(text_of(value, where, "s"), where, "1 s"), "s", where, sign="positive"), "s")


def epoch(value: Any, where: str = "state.epoch") -> Time:
    """Return an epoch: an ISO date and time, followed by its scale, TDB by default."""
    if isinstance(value, datetime) and value.tzinfo is not None:
        value = f"{value.astimezone(UTC).replace(tzinfo=None).isoformat()} UTC"
    words = str(value).split()
    scale = words.pop().lower() if len(words) > 1 and words[-1].isalpha() else "tdb"
    try:
        return Time("T".join(words), scale=scale)
    except Exception:  # astropy has several, none of them short
        raise InputError(f'{where}: {brief(value)!r} is no date: expected such as "2022-09-26T23:14:24 UTC"') from None


def table_of(tables: dict[str, Any], key: str, where: str = "") -> dict[str, Any]:
    """Return a table, empty where it is missing."""
    table = tables.get(key, {})
    if not isinstance(table, dict):
        raise InputError(f"{where}{key}: expected a table, got {brief(table)}")
    return table


def text_of(value: Any, where: str, unit: str = "") -> str:
    """Return a text, with a unit in it where one is named."""
    if not isinstance(value, str):
        number = value if isinstance(value, (int, float)) else 1
        kind = f'a text with a unit such as "{number} {unit}"' if unit else "a text in quotes"
        raise InputError(f"{where}: expected {kind}, got {brief(value)}")
    return value


def choice(table: dict[str, Any], choices: Iterable[str], where: str) -> str:
    """Return the value of ``type``, which must be one of the choices."""
    if "type" not in table:
        more = "; for single pairs there is [[gravity.pairs]]" if where == "gravity" else ""
        raise InputError(f"{where}.type is missing: expected one of {', '.join(choices)}{more}")
    kind = text_of(table["type"], f"{where}.type")
    if kind not in choices:
        raise InputError(
            f"{where}.type: {kind!r} is not known{did_you_mean(kind, choices)}; expected one of {', '.join(choices)}"
        )
    return kind


def check_keys(table: dict[str, Any], known: Iterable[str], needed: Iterable[str], where: str) -> None:
    """Raise for keys that are not known, naming the nearest, and for those that are missing."""
    keys, found = list(known), Found()
    unknown = [key for key in table if key not in keys]
    for key in unknown:
        hint = did_you_mean(key, keys)
        found.mistakes.append(f"{where}{key}: unknown key{hint}; known are {', '.join(keys) or 'none'}")
    meant = " ".join(did_you_mean(key, keys) for key in unknown)
    for key in needed:
        if key not in table and repr(key) not in meant:  # one that is misspelt is not missing too
            found.mistakes.append(f"{where}{key} is missing")
    found.said()


def typed(table: dict[str, Any], kinds: dict[str, Any], where: str) -> Any:
    """Return the object of a class named by ``type``, whose other keys are its arguments."""
    kind = kinds[choice(table, kinds, where)]
    arguments = {key: value for key, value in table.items() if key != "type"}
    return call(kind, {}, arguments, where)
