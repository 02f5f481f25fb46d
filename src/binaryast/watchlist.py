"""The events of a run as the kernels see them: pointers and parameters, and where the bodies are, to be looked at."""

from collections.abc import Sequence
from math import inf, pi
from typing import NamedTuple

import numpy as np

from binaryast.events import Contact, Event, Watched, through
from binaryast.kernels.events.notice import DIRECTION, FINDING, MARKS, PERIOD
from binaryast.rates import rates
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats

LOOKS_A_TURN = 16


class Places(NamedTuple):
    """Where n bodies are about the barycentre: (n, 3), (n, 3), (n, 3, 3), (n, 3). Kernels write into these arrays."""

    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats

    @classmethod
    def of(cls, count: int) -> "Places":
        """Return room for that many bodies."""
        return cls(np.zeros((count, 3)), np.zeros((count, 3)), np.zeros((count, 3, 3)), np.zeros((count, 3)))


class Watchlist:
    """What is looked for in a run.

    Attributes
    ----------
    events : tuple of Event
        As they are asked for.
    by_steps : bool
        Whether steps look for contact by themselves, to end the run.
    watched, owners : list
        The functions, and the index of the event of each.
    interval : float
        The longest time between looks [s].
    """

    def __init__(self, events: Sequence[Event], system: System, state: State) -> None:
        self.system, self.events = system, tuple(events)
        self.by_steps = not through(events)
        self.watched: list[Watched] = []
        self.owners: list[int] = []
        self.interval = inf
        for i, event in enumerate(self.events):
            if isinstance(event, Contact) and self.by_steps:
                continue
            found = event.watched(system)
            self.watched += found
            self.owners += [i] * len(found)
            if found:
                self.interval = min(self.interval, longest_interval(event, system, state))

    def __bool__(self) -> bool:
        return bool(self.watched)

    def event(self, k: int) -> Event:
        """Return the event of a function."""
        return self.events[self.owners[k]]

    def contact_of(self, pair: int) -> int:
        """Return which event is the contact of a pair that the steps themselves look for; one more if there is none."""
        two, one = self.system.pairs[pair][:2]
        for i, event in enumerate(self.events):
            if isinstance(event, Contact) and (two, one) in event.pairs(self.system):
                return i
        return len(self.events)

    def accuracy(self, k: int) -> float:
        """Return to which accuracy a function's roots are found [s]."""
        accuracy = self.event(k).accuracy
        return 0.0 if accuracy is None else float(accuracy.value)

    def value(self, k: int, t: float, places: Places) -> float:
        """Return what a function is at a time, of bodies in these places."""
        return float(self.watched[k].function(self.watched[k].parameters, t, *places))

    def marks(self) -> Floats:
        """Return fresh marks of all functions."""
        marks = np.zeros((len(self.watched), MARKS))
        marks[:, DIRECTION] = [self.event(k).direction for k in range(len(self.watched))]
        marks[:, PERIOD] = [one.period for one in self.watched]
        return marks

    def findings(self, looks: int) -> Floats:
        """Return room for what can be found at so many looks."""
        return np.zeros((len(self.watched) * looks, FINDING))

    def looks(self, step: float) -> int:
        """Return at how many places a step [s] is looked at, its end included."""
        return max(1, int(np.ceil(step / self.interval - 1e-9)))


def longest_interval(event: Event, system: System, state: State) -> float:
    """Return the longest time between looks at an event [s]."""
    if event.interval is not None:
        return float(event.interval.value)
    pairs = event.pairs(system)
    found = [rate for pair, rate in rates(system, state) if (pair.primary, pair.secondary) in pairs]
    if event.turning:
        found += np.linalg.norm(state.si.spin, axis=1).tolist()
    fastest = max(found, default=0.0)
    return 2 * pi / (LOOKS_A_TURN * fastest) if fastest > 0 else inf
