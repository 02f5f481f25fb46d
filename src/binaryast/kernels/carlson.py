"""Carlson's symmetric elliptic integrals R_F and R_D by duplication: DLMF 19.36, and Numer. Algorithms 10 (1995) 13-26.

Each duplication brings the arguments four times nearer to each other; what is left then is a series about their mean.
"""

from math import sqrt

from binaryast.kernels.jit import jit

NEAR = 0.01  # relative spread of the arguments at which the series, cut after degree 7, leaves less than 1e-16


@jit()
def series_of_rf(x: float, y: float, z: float) -> float:
    """Return R_F(x, y, z) of arguments that are nearly equal, DLMF (19.36.1)."""
    mean = (x + y + z) / 3.0
    u, v = 1.0 - x / mean, 1.0 - y / mean
    w = -u - v
    e2, e3 = u * v - w * w, u * v * w
    sums = 1.0 - e2 / 10.0 + e3 / 14.0 + e2 * e2 / 24.0 - 3.0 * e2 * e3 / 44.0
    sums += -5.0 * e2 * e2 * e2 / 208.0 + 3.0 * e3 * e3 / 104.0 + e2 * e2 * e3 / 16.0
    return sums / sqrt(mean)


@jit()
def series_of_rd(x: float, y: float, z: float) -> float:
    """Return R_D(x, y, z) of arguments that are nearly equal, DLMF (19.36.2)."""
    mean = (x + y + 3.0 * z) / 5.0
    u, v = 1.0 - x / mean, 1.0 - y / mean
    w = -(u + v) / 3.0
    uv, ww = u * v, w * w
    e2, e3, e4, e5 = uv - 6.0 * ww, (3.0 * uv - 8.0 * ww) * w, 3.0 * (uv - ww) * ww, uv * ww * w
    sums = 1.0 - 3.0 * e2 / 14.0 + e3 / 6.0 + 9.0 * e2 * e2 / 88.0 - 3.0 * e4 / 22.0 - 9.0 * e2 * e3 / 52.0
    sums += 3.0 * e5 / 26.0 - e2 * e2 * e2 / 16.0 + 3.0 * e3 * e3 / 40.0 + 3.0 * e2 * e4 / 20.0
    sums += 45.0 * e2 * e2 * e3 / 272.0 - 9.0 * (e3 * e4 + e2 * e5) / 68.0
    return sums / (mean * sqrt(mean))


@jit()
def rf_and_rd(x: float, y: float, z: float) -> tuple[float, float, float, float]:
    """Return R_F(x, y, z), R_D(y, z, x), R_D(z, x, y) and R_D(x, y, z): they share their duplications.

    All three arguments are positive.
    """
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
    return (
        series_of_rf(x, y, z),
        scale * series_of_rd(y, z, x) + 3.0 * of_x,
        scale * series_of_rd(z, x, y) + 3.0 * of_y,
        scale * series_of_rd(x, y, z) + 3.0 * of_z,
    )
