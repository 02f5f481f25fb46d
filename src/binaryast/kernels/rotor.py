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

All this is plain Python on numbers of any kind: on symbols it writes out the compiled code (``free_rotation.py``), for
one body or for two side by side, which takes hardly longer.
"""

from typing import TypeAlias

from binaryast.kernels.lanes import Lanes, Number

Three: TypeAlias = tuple[Number, Number, Number]
Four: TypeAlias = tuple[Number, Number, Number, Number]

LONGEST = 0.45  # of h sqrt(max |g|) in one call: series and quadrature then leave 1e-15
LARGEST_TURN = 1.2  # of h Omega in one call: half of psi is then below pi/4, where sine and cosine have short series
# Gauss and Legendre's rule of eight nodes: those above zero, with their weights
NODES = (0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363)
WEIGHTS = (0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763)
SINE = (-1 / 6, 1 / 120, -1 / 5040, 1 / 362880, -1 / 39916800, 1 / 6227020800, -1 / 1307674368000)
COSINE = (-1 / 2, 1 / 24, -1 / 720, 1 / 40320, -1 / 3628800, 1 / 479001600, -1 / 87178291200, 1 / 20922789888000)


def series(z: Number, coefficients: tuple[Number, ...]) -> Number:
    """Return 1 + c1 z + c2 z^2 + .."""
    total = coefficients[-1]
    for c in (*reversed(coefficients[:-1]), 1.0):
        total = total * z + c
    return total


def of_elliptic_sine(a: Number, b: Number) -> tuple[Number, ...]:
    """Return the coefficients of t^2 .. t^12 in S(t)/t."""
    p, m = a + b, a * b
    p2, m2 = p * p, m * m
    return (
        -p * (1 / 6),
        (p2 + 12.0 * m) * (1 / 120),
        -p * (p2 + 132.0 * m) * (1 / 5040),
        (p2 * (p2 + 1224.0 * m) + 3024.0 * m2) * (1 / 362880),
        -p * (p2 * (p2 + 11064.0 * m) + 132624.0 * m2) * (1 / 39916800),
        (p2 * (p2 * (p2 + 99636.0 * m) + 4095792.0 * m2) + 4390848.0 * m * m2) * (1 / 6227020800),
    )


def integrand(a: Number, b: Number, g2: Number, s: Number, length: Number, p3: Number, y2: Number) -> Number:
    """Return half of 1/(L + |P3|) at two times as far before as after that of P3 > 0 and g2; S is s half-way to each.

    With X = L d + P3 D and Y = e3 P1 P2 S C, y2 = (e3 P1 P2)^2, that is d X/(X^2 - Y^2). S, C and D of twice the time
    have 1 - k as their denominator, which is brought to the front.
    """
    q = s * s
    k = a * b * q * q
    n = 1.0 - k
    square = 4.0 * q * (1.0 - a * q) * (1.0 - b * q)  # S^2 n^2
    d = n * n + g2 * square
    x = length * d + p3 * (n * (1.0 + k - 2.0 * b * q))
    return d * x / (x * x - y2 * (square * (n * n - a * square)))


def turn_about_third(lanes: Lanes, p: Three, inverse: Three, h: Number) -> Four:
    """Return the quaternion of F where P3 is the largest; ``inverse`` is 1/I."""
    p1, p2, p3 = p
    i1, i2, i3 = inverse
    length = lanes.sqrt(p1 * p1 + p2 * p2 + p3 * p3)
    sign = lanes.where_larger(p3, 0.0, 1.0, -1.0)
    e1, e2, e3 = i3 - i2, i1 - i3, i2 - i1
    g2 = -e3 * e1 * (p2 * p2)
    a, b = -e1 * e2 * (p3 * p3) - g2, -e2 * e3 * (p1 * p1) - g2

    # S, C and D of h/2 times their denominator n
    coefficients, quarter = of_elliptic_sine(a, b), 0.25 * h
    s = quarter * series(quarter * quarter, coefficients)
    q = s * s
    k = a * b * q * q
    n = 1.0 - k
    S, C, D = 2.0 * s * lanes.sqrt((1.0 - a * q) * (1.0 - b * q)), 1.0 + k - 2.0 * a * q, 1.0 + k - 2.0 * b * q

    # P in the middle of h, and from it P(h) - P(0)
    r = 1.0 / (n * n + g2 * S * S)
    m1 = (p1 * (C * n) + e1 * p2 * p3 * (S * D)) * r
    m2 = (p2 * (C * D) + e2 * p3 * p1 * (S * n)) * r
    m3 = (p3 * (D * n) + e3 * p1 * p2 * (S * C)) * r
    g2 = -e3 * e1 * (m2 * m2)
    r = 2.0 * S / (n * n + g2 * S * S)
    d1, d2, d3 = e1 * m2 * m3 * D * r, e2 * m3 * m1 * n * r, e3 * m1 * m2 * C * r

    # half of psi
    y = e3 * m1 * m2
    integral = 0.0
    for node, weight in zip(NODES, WEIGHTS, strict=True):
        t = node * quarter
        at_node = t * series(t * t, coefficients)
        integral = integral + weight * integrand(a, b, g2, at_node, length, sign * m3, y * y)
    w = p1 * p1 * e2 - p2 * p2 * e1
    half = 0.5 * h * (length * i3 + w * integral)
    z = half * half
    s, c = sign * half * series(z, SINE), series(z, COSINE)

    # B(P(0))^-1 Rot(psi) B(P(h)): B is (u1, u2, 0, w0) over its length, and v that of P(h); no difference of near ones
    w0, u1, u2 = length + sign * p3, sign * p2, -sign * p1
    wh, v1, v2 = w0 + sign * d3, u1 + sign * d2, u2 - sign * d1
    product, both = w0 * wh, u1 * v1 + u2 * v2
    scale = 0.5 / (length * lanes.sqrt(product))
    return (
        scale * (c * sign * (w0 * d2 - d3 * u1) - s * (w0 * v2 + u2 * wh)),
        scale * (c * sign * (-w0 * d1 - d3 * u2) + s * (w0 * v1 + u1 * wh)),
        scale * (c * (p2 * d1 - p1 * d2) + s * (product - both)),
        scale * (c * (product + both) + s * (u2 * v1 - u1 * v2)),
    )


def free_turn(lanes: Lanes, p: Three, inverse: Three, h: Number) -> Four:
    """Return the quaternion of the turn F over a time up to that of one call: R(h) = R(0) F, P(h) = F^T P(0).

    The axes are exchanged, cyclically, so that the third has the largest part of P; without spin there is no turn.
    """
    s1, s2, s3 = (part * part for part in p)
    larger = lanes.where_larger(s1, s2, s1, s2)

    def chosen(third: Number, first: Number, second: Number) -> Number:
        return lanes.where_larger(larger, s3, lanes.where_larger(s1, s2, first, second), third)

    def exchanged(v: Three) -> Three:
        return chosen(v[0], v[1], v[2]), chosen(v[1], v[2], v[0]), chosen(v[2], v[0], v[1])

    x, y, z, w = turn_about_third(lanes, exchanged(p), exchanged(inverse), h)
    back = chosen(x, z, y), chosen(y, x, z), chosen(z, y, x)
    spins = s1 + s2 + s3
    x, y, z = (lanes.where_larger(spins, 0.0, part, 0.0) for part in back)
    return x, y, z, lanes.where_larger(spins, 0.0, w, 1.0)
