"""What acts from outside on bodies that are somewhere: the compiled functions, called in turn, and their sums."""

from numba import types

from binaryast.kernels.external.arguments import External
from binaryast.kernels.jit import EXTERNAL_POTENTIAL, FORCE, Array, Matrix, Vector, jit
from binaryast.kernels.pointers import WORDS, reader
from binaryast.kernels.so3 import cross, dot, rotate, weighted

external_potential_at = reader(types.FunctionType(EXTERNAL_POTENTIAL))
force_at = reader(types.FunctionType(FORCE))


@jit()
def put_row(rows: Array, i: int, v: Vector) -> None:
    """Put a vector into a row."""
    rows[i, 0], rows[i, 1], rows[i, 2] = v


@jit()
def row_at(rows: Array, i: int) -> Vector:
    """Return a row."""
    return rows[i, 0], rows[i, 1], rows[i, 2]


@jit()
def add_to_row(rows: Array, i: int, scale: float, v: Vector) -> None:
    """Add to a row."""
    rows[i, 0] += scale * v[0]
    rows[i, 1] += scale * v[1]
    rows[i, 2] += scale * v[2]


@jit()
def put_place(external: External, i: int, x: Vector, r: Matrix) -> None:
    """Say where a body is."""
    put_row(external.x, i, x)
    R = external.R
    R[i, 0, 0], R[i, 0, 1], R[i, 0, 2], R[i, 1, 0], R[i, 1, 1], R[i, 1, 2], R[i, 2, 0], R[i, 2, 1], R[i, 2, 2] = r


@jit()
def matrix_at_row(R: Array, i: int) -> Matrix:
    """Return one of several matrices."""
    return R[i, 0, 0], R[i, 0, 1], R[i, 0, 2], R[i, 1, 0], R[i, 1, 1], R[i, 1, 2], R[i, 2, 0], R[i, 2, 1], R[i, 2, 2]


@jit()
def spin_of(momentum: Vector, inverse: Vector) -> Vector:
    """Return Omega of Pi."""
    return momentum[0] * inverse[0], momentum[1] * inverse[1], momentum[2] * inverse[2]


@jit()
def put_rates(external: External, i: int, v: Vector, spin: Vector) -> None:
    """Say how a body moves."""
    put_row(external.v, i, v)
    put_row(external.Omega, i, spin)


@jit()
def clear(external: External) -> None:
    """Take all forces and torques away."""
    for i in range(external.F.shape[0]):
        put_row(external.F, i, (0.0, 0.0, 0.0))
        put_row(external.N, i, (0.0, 0.0, 0.0))


@jit()
def apply_potentials(external: External, t: float) -> tuple[float, float]:
    """Put the forces and torques of all potentials into ``F`` and ``N``; return U and dU/dt."""
    clear(external)
    u, rate = 0.0, 0.0
    for k in range(external.potentials.size // WORDS):
        p = external.parameters[external.begins[k] : external.begins[k + 1]]
        of_one, rate_of_one = external_potential_at(external.potentials, k)(
            p, t, external.x, external.R, external.F, external.N
        )
        u += of_one
        rate += rate_of_one
    return u, rate


@jit()
def apply_forces(external: External, t: float) -> None:
    """Put all forces and their torques, other than those of potentials, into ``F`` and ``N``."""
    clear(external)
    first = external.potentials.size // WORDS
    for k in range(external.forces.size // WORDS):
        p = external.parameters[external.begins[first + k] : external.begins[first + k + 1]]
        force_at(external.forces, k)(p, t, external.x, external.v, external.R, external.Omega, external.F, external.N)


@jit()
def force_of_all(external: External) -> Vector:
    """Return the sum of ``F``."""
    total = 0.0, 0.0, 0.0
    for i in range(external.F.shape[0]):
        total = weighted(total, external.counts[i], row_at(external.F, i))
    return total


@jit()
def torque_of_all(external: External) -> Vector:
    """Return the torque about the origin, inertial: the sum of x_i x F_i + R_i N_i."""
    total = 0.0, 0.0, 0.0
    for i in range(external.F.shape[0]):
        of_force = cross(row_at(external.x, i), row_at(external.F, i))
        own = rotate(matrix_at_row(external.R, i), row_at(external.N, i))
        total = weighted(weighted(total, external.counts[i], of_force), external.counts[i], own)
    return total


@jit()
def power_of_all(external: External) -> float:
    """Return the sum of F_i.v_i + N_i.Omega_i."""
    power = 0.0
    for i in range(external.F.shape[0]):
        power += external.counts[i] * dot(row_at(external.F, i), row_at(external.v, i))
        power += external.counts[i] * dot(row_at(external.N, i), row_at(external.Omega, i))
    return power
