"""The closest approach of a run by compiled steps, where it lies within a step."""

from collections.abc import Iterator

import numpy as np

from binaryast.kernels import loop
from binaryast.locating import within
from binaryast.stepping import SteppedRun
from binaryast.units import Floats

MOST_STEPS = 20_000  # between rows: more are not followed again
MOST_PAIRS = 100  # nor are more of these, which would take longer than the run
LOOKS = 4  # at each of the two steps about it


def refine(run: SteppedRun) -> None:
    """Replace the closest approach at ends of steps by that within the two steps about it.

    The motion is followed again to there from the saved row before; this is aside from the run.
    """
    place = run.place_of_closest()
    if place is None or place.segment.stride > MOST_STEPS or len(run.system.pairs) > MOST_PAIRS:
        return
    segment, begin, steps = place
    row = run.row_before(place)
    if row is None:
        return
    w = run.working
    kept = w.state.copy()
    before = max(0, steps - 1)
    origin = run.follow_again(row, segment, before % segment.stride)
    for count in range(before, min(before + 2, segment.steps)):
        length = min(segment.step, run.elapsed - begin - count * segment.step)
        for distance, after in _approaches(run, origin, length):
            if distance < run.watch.array[loop.CLOSEST]:
                run.watch.array[loop.CLOSEST] = distance
                run.closest_time = begin + count * segment.step + after
        run.looker.look(origin, segment.step)
        origin = run.looker.scratch.copy()
    w.state[:] = kept


def _approaches(run: SteppedRun, origin: Floats, length: float) -> Iterator[tuple[float, float]]:
    """Yield the distances of pairs of mass centres that are nearest within a time after a state, and when."""
    if not length > 0.0:
        return
    places = run.looker.places
    for two, one, *_ in run.system.pairs:

        def rate(after: float, one: int = one, two: int = two) -> float:
            run.looker.look(origin, after)
            x, v = (places[k][one] - places[k][two] for k in range(2))
            return float(x @ v)

        if rate(0.0) < 0.0 < rate(length):
            for root in within(rate, 0.0, length, LOOKS, 0.0, 1):
                rate(root.time)
                yield float(np.linalg.norm(places.position[one] - places.position[two])), root.time
