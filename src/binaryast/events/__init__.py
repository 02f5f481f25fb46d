"""What may happen in a run: two bodies touch, come or go to a distance, cross a plane, a quantity passes a value.

Each event has a function g that is zero when it happens. A run looks at g after each step, and within a step where that
is long, and finds the root where g has passed through zero, or turned at it.
"""

from collections.abc import Sequence
from typing import Any

from binaryast.errors import InputError
from binaryast.events.base import Event, Watched
from binaryast.events.crossings import Crossing, PlaneCrossing
from binaryast.events.pairs import Contact, Escape, Separation
from binaryast.events.user import UserEvent, event
from binaryast.system import System
from binaryast.units import brief

__all__ = [
    "KINDS",
    "Contact",
    "Crossing",
    "Escape",
    "Event",
    "PlaneCrossing",
    "Separation",
    "UserEvent",
    "Watched",
    "checked",
    "event",
    "through",
]

KINDS: dict[str, type[Event]] = {kind.__name__: kind for kind in (Contact, Separation, Escape, PlaneCrossing, Crossing)}


def through(events: Sequence[Event]) -> bool:
    """Whether some bodies may go through each other, so that steps do not look for contact by themselves."""
    return any(isinstance(event, Contact) and not event.terminal for event in events)


def checked(events: Any, system: System) -> tuple[Event, ...]:
    """Return events that can happen to a system.

    Where two bodies may go through each other, the contacts of all others become events that end the run.

    Raises
    ------
    InputError
        For what is no event, or cannot happen to this system.
    """
    if isinstance(events, str) or not isinstance(events, Sequence):
        raise InputError(f"events: expected a list of ba.events, got {brief(events)}")
    for i, one in enumerate(events):
        if not isinstance(one, Event):
            raise InputError(f"events[{i}]: expected one of ba.events, such as ba.events.Contact(), got {brief(one)}")
        try:
            one.watched(system)
        except InputError as error:
            raise InputError(f"events[{i}]: {error}") from None
    if not through(events):
        return tuple(events)
    known = {pair for one in events if isinstance(one, Contact) for pair in one.pairs(system)}
    others = [(pair.primary, pair.secondary) for pair in system.pairs]
    return (*events, *(Contact(pair) for pair in others if pair not in known))
