"""What happens on the arc of a long step: contact, events, the closest approach, for solvers that know their arcs."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from itertools import combinations
from typing import NamedTuple

import numpy as np

from binaryast.events import Event
from binaryast.kernels.clearance import least_clearance
from binaryast.kernels.contact import HEADER, RADIUS
from binaryast.kernels.loop import CLOSEST
from binaryast.locating import Root, findings, resolve, within
from binaryast.outcome import Happening, Watch
from binaryast.units import Floats
from binaryast.watchlist import Places, Watchlist

LOOKS = 32  # at a step in which bodies may touch
LEAST_LOOKS = 8  # at an arc, for events
START = 1e-9  # of an arc: what is as near to the start of a run is no event, but where it starts


def first_contact(clearance: Callable[[float], float], begin: float, end: float) -> float | None:
    """Return when two bodies touch first in an interval, None where they do not; to round-off.

    A touch without overlap counts. It is missed only where the clearance turns twice within three of the looks.

    Parameters
    ----------
    clearance : callable
        Gives the smallest clearance at a time.
    begin, end : float
        Of the interval [s].
    """
    if clearance(begin) < 0.0:
        return begin
    return next((root.time for root in within(clearance, begin, end, LOOKS, 0.0) if root.direction <= 0), None)


class Arc(NamedTuple):
    """A step: when it begins and ends, its variables there, and what gives them in between."""

    begin: float
    end: float
    before: Floats
    after: Floats
    between: Callable[[float], Floats]

    def at(self, time: float) -> Floats:
        """Return the variables at a time."""
        if time == self.begin:
            return self.before
        return self.after if time == self.end else self.between(time)


class Walked(NamedTuple):
    """How far an arc is walked: to its end, or to a contact of a pair or an event that ends the run."""

    end: float
    variables: Floats
    pair: int | None = None
    event: Event | None = None


class ArcLookout:
    """Looks along arcs.

    Attributes
    ----------
    happened : list of Happening
        So far.
    closest, closest_time : float
        The smallest distance of two mass centres that lies within arcs, and when [s].
    """

    def __init__(self, watchlist: Watchlist, surfaces: Floats, begin: float, put: Callable[[Floats, Places], None]):
        self.watchlist, self.begin, self.put = watchlist, begin, put
        self.surfaces = surfaces if watchlist.by_steps else np.zeros_like(surfaces)
        count = len(watchlist.system.bodies)
        self.places = Places.of(count)
        self.radii = self.surfaces[: HEADER * count].reshape(count, HEADER)[:, RADIUS]
        self.happened: list[Happening] = []
        self.closest, self.closest_time = np.inf, 0.0

    def checkpoint(self) -> dict[str, float]:
        """Return what has been found beside what happened."""
        return {"closest": self.closest, "closest_time": self.closest_time}

    def restore(self, checkpoint: dict[str, float], happened: Sequence[Happening]) -> None:
        """Go on from a checkpoint."""
        self.closest, self.closest_time = checkpoint["closest"], checkpoint["closest_time"]
        self.happened = list(happened)

    def with_closest(self, watch: Watch, closest_time: float) -> tuple[Watch, float]:
        """Return what was watched at ends of steps, and when the bodies were closest, with what lies within arcs."""
        if not self.closest < watch.array[CLOSEST]:
            return watch, closest_time
        array = watch.array.copy()
        array[CLOSEST] = self.closest
        return replace(watch, array=array), self.closest_time

    def look(self, variables: Floats) -> Places:
        """Look where the bodies are."""
        self.put(variables, self.places)
        return self.places

    def overlapping(self, variables: Floats) -> int | None:
        """Return which pair overlaps, None where none does."""
        clearance, pair = self._clearance(variables)
        return int(pair) if clearance < 0.0 else None

    def _clearance(self, variables: Floats) -> tuple[float, float]:
        clearance: tuple[float, float] = least_clearance(*self.look(variables)[::2], self.surfaces)
        return clearance

    def walk(self, arc: Arc) -> Walked:
        """Look along an arc, and keep what happens, until the run ends by it."""
        before = Places(*(array.copy() for array in self.look(arc.before)))
        after = Places(*(array.copy() for array in self.look(arc.after)))
        end, variables, pair = arc.end, arc.after, None
        if self._comes_near(before, after):
            touched = first_contact(lambda time: self._clearance(arc.at(time))[0], arc.begin, arc.end)
            if touched is not None:
                end, variables = touched, arc.at(touched)
                pair = int(self._clearance(variables)[1])
        event = self._events(arc, end)
        if event is not None:
            end, pair = self.happened[-1].time - self.begin, None
            variables = self.happened[-1].variables
        elif pair is not None:
            owner = self.watchlist.contact_of(pair)
            self.happened.append(Happening(owner, self.begin + end, -1, variables))
        self._approach(arc, before, after, end)
        return Walked(end, variables, pair, event)

    def _comes_near(self, before: Places, after: Places) -> bool:
        """Whether the spheres that hold two bodies meet on a chord, or so near to it that they may on its arc."""
        for two, one in combinations(range(len(self.radii)), 2):
            if not self.radii[one] + self.radii[two] > 0.0:
                continue
            x, y = (places.position[one] - places.position[two] for places in (before, after))
            v, w = (places.velocity[one] - places.velocity[two] for places in (before, after))
            way, mean = y - x, v + w
            square = float(mean @ mean)
            aside = 0.25 * float(np.sqrt(way @ way * ((w - v) @ (w - v)) / square)) if square > 0 else np.inf
            s = np.clip(-(x @ way) / (way @ way), 0.0, 1.0) if np.any(way) else 0.0
            if np.linalg.norm(x + s * way) < self.radii[one] + self.radii[two] + aside:
                return True
        return False

    def _events(self, arc: Arc, end: float) -> Event | None:
        """Keep the events up to a time, in order; return the one that ends the run."""
        watchlist, seen = self.watchlist, np.nan
        if not watchlist:
            return None

        def value(k: int, time: float) -> float:
            nonlocal seen
            if time != seen:  # all functions of one moment take one look
                self.look(arc.at(time))
                seen = time
            return watchlist.value(k, self.begin + time, self.places)

        found: list[tuple[Root, int]] = []
        looks = max(LEAST_LOOKS, watchlist.looks(end - arc.begin))
        for finding in findings(value, watchlist.marks(), arc.begin, end, looks):
            k = int(finding[0])
            roots = resolve(partial(value, k), finding, watchlist.event(k).direction, watchlist.accuracy(k))
            found += [(root, k) for root in roots if root.time > START * (arc.end - arc.begin)]
        for root, k in sorted(found):
            variables = np.array(arc.at(root.time))
            self.happened.append(Happening(watchlist.owners[k], self.begin + root.time, root.direction, variables))
            if watchlist.event(k).terminal:
                return watchlist.event(k)
        return None

    def _approach(self, arc: Arc, before: Places, after: Places, end: float) -> None:
        """Keep the closest approach of two mass centres where it lies within an arc."""
        for two, one in combinations(range(len(before.position)), 2):
            if not (_approaching(before, one, two) < 0.0 < _approaching(after, one, two)):
                continue

            def rate(time: float, one: int = one, two: int = two) -> float:
                return _approaching(self.look(arc.at(time)), one, two)

            for root in within(rate, arc.begin, end, LEAST_LOOKS, 0.0, 1):
                places = self.look(arc.at(root.time))
                distance = float(np.linalg.norm(places.position[one] - places.position[two]))
                if distance < self.closest:
                    self.closest, self.closest_time = distance, root.time


def _approaching(places: Places, one: int, two: int) -> float:
    """Return (x1 - x2).(v1 - v2): below zero two bodies approach each other."""
    return float((places.position[one] - places.position[two]) @ (places.velocity[one] - places.velocity[two]))
