"""The free rotation of a rigid body, exactly: its turn F over a time h from its angular momentum P alone.

Euler's equations P' = P x J^-1 P have three elliptic functions as their solution. Here they are S, C, D with

    S' = C D,  C' = -a S D,  D' = -b S C,  S(0) = 0,  C(0) = D(0) = 1,

sn, cn and dn made symmetric (E. T. Whittaker, Analytical Dynamics, section 69, has the solution): with e1 = 1/I3 - 1/I2
and so on, cyclic, and g1 = -e2 e3 P1^2 and so on, a = g3 - g2 and b = g1 - g2 are constants of the motion, and

    P1(t) = (P1 C + e1 P2 P3 S D)/d,  P2(t) = (P2 C D + e2 P3 P1 S)/d,  P3(t) = (P3 D + e3 P1 P2 S C)/d

with d = 1 + g2 S^2. Nothing in this is singular, whichever moment is the middle one and however near to each other they
are. The turn takes P(h) back to P(0), which leaves one angle open: that about an axis k with P_k far from zero,

    psi = h L/I3 + w times the integral of 1/(L + |P3|),  w = P1^2 e2 - P2^2 e1,  L = |P|,

of the turn B(P(0))^-1 Rot(psi) B(P(h)), B(P) being the least rotation that takes P onto that axis, here the third. All
is counted from the middle of h, about which the odd parts of P and the nodes of the quadrature are pairs.
"""

from math import cos, sin, sqrt

from binaryast.kernels.jit import Quaternion, Vector, jit

LONGEST = 0.45  # of h sqrt(max |g|) in one piece: series and quadrature then leave 1e-15
MOST_PIECES = 1e5
# Gauss and Legendre's rule of eight nodes, those above zero
NODES = (0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363)
WEIGHTS = (0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763)

Series = tuple[float, float, float, float, float, float]


@jit()
def pieces(p: Vector, inverse: Vector, h: float) -> int:
    """Return into how many pieces h has to be cut; 0 where it is far too long, or something is not a number."""
    e1, e2, e3 = inverse[2] - inverse[1], inverse[0] - inverse[2], inverse[1] - inverse[0]
    g1, g2, g3 = abs(e2 * e3) * p[0] * p[0], abs(e3 * e1) * p[1] * p[1], abs(e1 * e2) * p[2] * p[2]
    count = abs(h) * sqrt(max(g1, g2, g3)) * (1.0 / LONGEST)
    return 1 + int(count) if count < MOST_PIECES else 0


@jit()
def sine_series(a: float, b: float) -> Series:
    """Return the coefficients of t^2 .. t^12 in S(t)/t."""
    p, m = a + b, a * b
    p2, m2 = p * p, m * m
    return (
        -p / 6.0,
        (p2 + 12.0 * m) / 120.0,
        -p * (p2 + 132.0 * m) / 5040.0,
        (p2 * (p2 + 1224.0 * m) + 3024.0 * m2) / 362880.0,
        -p * (p2 * (p2 + 11064.0 * m) + 132624.0 * m2) / 39916800.0,
        (p2 * (p2 * (p2 + 99636.0 * m) + 4095792.0 * m2) + 4390848.0 * m * m2) / 6227020800.0,
    )


@jit()
def sine(series: Series, t: float) -> float:
    """Return S(t) for a short time."""
    c1, c2, c3, c4, c5, c6 = series
    z = t * t
    return t * (1.0 + z * (c1 + z * (c2 + z * (c3 + z * (c4 + z * (c5 + z * c6))))))


@jit()
def functions_of_twice(a: float, b: float, s: float) -> Vector:
    """Return S, C, D at twice the time at which S is s."""
    q = s * s
    k = a * b * q * q
    inverse = 1.0 / (1.0 - k)
    return (
        2.0 * s * sqrt((1.0 - a * q) * (1.0 - b * q)) * inverse,
        (1.0 - 2.0 * a * q + k) * inverse,
        (1.0 - 2.0 * b * q + k) * inverse,
    )


