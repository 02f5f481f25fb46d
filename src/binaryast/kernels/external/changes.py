"""What is summed up while something acts from outside: the time, the work done and the momenta given."""

from binaryast.kernels.arrays import put_vector, vector_at
from binaryast.kernels.compensated import add, add_vector
from binaryast.kernels.external.layout import ANGULAR, FORCE, LINEAR, LOST, RATE, TIME, TORQUE, WORK
from binaryast.kernels.jit import Array, Vector, jit


@jit()
def increase(state: Array, base: int, at: int, scale: float, increment: Vector) -> Vector:
    """Add to one of the vectors that are sums over steps; return the sum."""
    v, rv = add_vector(vector_at(state, base + at), vector_at(state, base + LOST + at), scale, increment)
    put_vector(state, base + at, v)
    put_vector(state, base + LOST + at, rv)
    return v


@jit()
def increase_number(state: Array, base: int, at: int, increment: float) -> None:
    """Add to one of the numbers that are sums over steps."""
    state[base + at], state[base + LOST + at] = add(state[base + at], state[base + LOST + at], increment)


@jit()
def let_pass(state: Array, base: int, h: float) -> None:
    """Let a time pass."""
    increase_number(state, base, TIME, h)


@jit()
def put_outer(state: Array, base: int, rate: float, force: Vector, torque: Vector) -> None:
    """Keep what the potentials exert on all bodies together at this configuration."""
    state[base + RATE] = rate
    put_vector(state, base + FORCE, force)
    put_vector(state, base + TORQUE, torque)


@jit()
def sum_up(state: Array, base: int, h: float, power: float, force: Vector, torque: Vector) -> None:
    """Add what is done in a kick: by potentials, and with this power, force and torque by others."""
    increase_number(state, base, WORK, h * (state[base + RATE] + power))
    f, t = vector_at(state, base + FORCE), vector_at(state, base + TORQUE)
    increase(state, base, LINEAR, h, (f[0] + force[0], f[1] + force[1], f[2] + force[2]))
    increase(state, base, ANGULAR, h, (t[0] + torque[0], t[1] + torque[1], t[2] + torque[2]))
