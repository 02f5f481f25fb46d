"""What acts from outside on a system, as the compiled steps see it."""

import numpy as np
from numba import types

from binaryast.errors import InputError
from binaryast.kernels.external import layout
from binaryast.kernels.external.arguments import External
from binaryast.kernels.jit import EXTERNAL_POTENTIAL, FORCE
from binaryast.kernels.pointers import table_of
from binaryast.perturbations.base import Perturbation, Span
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats, brief


def external_of(system: System, span: Span) -> External:
    """Return what acts on a system in a span of time, with room for what it exerts."""
    acting = system.perturbations
    potentials = [perturbation for perturbation in acting if perturbation.conservative]
    forces = [perturbation for perturbation in acting if not perturbation.conservative]
    each = [perturbation.parameters(system.bodies, span) for perturbation in (*potentials, *forces)]
    n = len(system.bodies)
    return External(
        potentials=table_of([one.kernel for one in potentials], types.FunctionType(EXTERNAL_POTENTIAL)),
        forces=table_of([one.kernel for one in forces], types.FunctionType(FORCE)),
        parameters=np.concatenate([np.zeros(0), *each]),
        begins=np.cumsum([0, *(len(parameters) for parameters in each)]),
        x=np.zeros((n, 3)),
        v=np.zeros((n, 3)),
        R=np.zeros((n, 3, 3)),
        Omega=np.zeros((n, 3)),
        F=np.zeros((n, 3)),
        N=np.zeros((n, 3)),
        counts=np.array([float(body.pulls) for body in system.bodies]),
    )


def check_perturbations(system: System, state: State, origin: tuple[Floats, Floats], span: Span) -> None:
    """Raise where a perturbation cannot act from here on, or exerts what is not a number.

    ``origin`` is the place and the velocity of the barycentre.
    """
    position, velocity, attitude, spin = (array.copy() for array in state.si)
    for perturbation in system.perturbations:
        perturbation.check_start(system.bodies, position - origin[0], span)
        force, torque = np.zeros_like(position), np.zeros_like(position)
        p, place = perturbation.parameters(system.bodies, span), position - origin[0]
        try:
            if perturbation.conservative:
                values = perturbation.kernel(p, span.begin, place, attitude, force, torque)
            else:
                perturbation.kernel(p, span.begin, place, velocity - origin[1], attitude, spin, force, torque)
                values = ()
        except InputError:
            raise
        except Exception as error:  # whatever a user's function raises
            raise InputError(f"{_name(perturbation)} raised {type(error).__name__}: {brief(error)}") from None
        if not np.all(np.isfinite([*values, *force.ravel(), *torque.ravel()])):
            raise InputError(f"{_name(perturbation)}: what it exerts at the start is not a number")


def _name(perturbation: Perturbation) -> str:
    """Return what a perturbation is called in a message."""
    function = getattr(perturbation, "function", None)
    return f"{type(perturbation).__name__}{f' {function.__name__}' if callable(function) else ''}"


def extended(state: Floats, begin: float) -> Floats:
    """Return a working state with the numbers that outside action needs, at a time [s] of the run."""
    more = np.zeros(layout.SIZE)
    more[layout.TIME] = begin
    return np.concatenate([state, more])
