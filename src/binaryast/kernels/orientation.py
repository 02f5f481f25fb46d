"""On which side of a line or a plane a point lies: the sign of a determinant, without round-off.

Where the plain determinant is so small that its sign is in doubt, it is computed again with twice the digits: numbers
as unevaluated sums (high, low) of two, by T. J. Dekker, Numer. Math. 18 (1971) 224. Differences of coordinates are
exact in it; what is then below ZERO of its own terms is zero.
"""

from binaryast.kernels.jit import Vector, jit

DOUBT = 1e-14  # of the sizes of the terms: a plain determinant's round-off is below this
ZERO = 1e-29
SPLIT = 134217729.0  # 2^27 + 1

Double = tuple[float, float]
Doubles = tuple[Double, Double, Double]


@jit()
def total(a: float, b: float) -> Double:
    """Return a + b exactly."""
    s = a + b
    t = s - a
    return s, (a - (s - t)) + (b - t)


@jit()
def product(a: float, b: float) -> Double:
    """Return a b exactly."""
    p = a * b
    c, d = SPLIT * a, SPLIT * b
    a_high, b_high = c - (c - a), d - (d - b)
    a_low, b_low = a - a_high, b - b_high
    return p, ((a_high * b_high - p) + a_high * b_low + a_low * b_high) + a_low * b_low


@jit()
def plus(x: Double, y: Double) -> Double:
    """Return x + y with twice the digits."""
    high, rest = total(x[0], y[0])
    low, last = total(x[1], y[1])
    high, rest = total(high, rest + low)
    return total(high, rest + last)


@jit()
def minus(x: Double, y: Double) -> Double:
    """Return x - y with twice the digits."""
    return plus(x, (-y[0], -y[1]))


@jit()
def times(x: Double, y: Double) -> Double:
    """Return x y with twice the digits."""
    p, rest = product(x[0], y[0])
    return total(p, rest + (x[0] * y[1] + x[1] * y[0]))


@jit()
def exact_difference(a: Vector, b: Vector) -> Doubles:
    """Return a - b exactly."""
    return total(a[0], -b[0]), total(a[1], -b[1]), total(a[2], -b[2])


@jit()
def exact_determinant(a: Vector, b: Vector, c: Vector, p: Vector) -> float:
    """Return det(b - a, c - a, p - a) with twice the digits."""
    u, v, d = exact_difference(b, a), exact_difference(c, a), exact_difference(p, a)
    x = times(d[0], minus(times(u[1], v[2]), times(u[2], v[1])))
    y = times(d[1], minus(times(u[2], v[0]), times(u[0], v[2])))
    z = times(d[2], minus(times(u[0], v[1]), times(u[1], v[0])))
    return plus(plus(x, y), z)[0]


@jit()
def sign(value: float, least: float) -> int:
    """Return the sign of a value, 0 where it is not larger than the least one that counts."""
    if abs(value) <= least:
        return 0
    return 1 if value > 0.0 else -1


@jit()
def side_of_plane(a: Vector, b: Vector, c: Vector, p: Vector) -> int:
    """Return on which side of the plane of a, b and c a point lies: the sign of det(b - a, c - a, p - a)."""
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    dx, dy, dz = p[0] - a[0], p[1] - a[1], p[2] - a[2]
    value = dx * (uy * vz - uz * vy) + dy * (uz * vx - ux * vz) + dz * (ux * vy - uy * vx)
    terms = (
        abs(dx) * (abs(uy * vz) + abs(uz * vy))
        + abs(dy) * (abs(uz * vx) + abs(ux * vz))
        + abs(dz) * (abs(ux * vy) + abs(uy * vx))
    )
    if abs(value) > DOUBT * terms:
        return sign(value, 0.0)
    return sign(exact_determinant(a, b, c, p), ZERO * terms)


@jit()
def side_of_line(a: Vector, b: Vector, p: Vector, i: int, j: int) -> int:
    """Return on which side of the line from a to b a point lies, all seen in the plane of the axes i and j."""
    one, two = (b[i] - a[i]) * (p[j] - a[j]), (b[j] - a[j]) * (p[i] - a[i])
    terms = abs(one) + abs(two)
    if abs(one - two) > DOUBT * terms:
        return sign(one - two, 0.0)
    exact_one = times(total(b[i], -a[i]), total(p[j], -a[j]))
    exact_two = times(total(b[j], -a[j]), total(p[i], -a[i]))
    return sign(minus(exact_one, exact_two)[0], ZERO * terms)
