"""A pair on which something acts from outside: its kicks, what is exerted, what else moves, what is watched.

Forces that depend on the motion, friction say, kick by the midpoint rule: first by half, to see with which velocities
and spins they act. So a kick by them is right to second order in their own size, and, where they are linear in the
velocities, to all orders in h beside them. Their power then changes during a kick as a polynomial of second degree in
time, whose mean is that in the middle and a third of (F(h/2) - F(0)).(v(h/2) - v(0)); without this third the work would
be of order 2, whatever the method's order.
"""

from collections.abc import Callable

from numba import types

from binaryast.kernels.arrays import matrix_at, vector_at
from binaryast.kernels.attraction import attract
from binaryast.kernels.compensated import add_vector
from binaryast.kernels.external.action import (
    apply_forces,
    apply_potentials,
    force_of_all,
    power_of_all,
    put_place,
    put_rates,
    row_at,
    spin_of,
    torque_of_all,
)
from binaryast.kernels.external.arguments import EXTERNAL, External
from binaryast.kernels.external.changes import increase, let_pass, put_outer, sum_up
from binaryast.kernels.external.layout import ANGULAR, CENTRE, FORCE, LINEAR, TIME, WORK
from binaryast.kernels.free_rotation import Attitude
from binaryast.kernels.jit import ARRAY, MEASURE, PAIR_POINTER, Array, Matrix, Measures, PairPotential, Vector, jit
from binaryast.kernels.pair.layout import (
    ATTITUDE_1,
    ATTITUDE_2,
    INVERSE_1,
    INVERSE_2,
    INVERSE_MASS,
    POSITION,
    REDUCED_MASS,
    SHARE_1,
    SHARE_2,
    STATE_SIZE,
)
from binaryast.kernels.pair.measure import measured
from binaryast.kernels.pair.stages import Exerted, Motion, Turning, put_exerted, spun_up
from binaryast.kernels.so3 import cross, dot, weighted

BASE = STATE_SIZE


@jit()
def put_places(external: External, x: Vector, r2: Matrix, r1: Matrix, centre: Vector, constants: Array) -> None:
    """Say where both bodies are: their distance is shared by their masses."""
    put_place(external, 0, weighted(centre, -constants[SHARE_1], x), r2)
    put_place(external, 1, weighted(centre, constants[SHARE_2], x), r1)


@jit()
def put_motion(external: External, v: Vector, drift: Vector, p2: Vector, p1: Vector, constants: Array) -> None:
    """Say how both bodies move, from relative velocity, velocity of the mass centre and angular momenta."""
    put_rates(external, 0, weighted(drift, -constants[SHARE_1], v), spin_of(p2, vector_at(constants, INVERSE_2)))
    put_rates(external, 1, weighted(drift, constants[SHARE_2], v), spin_of(p1, vector_at(constants, INVERSE_1)))


@jit()
def relative_force(external: External, constants: Array) -> Vector:
    """Return the force that would change x as those on the bodies do: m (F1/m1 - F2/m2)."""
    f2, f1 = row_at(external.F, 0), row_at(external.F, 1)
    to_1, to_2 = constants[SHARE_2], constants[SHARE_1]
    return to_1 * f1[0] - to_2 * f2[0], to_1 * f1[1] - to_2 * f2[1], to_1 * f1[2] - to_2 * f2[2]


@jit()
def exert(
    x: Vector,
    r2: Matrix,
    r1: Matrix,
    state: Array,
    constants: Array,
    potential: PairPotential,
    parameters: Array,
    external: External,
) -> Exerted:
    """Return what the bodies and the potentials from outside exert; the latter's sums go into the state."""
    u, gradient, torque_2, torque_1 = attract(x, r2, r1, potential, parameters)
    put_places(external, x, r2, r1, vector_at(state, BASE + CENTRE), constants)
    outer, rate = apply_potentials(external, state[BASE + TIME])
    put_outer(state, BASE, rate, force_of_all(external), torque_of_all(external))
    return (
        u + outer,
        weighted(gradient, -1.0, relative_force(external, constants)),
        weighted(torque_2, 1.0, row_at(external.N, 0)),
        weighted(torque_1, 1.0, row_at(external.N, 1)),
    )


