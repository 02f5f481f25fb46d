"""What a pair's potential exerts on the two bodies: force in inertial axes, torques in the bodies' own frames."""

from binaryast.kernels.jit import Array, Matrix, PairPotential, Vector, jit
from binaryast.kernels.so3 import cross, relative_attitude, rotate, rotate_back


@jit()
def attract(
    x_inertial: Vector, r2: Matrix, r1: Matrix, potential: PairPotential, parameters: Array
) -> tuple[float, Vector, Vector, Vector]:
    """Return U, dU/dx1 in inertial axes and the torque on each body in its own frame, the primary's first."""
    x = rotate_back(r2, x_inertial)  # X, (34)
    r = relative_attitude(r2, r1)  # R, (35)
    u, g1, g2, g3, m1, m2, m3 = potential(
        parameters, x[0], x[1], x[2], r[0], r[1], r[2], r[3], r[4], r[5], r[6], r[7], r[8]
    )
    xg = cross(x, (g1, g2, g3))
    n1, n2, n3 = rotate_back(r, (m1, m2, m3))
    return u, rotate(r2, (g1, g2, g3)), (xg[0] + m1, xg[1] + m2, xg[2] + m3), (-n1, -n2, -n3)
