"""A system as the production steps see it: flat arrays, the compiled functions that go with them, and back.

A pair is stepped in the variables of its relative frame, several bodies in those of the inertial frame.
"""

from binaryast.perturbations.base import Span
from binaryast.state import State
from binaryast.system import System
from binaryast.working.base import Motion, Working


def of(system: System, state: State, *, inertial: bool = False, span: Span | None = None) -> Working:
    """Return the working arrays of a system at a state, for a pair those of the relative frame unless told otherwise.

    ``span`` is the time for which something acts from outside; by default nothing does.

    Raises
    ------
    InputError
        Where gravity is not a number there, or a user's potential raises.
    """
    if inertial or len(system.bodies) > 2:
        from binaryast.working.bodies import WorkingBodies

        return WorkingBodies(system, state, span)
    from binaryast.working.pair import WorkingPair

    return WorkingPair(system, state, span)


__all__ = ["Motion", "Working", "of"]