@jit()
def kick(
    kicking: Callable[..., Vector],
    motion: Motion,
    turning: Turning,
    exerted: Exerted,
    state: Array,
    constants: Array,
    external: External,
    h: float,
) -> tuple[Vector, Vector, Attitude, Attitude]:
    """Return velocity and attitudes after everything has worked for h, and sum up what came from outside."""
    x, _, v, rv = motion
    a2, a1, r2, r1 = turning
    _, gradient, torque_2, torque_1 = exerted
    to_velocity = -h / constants[REDUCED_MASS]
    gradient = kicking(gradient, x, constants)
    if external.forces.size == 0:
        sum_up(state, BASE, h, 0.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    else:
        drift, outer = vector_at(state, BASE + LINEAR), vector_at(state, BASE + FORCE)
        drift = weighted((0.0, 0.0, 0.0), constants[INVERSE_MASS], drift)
        put_places(external, x, r2, r1, vector_at(state, BASE + CENTRE), constants)
        put_motion(external, v, drift, a2[2], a1[2], constants)
        power, sign = 0.0, 1.0
        for _ in range(2):  # with the motion at the beginning, then with that at the middle of the kick
            apply_forces(external, state[BASE + TIME])
            disturbed = weighted(gradient, -1.0, relative_force(external, constants))
            turns_2, turns_1 = (
                weighted(torque_2, 1.0, row_at(external.N, 0)),
                weighted(torque_1, 1.0, row_at(external.N, 1)),
            )
            force = force_of_all(external)
            put_motion(external, v, drift, a2[2], a1[2], constants)
            power += sign * power_of_all(external) / 3.0
            put_motion(
                external,
                weighted(v, 0.5 * to_velocity, disturbed),
                weighted(drift, 0.5 * h * constants[INVERSE_MASS], weighted(outer, 1.0, force)),
                weighted(a2[2], 0.5 * h, turns_2),
                weighted(a1[2], 0.5 * h, turns_1),
                constants,
            )
            power -= sign * power_of_all(external) / 3.0
            sign = -1.0
        power += power_of_all(external)
        sum_up(state, BASE, h, power, force, torque_of_all(external))
        gradient, torque_2, torque_1 = disturbed, turns_2, turns_1
    v, rv = add_vector(v, rv, to_velocity, gradient)
    return v, rv, spun_up(a2, h, torque_2), spun_up(a1, h, torque_1)


@jit()
def elapse(state: Array, constants: Array, h: float) -> None:
    """Let the time pass, and the mass centre move on."""
    let_pass(state, BASE, h)
    increase(state, BASE, CENTRE, h * constants[INVERSE_MASS], vector_at(state, BASE + LINEAR))


@jit(types.void(ARRAY, ARRAY, PAIR_POINTER, ARRAY, EXTERNAL))
def prepare(state: Array, constants: Array, potential: PairPotential, parameters: Array, external: External) -> None:
    """Fill in what is exerted at the motion in the state: a working state is complete after this."""
    x, r2, r1 = vector_at(state, POSITION), matrix_at(state, ATTITUDE_2), matrix_at(state, ATTITUDE_1)
    put_exerted(state, exert(x, r2, r1, state, constants, potential, parameters, external))


@jit(MEASURE)
def measure(state: Array, constants: Array) -> Measures:
    """Return the same as for a pair alone, less what came from outside, and about the origin."""
    energy, l1, l2, l3, _, _, _, rotation_error, separation = measured(state, constants)
    centre, momentum = vector_at(state, BASE + CENTRE), vector_at(state, BASE + LINEAR)
    given, orbit = vector_at(state, BASE + ANGULAR), cross(centre, momentum)
    energy += 0.5 * dot(momentum, momentum) * constants[INVERSE_MASS] - state[BASE + WORK]
    return (
        energy,
        l1 + orbit[0] - given[0],
        l2 + orbit[1] - given[1],
        l3 + orbit[2] - given[2],
        0.0,
        0.0,
        0.0,
        rotation_error,
        separation,
    )
