"""Carlson's symmetric elliptic integrals R_F and R_D by duplication: DLMF 19.36, and Numer. Algorithms 10 (1995) 13-26.

Each duplication brings the arguments four times nearer to each other; what is left then is a series about their mean.
"""

from math import sqrt

from binaryast.kernels.jit import jit

NEAR = 0.01  # relative spread of the arguments at which the series, cut after degree 7, leaves less than 1e-16


@jit()
def series_of_rd(x: float, y: float, z: float) -> float:
    """Return R_D(x, y, z) of arguments that are nearly equal, DLMF (19.36.2)."""
    mean = (x + y + 3.0 * z) * (1 / 5)
    inverse = 1.0 / mean
    u, v = 1.0 - x * inverse, 1.0 - y * inverse
    w = -(u + v) * (1 / 3)
    uv, ww = u * v, w * w
    e2, e3, e4, e5 = uv - 6.0 * ww, (3.0 * uv - 8.0 * ww) * w, 3.0 * (uv - ww) * ww, uv * ww * w
    sums = 1.0 - (3 / 14) * e2 + (1 / 6) * e3 + (9 / 88) * e2 * e2 - (3 / 22) * e4 - (9 / 52) * e2 * e3
    sums += (3 / 26) * e5 - (1 / 16) * e2 * e2 * e2 + (3 / 40) * e3 * e3 + (3 / 20) * e2 * e4
    sums += (45 / 272) * e2 * e2 * e3 - (9 / 68) * (e3 * e4 + e2 * e5)
    return sums * inverse * sqrt(inverse)


@jit()
def rf_and_rd(x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Return R_F(x, y, z), R_D(y, z, x), R_D(z, x, y) and R_D(x, y, z): they share their duplications.

    All three arguments are positive.
    """
    x0, y0, z0 = x, y, z
    of_x = of_y = of_z = 0.0
    scale = 1.0
    while max(x, y, z) - min(x, y, z) > NEAR * min(x, y, z):
        a, b, c = sqrt(x), sqrt(y), sqrt(z)
        shift = a * b + b * c + c * a  # (19.26.18), (19.26.20)
        of_x += scale / (a * (x + shift))
        of_y += scale / (b * (y + shift))
        of_z += scale / (c * (z + shift))
        scale *= 0.25
        x, y, z = 0.25 * (x + shift), 0.25 * (y + shift), 0.25 * (z + shift)
    rx = scale * series_of_rd(y, z, x) + 3.0 * of_x
    ry = scale * series_of_rd(z, x, y) + 3.0 * of_y
    rz = scale * series_of_rd(x, y, z) + 3.0 * of_z
    return (x0 * rx + y0 * ry + z0 * rz) * (1 / 3), rx, ry, rz  # (19.21.9)