@jit()
def integrand(a: float, b: float, g2: float, s: float, length: float, p3: float, y2: float) -> float:
    """Return half of 1/(L + |P3|) at two times as far before as after that of P3 > 0 and g2; S is s half-way to each.

    With X = L d + P3 D and Y = e3 P1 P2 S C, y2 = (e3 P1 P2)^2, that is d X/(X^2 - Y^2); the formulas of twice the
    time are put in, their denominators in front.
    """
    q = s * s
    k = a * b * q * q
    n = 1.0 - k
    square = 4.0 * q * (1.0 - a * q) * (1.0 - b * q)  # S^2 n^2
    d = n * n + g2 * square
    x = length * d + p3 * n * (1.0 - 2.0 * b * q + k)
    return d * x / (x * x - y2 * square * (n * n - a * square))


@jit()
def turn_about_third(p1: float, p2: float, p3: float, i1: float, i2: float, i3: float, h: float) -> Quaternion:
    """Return the quaternion of F where P3 is the largest; i1, i2, i3 are 1/I."""
    length = sqrt(p1 * p1 + p2 * p2 + p3 * p3)
    sign = 1.0 if p3 > 0.0 else -1.0
    e1, e2, e3 = i3 - i2, i1 - i3, i2 - i1
    g2 = -e3 * e1 * p2 * p2
    a, b = -e1 * e2 * p3 * p3 - g2, -e2 * e3 * p1 * p1 - g2
    series = sine_series(a, b)
    S, C, D = functions_of_twice(a, b, sine(series, 0.25 * h))

    # P in the middle of h, and from it P(h) - P(0)
    r = 1.0 / (1.0 + g2 * S * S)
    m1 = (p1 * C + e1 * p2 * p3 * S * D) * r
    m2 = (p2 * C * D + e2 * p3 * p1 * S) * r
    m3 = (p3 * D + e3 * p1 * p2 * S * C) * r
    g2 = -e3 * e1 * m2 * m2
    r = 2.0 * S / (1.0 + g2 * S * S)
    d1, d2, d3 = e1 * m2 * m3 * D * r, e2 * m3 * m1 * r, e3 * m1 * m2 * C * r

    # half of psi
    w = p1 * p1 * e2 - p2 * p2 * e1
    z, y2 = sign * m3, (e3 * m1 * m2) ** 2
    integral = 0.0
    for j in range(4):
        integral += WEIGHTS[j] * integrand(a, b, g2, sine(series, 0.25 * h * NODES[j]), length, z, y2)
    half = 0.5 * h * (length * i3 + w * integral)
    s, c = sign * sin(half), cos(half)

    # B(P(0))^-1 Rot(psi) B(P(h)): B is (u1, u2, 0, w0) over its length, and v that of P(h); no difference of near ones
    w0, u1, u2 = length + sign * p3, sign * p2, -sign * p1
    wh, v1, v2 = w0 + sign * d3, u1 + sign * d2, u2 - sign * d1
    n = 0.5 / (length * sqrt(w0 * wh))
    product, both = w0 * wh, u1 * v1 + u2 * v2
    return (
        n * (c * (w0 * (sign * d2) - sign * d3 * u1) - s * (w0 * v2 + u2 * wh)),
        n * (c * (-w0 * (sign * d1) - sign * d3 * u2) + s * (w0 * v1 + u1 * wh)),
        n * (c * (p2 * d1 - p1 * d2) + s * (product - both)),
        n * (c * (product + both) + s * (u2 * v1 - u1 * v2)),
    )


@jit()
def free_turn(p: Vector, inverse: Vector, h: float) -> Quaternion:
    """Return the quaternion of the turn F over a time of one piece: R(h) = R(0) F, P(h) = F^T P(0)."""
    p1, p2, p3 = p
    i1, i2, i3 = inverse
    s1, s2, s3 = p1 * p1, p2 * p2, p3 * p3
    if s1 + s2 + s3 == 0.0:
        return 0.0, 0.0, 0.0, 1.0
    if s3 >= s1 and s3 >= s2:
        return turn_about_third(p1, p2, p3, i1, i2, i3, h)
    if s1 >= s2:
        y, z, x, w = turn_about_third(p2, p3, p1, i2, i3, i1, h)
        return x, y, z, w
    z, x, y, w = turn_about_third(p3, p1, p2, i3, i1, i2, h)
    return x, y, z, w
