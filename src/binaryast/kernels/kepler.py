"""Kepler motion of a relative position over any time, by universal variables: elliptic, parabolic or hyperbolic.

With s' = 1/r, beta = 2 GM/r - v^2, eta = x.v and zeta = GM - beta r at the start, and Stumpff's functions G_k(s) of
beta, h = r s + eta G2 + zeta G3 is Kepler's equation (E. L. Stiefel, G. Scheifele, Linear and Regular Celestial
Mechanics, 1971).
"""

from math import floor, inf, nan, pi, sqrt

from numba import types

from binaryast.kernels.jit import ARRAY, Array, Vector, jit
from binaryast.kernels.so3 import dot

MOST_ITERATIONS = 200
NEAR = 1e-4  # the correction of s, relative, from which three terms of Taylor's series lead to the end
SHORT = 0.3  # of beta s^2, for the series

Four = tuple[float, float, float, float]


@jit()
def stumpff(beta: float, s: float) -> Four:
    """Return G0 .. G3: s^k times Stumpff's c_k of beta s^2; halved until its series is short, and doubled again."""
    halvings = 0
    while abs(beta) * s * s > SHORT and halvings < 64:
        s *= 0.5
        halvings += 1
    z = beta * s * s
    c3 = 1.0 - z / 42.0 * (1.0 - z / 72.0 * (1.0 - z / 110.0 * (1.0 - z / 156.0 * (1.0 - z / 210.0))))
    c3 = (1.0 - z / 20.0 * c3) / 6.0
    c2 = 1.0 - z / 30.0 * (1.0 - z / 56.0 * (1.0 - z / 90.0 * (1.0 - z / 132.0 * (1.0 - z / 182.0))))
    c2 = (1.0 - z / 12.0 * c2) / 2.0
    g2, g3 = s * s * c2, s * s * s * c3
    g0, g1 = 1.0 - beta * g2, s - beta * g3
    for _ in range(halvings):
        g0, g1, g2, g3, s = 1.0 - 2.0 * beta * g1 * g1, 2.0 * g0 * g1, 2.0 * g1 * g1, 2.0 * (g3 + g1 * g2), 2.0 * s
    return g0, g1, g2, g3


@jit()
def drift(x: Vector, v: Vector, gm: float, h: float) -> tuple[Vector, Vector]:
    """Return x(h) - x and v(h) - v, without cancellation; not numbers where x, v or h are none.

    Backwards in time is forwards with the other velocity. Kepler's equation grows with s, so it has one solution, which
    is kept between bounds; where the iteration would leave them, or is slow, it goes to their middle.
    """
    sign = -1.0 if h < 0.0 else 1.0
    h = sign * h
    r = sqrt(dot(x, x))
    eta = sign * dot(x, v)
    beta = 2.0 * gm / r - dot(v, v)
    zeta = gm - beta * r
    if beta > 0.0 and beta * beta * beta * h * h > 40.0 * gm * gm:  # about a revolution: whole ones lead nowhere
        period = 2.0 * pi * gm / (beta * sqrt(beta))
        h -= floor(h / period) * period
    u, k = h / r, 0.5 * eta / r
    s = u * (1.0 + u * (-k + u * (2.0 * k * k - zeta / (6.0 * r))))  # the reversed series of Kepler's equation
    if beta > 0.0 and beta * beta * beta * h * h > gm * gm:  # by more than a radian of mean anomaly
        s = h * beta / gm
    if not s > 0.0:
        s = u
    low, high, last = 0.0, inf, inf
    for _ in range(MOST_ITERATIONS):
        g0, g1, g2, g3 = stumpff(beta, s)
        f = r * s + eta * g2 + zeta * g3 - h
        if f <= 0.0:
            low = s
        else:  # also where it is beyond all numbers
            high = s
        f1 = r + eta * g1 + zeta * g2  # the distance there
        f2 = eta * g0 + zeta * g1
        f3 = zeta * g0 - beta * eta * g1
        newton = -f / f1
        d = -f / (f1 + 0.5 * newton * f2)
        d = -f / (f1 + d * (0.5 * f2 + d * f3 / 6.0))  # of fourth order, near the end
        if not abs(d - newton) <= 0.5 * abs(newton):
            d = newton
        if abs(d) <= NEAR * s:
            g3 += d * (g2 + 0.5 * d * (g1 + d / 3.0 * g0))
            g2 += d * (g1 + 0.5 * d * (g0 - beta * d / 3.0 * g1))
            g1 += d * (g0 - 0.5 * beta * d * (g1 + d / 3.0 * g0))
            distance = r + eta * g1 + zeta * g2
            a, b = -gm * g2 / r, sign * (h - gm * g3)  # f - 1 and g
            c, e = -sign * gm * g1 / (r * distance), -gm * g2 / distance  # f' and g' - 1
            return (
                (a * x[0] + b * v[0], a * x[1] + b * v[1], a * x[2] + b * v[2]),
                (c * x[0] + e * v[0], c * x[1] + e * v[1], c * x[2] + e * v[2]),
            )
        s += d
        if high < inf and not (low < s < high and abs(d) < 0.5 * last):
            d = 0.5 * (high - low)
            s = low + d
        last = abs(d)
    return (nan, nan, nan), (nan, nan, nan)


@jit(types.UniTuple(types.float64, 3)(ARRAY, ARRAY, types.float64, types.float64))
def moved(x: Array, v: Array, gm: float, h: float) -> Vector:
    """Return x(h) - x."""
    return drift((x[0], x[1], x[2]), (v[0], v[1], v[2]), gm, h)[0]
