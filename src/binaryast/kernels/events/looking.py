"""Steps that are looked at for events: the same steps as without, each followed by looks at it.

A step is looked at where it ends and, if it is long, at places within it. A look within is a shorter step from where
the step began, aside from the run. Where the steps are taken in changed variables the looks are at the motion itself.
So that what was noticed can be found exactly, the motion before the last two steps is kept.
"""

from collections.abc import Callable
from typing import Any

from numba import types

from binaryast.kernels import loop
from binaryast.kernels.events.notice import LOOKS, NOTHING, notice
from binaryast.kernels.external.arguments import EXTERNAL, External
from binaryast.kernels.jit import ARRAY, EVENT_POINTER, PAIR_POINTERS, PLACES, ROWS, VIEW, Array, jit
from binaryast.kernels.pointers import reader
from binaryast.kernels.status import COMPLETED

ORIGINS = 3  # where the last two steps began, and where the last one ended


# What a look is made by, in a table of pointers.
STEP, VIEWING, POTENTIAL = 0, 1, 2
VIEW_POINTER = types.FunctionType(VIEW)
view_at = reader(VIEW_POINTER)
event_at = reader(EVENT_POINTER)


def look_signature() -> Any:
    """Return the signature of a look by functions in a table."""
    return types.int64(
        PAIR_POINTERS,  # step, view, potential
        ARRAY,  # scheme
        ARRAY,  # change
        ARRAY,  # back
        PAIR_POINTERS,  # potentials of several bodies
        ARRAY,  # parameters
        EXTERNAL,  # what acts from outside
        ARRAY,  # constants
        ARRAY,  # shares of the mass
        ARRAY,  # origin
        ARRAY,  # scratch
        types.float64,  # h
        *PLACES,
    )


@jit()
def look(
    step: Callable[..., int],
    view: Callable[..., None],
    scheme: Array,
    change: Array,
    back: Array,
    attraction: Any,
    parameters: Array,
    external: External,
    constants: Array,
    shares: Array,
    origin: Array,
    scratch: Array,
    h: float,
    position: Array,
    velocity: Array,
    attitude: Array,
    spin: Array,
) -> int:
    """Put the motion a time h after ``origin`` into ``scratch`` and the places of the bodies; return the status."""
    for i in range(scratch.size):
        scratch[i] = origin[i]
    status = COMPLETED
    if h != 0.0:
        if change.size > 1:
            status = step(scratch, constants, change, attraction, parameters, external, h)
        if status == COMPLETED:
            status = step(scratch, constants, scheme, attraction, parameters, external, h)
        if change.size > 1 and status == COMPLETED:
            status = step(scratch, constants, back, attraction, parameters, external, h)
    view(scratch, constants, shares, position, velocity, attitude, spin)
    return status


def looking_signature(attraction: Any) -> Any:
    """Return the signature of what `looking` makes."""
    return types.int64(
        *loop.loop_signature(attraction).args,
        types.FunctionType(VIEW),
        ARRAY,  # change
        ARRAY,  # back
        ARRAY,  # shares of the mass
        *PLACES,
        PAIR_POINTERS,  # events
        ARRAY,  # what they need
        ROWS,  # where that begins and ends
        ARRAY,  # fractions
        types.float64,  # begin
        ROWS,  # origins
        ROWS,  # watches
        ROWS,  # marks
        ROWS,  # findings
        ARRAY,  # scratch
    )


@jit()
def move_up(rows: Array, newest: Array) -> None:
    """Put an array behind the others, of which the oldest is lost."""
    for i in range(rows.shape[1]):
        for k in range(ORIGINS - 1):
            rows[k, i] = rows[k + 1, i]
        rows[ORIGINS - 1, i] = newest[i]


def looking(advance: Callable[..., int]) -> Callable[..., int]:
    """Return steps that are looked at, of the loop of steps of a pair or of several bodies."""

    def advance_looking(
        step: Callable[..., int],
        measure: Callable[..., Any],
        touching: Callable[..., int],
        scheme: Array,
        attraction: Any,
        parameters: Array,
        external: External,
        constants: Array,
        surfaces: Array,
        state: Array,
        before: Array,
        watch: Array,
        h: float,
        count: int,
        stride: int,
        rows: Array,
        view: Callable[..., None],
        change: Array,
        back: Array,
        shares: Array,
        position: Array,
        velocity: Array,
        attitude: Array,
        spin: Array,
        events: Any,
        needs: Array,
        where: Array,
        fractions: Array,
        begin: float,
        origins: Array,
        watches: Array,
        marks: Array,
        findings: Array,
        scratch: Array,
    ) -> int:
        """Take ``count`` steps as `loop.advance` does, fewer where something is found: the last one is then taken too.

        ``fractions`` of a step are where it is looked at, the last one its end; ``begin`` is the time when ``watch``
        had no steps. Returns a status, or minus the number of ``findings``, for which there must be room.
        """
        for _ in range(count):
            status = advance(
                step, measure, touching, scheme, attraction, parameters, external, constants, surfaces, state, before,
                watch, h, 1, stride, rows,
            )  # fmt: skip
            if status != COMPLETED:
                return status
            move_up(origins, state)
            move_up(watches, watch)
            if change.size > 1:
                status = step(origins[ORIGINS - 1], constants, back, attraction, parameters, external, h)
            found = 0
            for k in range(fractions.size):
                origin, after = origins[ORIGINS - 1], 0.0
                if fractions[k] < 1.0:
                    origin, after = origins[ORIGINS - 2], fractions[k] * h
                look(
                    step, view, scheme, change, back, attraction, parameters, external, constants, shares, origin,
                    scratch, after, position, velocity, attitude, spin,
                )  # fmt: skip
                t = begin + (watch[loop.STEPS] - 1.0 + fractions[k]) * h
                for e in range(where.shape[0]):
                    p = needs[int(where[e, 0]) : int(where[e, 1])]
                    kind = notice(marks, e, t, event_at(events, e)(p, t, position, velocity, attitude, spin))
                    if kind != NOTHING:
                        findings[found, 0], findings[found, 1] = e, kind
                        for i in range(6):
                            findings[found, LOOKS + i] = marks[e, i]
                        found += 1
            if found > 0:
                return -found
        return COMPLETED

    return advance_looking
