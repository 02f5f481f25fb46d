"""The methods under test, each as a function from a start to where the bodies are after so many equal steps.

The printed maps and the production steps of order 2 are what most cases ask; every scheme of every family has a method
too, by `of_family`.
"""

import warnings
from collections.abc import Callable, Sequence
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from binaryast.integrators import Stepping
from validation.differences import snapshot_of
from validation.fitting import to_zero

Steps = Callable[[ba.System, ba.State, float, int], Snapshot]  # system, start, time [s], number of steps


class Method(NamedTuple):
    """A method with its order; ``end`` gives where the bodies are after a time in so many steps.

    ``stages`` is how often a step evaluates gravity.
    """

    name: str
    order: int
    end: Steps
    stages: int = 1


def propagated(family: type[Stepping] = ba.LGVI, **choices: str) -> Steps:
    """Return the production steps of an integrator, with the choices that it has besides the step."""

    def end(system: ba.System, state: ba.State, time: float, count: int) -> Snapshot:
        step = time / count * (1 + 1e-12) * u.s  # the run takes the largest one up to this that divides the time
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", ba.errors.StepWarning)  # long steps show the order
            run = ba.propagate(
                system, state, duration=time * u.s, integrator=family(step, **choices), save_every=time * u.s
            )
        if run.steps != count or run.status != "completed":
            raise RuntimeError(f"expected {count} steps, got {run.steps}: {run.status} {run.message}")
        return snapshot_of(run[-1])

    return end


def of_family(family: type[Stepping], **choices: str) -> dict[str, Method]:
    """Return the methods of a family by the names of their schemes; ``choices`` are the same for all, as the frame."""
    said = "".join(f", {frame} frame" for frame in choices.values())
    return {
        name: Method(
            f"{family.__name__} {name}{said}", scheme.order, propagated(family, scheme=name, **choices), scheme.stages
        )
        for name, scheme in family.schemes.items()
    }


def printed(frame: str) -> Steps:
    """Return the map as the paper prints it: (118)-(127) in the relative frame, (93)-(97) in the inertial one."""

    def end(system: ba.System, state: ba.State, time: float, count: int) -> Snapshot:
        equations = ba.equations.discrete(system, step=time / count * u.s, frame=frame)
        return equations.snapshot(equations.advance(equations.from_state(state), count))

    return end


RELATIVE = Method("LGVI, relative frame", 2, propagated(frame="relative"))
INERTIAL = Method("LGVI, inertial frame", 2, propagated(frame="inertial"))
PRINTED_RELATIVE = Method("(118)-(127) as printed", 2, printed("relative"))
PRINTED_INERTIAL = Method("(93)-(97) as printed", 2, printed("inertial"))
OF_PAIRS = (RELATIVE, INERTIAL, PRINTED_RELATIVE, PRINTED_INERTIAL)
OF_BODIES = (INERTIAL, PRINTED_INERTIAL)


def limit(method: Method, system: ba.System, state: ba.State, time: float, counts: Sequence[int]) -> Snapshot:
    """Return where a method ends as the step goes to zero: its error, a series in h^2, extrapolated away.

    ``counts`` are the numbers of steps, each twice the one before; every one of them takes another power of h^2 away.
    A symmetric method has no odd powers. Begin with steps so short that the whole error is well below a radian.
    """
    ends = [method.end(system, state, time, count) for count in counts]
    end = Snapshot(*(to_zero(values, method.order) for values in zip(*ends, strict=True)))
    return end._replace(R=Rotation.from_matrix(end.R).as_matrix())


def slope(sizes: Sequence[float], errors: Sequence[float]) -> float:
    """Return the slope of a straight line through logarithms: the order of a method, from its last three errors."""
    return float(np.polyfit(np.log(sizes[-3:]), np.log(errors[-3:]), 1)[0])
