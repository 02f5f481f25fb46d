"""The tables of a scenario that say how it moves: the start, impulses, and the events that are looked for."""

from typing import Any

from astropy.units import Quantity

from binaryast import events, impulses
from binaryast.elements import Orbit
from binaryast.errors import InputError
from binaryast.state import RelativeState, State
from binaryast.system import System
from binaryast.tables import Found, argument, call, choice, epoch, table_of, time, typed
from binaryast.units import brief

STATES = ("circular_orbit", "from_elements", "from_orbits", "inertial", "relative")


def impulses_of(tables: Any, system: System | None, duration: Quantity | None) -> tuple[impulses.AnyImpulse, ...]:
    """Return the impulses, each of which must be before the end."""
    if not isinstance(tables, list) or not all(isinstance(table, dict) for table in tables):
        raise InputError(f"impulses: expected tables [[impulses]], got {brief(tables)}")
    found = Found()
    made = [found.attempt(typed, table, impulses.KINDS, f"impulses[{i}]") for i, table in enumerate(tables)]
    found.said()
    return () if system is None or duration is None else impulses.in_order(made, system, float(duration.value))


def events_of(tables: Any, system: System | None) -> tuple[events.Event, ...]:
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


def state_of(tables: dict[str, Any], system: System | None) -> State | None:
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
