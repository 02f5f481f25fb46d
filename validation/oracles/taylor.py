"""heyoka's Taylor integrator, in double and in quadruple precision, with units that round nothing on the way.

heyoka controls its step by the largest component of the state, so that variables should be of order one. The units here
are powers of two: every number of the package passes into them and back to the last bit.
"""

from collections.abc import Sequence
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot

REAL = getattr(hy, "real128", np.longdouble)  # where a long double has 128 bits, heyoka takes that
TOLERANCE, PRECISE_TOLERANCE = 1e-16, 1e-32
Array = np.ndarray  # of floats, of quadruple precision, or of heyoka's expressions


class Units(NamedTuple):
    """Of length [m], time [s] and mass [kg]: powers of two near the system's own."""

    length: float
    time: float
    mass: float

    @classmethod
    def of(cls, system: ba.System, state: ba.State) -> "Units":
        """Return the units in which a system's first distance, reduced mass and G (m1 + m2) are of order one."""
        position, gms = state.si.position, [body.si.gm for body in system.bodies]
        length = _power_of_two(float(np.linalg.norm(position[1] - position[0])))
        masses = [body.si.mass for body in system.bodies[:2]]
        mass = _power_of_two(masses[0] * masses[1] / sum(masses))
        return cls(length, _power_of_two(float(np.sqrt(length**3 / sum(gms)))), mass)


class Start(NamedTuple):
    """A system and its start in those units and in quadruple precision, primary first."""

    m: Array
    gm: Array
    J: Array
    v: Array
    Omega: Array
    x: Array
    R: Array

    @classmethod
    def of(cls, system: ba.System, state: ba.State, units: Units) -> "Start":
        """Return a start; attitudes are rotations to the last digit."""
        length, time, mass = units
        position, velocity, attitude, spin = state.si
        R = attitude.astype(REAL)
        three, half = REAL(3.0), REAL(0.5)
        for _ in range(2):  # Newton's iteration for the nearest rotation
            R = np.array([half * r @ (three * np.eye(3).astype(REAL) - r.T @ r) for r in R])
        bodies = [body.si for body in system.bodies]
        return cls(
            np.array([body.mass / mass for body in bodies]).astype(REAL),
            np.array([body.gm / length**3 * time**2 for body in bodies]).astype(REAL),
            np.array([body.moments / (mass * length**2) for body in bodies]).astype(REAL),
            (velocity / (length / time)).astype(REAL),
            (spin * time).astype(REAL),
            (position / length).astype(REAL),
            R,
        )


def _power_of_two(value: float) -> float:
    return float(2.0 ** np.round(np.log2(value)))


def numbers(values: Array) -> Array:
    """Return numbers of quadruple precision as expressions."""
    return np.array([hy.expression(value) for value in np.ravel(values)], dtype=object).reshape(np.shape(values))


def variables(name: str, *shape: int) -> Array:
    """Return an array of variables."""
    count = int(np.prod(shape))
    return np.array([hy.make_vars(f"{name}_{k}") for k in range(count)], dtype=object).reshape(shape)


def gradient(function: Any, *arrays: Array) -> list[Array]:
    """Return the derivatives of an expression by the elements of arrays of variables, in their shapes."""
    flat = [variable for array in arrays for variable in np.ravel(array)]
    values = hy.diff_tensors([function], diff_args=flat, diff_order=1).get_derivatives(1)
    derivatives, result = [value for _, value in values], []
    for array in arrays:
        part, derivatives = derivatives[: array.size], derivatives[array.size :]
        result.append(np.array(part, dtype=object).reshape(array.shape))
    return result


def integrate(equations: Sequence[tuple[Any, Any]], y: Array, end: Any, *, precise: bool) -> Array:
    """Return the state at a time: the same equations from the same start, in quadruple or in double precision."""
    if np.finfo(np.longdouble).eps > 1e-30 and not hasattr(hy, "real128"):
        raise RuntimeError("this heyoka has no quadruple precision: expected one with real128, as its Linux wheels are")
    kind = REAL if precise else float
    tolerance = kind(PRECISE_TOLERANCE if precise else TOLERANCE)
    integrator = hy.taylor_adaptive(
        list(equations), y.astype(kind), tol=tolerance, compact_mode=True, high_accuracy=True, fp_type=kind
    )
    outcome = integrator.propagate_until(kind(end))[0]
    if outcome != hy.taylor_outcome.time_limit:
        raise RuntimeError(f"heyoka: expected to reach t = {end}, got {outcome}: a shorter arc may help")
    return integrator.state.astype(REAL)


def in_si(at: Snapshot, units: Units) -> Snapshot:
    """Return a snapshot in SI."""
    speed, rate = REAL(units.length / units.time), REAL(1 / units.time)
    return Snapshot(at.v * speed, at.Omega * rate, at.x * REAL(units.length), at.R)


def floats(at: Snapshot) -> Snapshot:
    """Return a snapshot of quadruple precision rounded to double."""
    return Snapshot(*(array.astype(float) for array in at))
