"""What happened in a run: which event, when, in which direction, and where everything was."""

from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast.events import Event
from binaryast.state import State
from binaryast.units import Floats, checked, quantity
from binaryast.values import Value

UNITS = {
    "event": "",
    "time": "s",
    "direction": "",
    "position": "m",
    "velocity": "m / s",
    "attitude": "",
    "spin": "rad / s",
}


class OccurrenceFloats(NamedTuple):
    """Occurrences as plain SI floats: (K,) three times, then (K, n, 3), (K, n, 3), (K, n, 3, 3), (K, n, 3).

    ``event`` is the index of the event among those that were looked for.
    """

    event: Floats
    time: Floats
    direction: Floats
    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats

    @classmethod
    def none(cls, count: int) -> "OccurrenceFloats":
        """Return no occurrences of that many bodies."""
        vectors = np.zeros((0, count, 3))
        number = np.zeros(0)
        return cls(number, number, number, vectors, vectors, np.zeros((0, count, 3, 3)), vectors)

    def datasets(self) -> dict[str, Any]:
        """Return them as a file holds them, by name."""
        found = zip(self._fields, self, strict=True)
        return {f"events_{name}": quantity(array, UNITS[name]) if UNITS[name] else array for name, array in found}

    @classmethod
    def of_datasets(cls, datasets: dict[str, Any], count: int) -> "OccurrenceFloats":
        """Return those of a file of that many bodies, none where it does not say."""
        if "events_time" not in datasets:
            return cls.none(count)
        number = len(datasets["events_time"])
        vectors = (number, count, 3)
        shapes = ((number,), (number,), (number,), vectors, vectors, (*vectors, 3), vectors)
        arrays = {name: np.asarray(datasets[f"events_{name}"], dtype=np.float64) for name in cls._fields}
        return cls(*(checked(array, name, shape) for (name, array), shape in zip(arrays.items(), shapes, strict=True)))

    @classmethod
    def joined(cls, parts: "list[OccurrenceFloats]") -> "OccurrenceFloats":
        """Return several, one after the other."""
        return cls(*(np.concatenate(arrays) for arrays in zip(*parts, strict=True)))


@dataclass(frozen=True, eq=False)
class Occurrence(Value):
    """One event that happened.

    Parameters
    ----------
    event : Event
        Which of those that were looked for.
    time : Quantity
        When, since the start of the run [s].
    direction : int
        1 where what is watched grew, -1 where it fell, 0 where it only touched its value.
    state : State
        Where everything was.
    """

    event: Event
    time: Quantity
    direction: int
    state: State
