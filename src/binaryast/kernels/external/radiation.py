"""What sunlight does: the pressure on a ball or a plate, and the mean torques of YORP and BYORP."""

from math import sqrt

from binaryast.kernels.arrays import vector_at
from binaryast.kernels.external.action import add_to_row, matrix_at_row, row_at
from binaryast.kernels.external.paths import place_at
from binaryast.kernels.jit import FORCE, Array, jit
from binaryast.kernels.so3 import cross, dot, rotate, rotate_back, weighted

# Parameters of `pressure`: which body; the pressure times the square of the distance [N]; area; of a ball, its
# coefficient, else a negative number; of a plate what it reflects like a mirror and evenly, its normal and where it is,
# in the body's frame; then the path of the Sun.
BODY, STRENGTH, AREA, COEFFICIENT, SPECULAR, DIFFUSE, NORMAL, POINT = 0, 1, 2, 3, 4, 5, 6, 9
PATH = 12


@jit(FORCE)
def pressure(p: Array, t: float, x: Array, v: Array, R: Array, Omega: Array, F: Array, N: Array) -> None:
    """Add the pressure of sunlight; nothing stands in its way."""
    i = int(p[BODY])
    s, _ = place_at(p, PATH, t)
    to_sun = weighted(s, -1.0, row_at(x, i))
    square = dot(to_sun, to_sun)
    distance = sqrt(square)
    to_sun = to_sun[0] / distance, to_sun[1] / distance, to_sun[2] / distance
    full = p[STRENGTH] / square * p[AREA]
    if p[COEFFICIENT] >= 0.0:
        add_to_row(F, i, -full * p[COEFFICIENT], to_sun)
        return
    attitude = matrix_at_row(R, i)
    normal = rotate(attitude, vector_at(p, NORMAL))
    cosine = dot(normal, to_sun)
    lit = full * abs(cosine)
    along = -2.0 * (p[SPECULAR] * cosine + (p[DIFFUSE] / 3.0 if cosine >= 0.0 else -p[DIFFUSE] / 3.0))
    push = weighted((0.0, 0.0, 0.0), -(1.0 - p[SPECULAR]), to_sun)
    push = weighted(push, along, normal)
    add_to_row(F, i, lit, push)
    add_to_row(N, i, lit, cross(vector_at(p, POINT), rotate_back(attitude, push)))


@jit(FORCE)
def along_spin(p: Array, t: float, x: Array, v: Array, R: Array, Omega: Array, F: Array, N: Array) -> None:
    """Add a torque p[1] along the spin of body p[0]: YORP."""
    i = int(p[0])
    spin = row_at(Omega, i)
    size = sqrt(dot(spin, spin))
    if size > 0.0:
        add_to_row(N, i, p[1] / size, spin)


@jit(FORCE)
def along_orbit(p: Array, t: float, x: Array, v: Array, R: Array, Omega: Array, F: Array, N: Array) -> None:
    """Add a force p[2] on body p[0], along its way round body p[1] and across the line to it: BYORP."""
    i, j = int(p[0]), int(p[1])
    r = weighted(row_at(x, i), -1.0, row_at(x, j))
    moves = weighted(row_at(v, i), -1.0, row_at(v, j))
    across = weighted(moves, -dot(moves, r) / dot(r, r), r)
    size = sqrt(dot(across, across))
    if size > 0.0:
        add_to_row(F, i, p[2] / size, across)
