"""Where on the arc of a long step two bodies touch: what the solvers that know their arcs have in common."""

from collections.abc import Callable

import numpy as np

from binaryast.units import Floats

PIECES = 32  # of a step whose chord touches: its arc may not


def first_touch(
    begin: float,
    end: float,
    before: Floats,
    after: Floats,
    at: Callable[[float], Floats],
    touching: Callable[[Floats, Floats], int],
) -> tuple[float, Floats, int]:
    """Return where a step ends: at its end, or where two bodies touch on the way, and which pair then does.

    The chord of an arc passes nearer than the arc: only where the chord touches, the arc is followed in pieces.

    Parameters
    ----------
    begin, end : float
        When the step begins and ends [s].
    before, after : ndarray
        The variables there.
    at : callable
        Gives the variables at a time in the step.
    touching : callable
        Tells which pair touches on the straight way between two sets of variables, counted from 1, or 0.
    """
    if not touching(before, after):
        return end, after, 0
    for when in np.linspace(begin, end, PIECES + 1)[1:].tolist():
        y = at(when) if when < end else after
        if touched := touching(before, y):
            return when, y, touched
        before = y
    return end, after, 0
