"""Bodies on which something acts from outside: their kicks, what is exerted, what else moves, what is watched.

Forces that depend on the motion kick by the midpoint rule, as in ``pair/disturbed.py``.
"""

from numba import types

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.bodies.layout import (
    INVERSE,
    IS_POINT,
    MASS,
    attitude_of,
    body_constants,
    gradient_of,
    momentum_of,
    potential_of,
    remainder_of,
    size_of,
    torque_of,
    velocity_of,
)
from binaryast.kernels.bodies.measure import measured
from binaryast.kernels.bodies.stages import add, exert, increase, kick_alone
from binaryast.kernels.external.action import (
    apply_forces,
    apply_potentials,
    clear,
    force_of_all,
    power_of_all,
    put_place,
    put_rates,
    row_at,
    spin_of,
    torque_of_all,
)
from binaryast.kernels.external.arguments import EXTERNAL, External
from binaryast.kernels.external.changes import let_pass, put_outer, sum_up
from binaryast.kernels.external.layout import ANGULAR, LINEAR, TIME, WORK
from binaryast.kernels.jit import ARRAY, MEASURE, PAIR_POINTERS, Array, Measures, jit
from binaryast.kernels.so3 import weighted


@jit()
def put_places(external: External, state: Array, n: int) -> None:
    """Say where the bodies are."""
    for i in range(n):
        put_place(external, i, vector_at(state, 3 * i), matrix_at(state, attitude_of(n) + 4 * i))


@jit(types.void(ARRAY, ARRAY, EXTERNAL, types.float64))
def put_motion(state: Array, constants: Array, external: External, h: float) -> None:
    """Say how the bodies move after h of everything, what is in ``F`` and ``N`` included."""
    n = int(constants[0])
    for i in range(n):
        body = body_constants(i)
        force = weighted(row_at(external.F, i), -1.0, vector_at(state, gradient_of(n) + 3 * i))
        torque = weighted(row_at(external.N, i), 1.0, vector_at(state, torque_of(n) + 3 * i))
        v = weighted(vector_at(state, velocity_of(n) + 3 * i), h / constants[body + MASS], force)
        p = weighted(vector_at(state, momentum_of(n) + 3 * i), h, torque)
        put_rates(external, i, v, spin_of(p, vector_at(constants, body + INVERSE)))


@jit(types.int64(ARRAY, ARRAY, EXTERNAL, types.float64))
def push(state: Array, constants: Array, external: External, h: float) -> int:
    """Add to the momenta what everything does in a time h, and sum up what came from outside."""
    n = int(constants[0])
    base = size_of(n)
    if external.forces.size == 0:
        sum_up(state, base, h, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        return kick_alone(state, constants, h)
    put_places(external, state, n)
    clear(external)
    put_motion(state, constants, external, 0.0)
    power, sign = 0.0, 1.0
    for _ in range(2):  # with the motion at the beginning, then with that at the middle of the kick
        apply_forces(external, state[base + TIME])
        put_motion(state, constants, external, 0.0)
        power += sign * power_of_all(external) / 3.0
        put_motion(state, constants, external, 0.5 * h)
        power -= sign * power_of_all(external) / 3.0
        sign = -1.0
    power += power_of_all(external)
    sum_up(state, base, h, power, force_of_all(external), torque_of_all(external))
    for i in range(n):
        body = body_constants(i)
        increase(state, velocity_of(n) + 3 * i, remainder_of(n), h / constants[body + MASS], row_at(external.F, i))
        if not constants[body + IS_POINT]:
            increase(state, momentum_of(n) + 3 * i, remainder_of(n), h, row_at(external.N, i))
    return kick_alone(state, constants, h)


@jit(types.void(ARRAY, ARRAY, PAIR_POINTERS, ARRAY, EXTERNAL))
def exert_all(state: Array, constants: Array, potentials: Array, parameters: Array, external: External) -> None:
    """Put what the bodies and the potentials from outside exert into the state."""
    exert(state, constants, potentials, parameters)
    n = int(constants[0])
    base = size_of(n)
    put_places(external, state, n)
    u, rate = apply_potentials(external, state[base + TIME])
    put_outer(state, base, rate, force_of_all(external), torque_of_all(external))
    state[potential_of(n)] += u
    for i in range(n):
        add(state, gradient_of(n) + 3 * i, -1.0, row_at(external.F, i))
        add(state, torque_of(n) + 3 * i, 1.0, row_at(external.N, i))


@jit()
def elapse(state: Array, constants: Array, h: float) -> None:
    """Let the time pass."""
    let_pass(state, size_of(int(constants[0])), h)


@jit(MEASURE)
def measure(state: Array, constants: Array) -> Measures:
    """Return the same as for bodies alone, less what came from outside."""
    energy, l1, l2, l3, p1, p2, p3, rotation_error, separation = measured(state, constants)
    base = size_of(int(constants[0]))
    l, p = vector_at(state, base + ANGULAR), vector_at(state, base + LINEAR)
    return (
        energy - state[base + WORK],
        l1 - l[0],
        l2 - l[1],
        l3 - l[2],
        p1 - p[0],
        p2 - p[1],
        p3 - p[2],
        rotation_error,
        separation,
    )
