"""Two homogeneous polyhedra, at any separation: the double integral over their surfaces, summed over a pair of trees.

As 1/|d| is half the Laplacian of |d|, Gauss's theorem for both bodies makes of the sum over all pairs of masses

    U = G/2 int int rho1 rho2 (n1 . n2) |d| dA1 dA2,    d = X + R p1 - p2,

whose integrand is finite even where the surfaces touch. A rule of nodes with vector weights w, which stand for
rho n dA, makes it a sum over pairs of nodes. Each body is a tree: its clusters of faces and its faces have a rule each,
and a face is divided in four as often as need be. A pair of them counts as it is where its estimated error is below
what is asked; else its parts do. Between the two both count, with shares that change smoothly with X and R, so that
dU/dX and M are the derivatives of U everywhere.
"""

from math import sqrt

from numba import types

from binaryast.kernels.jit import ARRAY, PAIR_POTENTIAL, Array, Matrix, PairGravity, Vector, jit
from binaryast.kernels.so3 import cross, dot, rotate

# the parameters begin with these; elements, their nodes and the rule of a face follow
STRENGTH, SCALE, REACH, POWER, SECONDARY, PRIMARY, COUNT, RULE = range(8)
HEADER = 8
# an element: centre (3), radius, the integral of |rho| dA, nodes and where they begin, parts and where they begin;
# where a face is: corners (9), the integral of rho n dA (3)
RADIUS, CHARGE, NODES, NODES_AT, PARTS, PARTS_AT, FACE_AT = range(3, 10)
ELEMENT = 10

WIDTH = 2.0  # a pair counts as it is up to the error asked, not at all from so many times it on
TINY = 1e-200  # m2: keeps a distance of zero from a division by it

ZERO = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
TRIANGLE = types.UniTuple(types.float64, 9)
VECTOR = types.UniTuple(types.float64, 3)
RESULT = PAIR_POTENTIAL.return_type
REASSOCIATED = {"reassoc", "nsz", "contract"}  # sums over nodes may be taken in lanes


@jit()
def difference(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@jit()
def plus(a: PairGravity, b: PairGravity) -> PairGravity:
    """Return the sum."""
    return a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3], a[4] + b[4], a[5] + b[5], a[6] + b[6]


@jit()
def share(p: Array, charge: float, size: float, square: float) -> tuple[float, float]:
    """Return how much of a pair counts as it is, from 0 to 1, and the slope of that with the distance D, over D.

    A rule of even degree n leaves of d/|d| some (size/D)^(n + 1), size being the sum of the radii, and of the sum over
    all of a closed surface, whose rho n dA add up to nothing, size/D of that. Times the product of the charges, over
    the force, which is about 1/(D + reach)^2 of bodies of mass one, this is the pair's error, over that asked:
    e = scale charge (D + reach)^2 t^(n/2 + 1), t = size^2/(D^2 + size^2), which stays finite where D vanishes.
    """
    distance = sqrt(square + TINY)
    t = size * size / (square + size * size)
    e = p[SCALE] * charge * (distance + p[REACH]) ** 2
    for _ in range(int(p[POWER])):
        e *= t
    if e <= 1.0:
        return 1.0, 0.0
    if e >= WIDTH:
        return 0.0, 0.0
    z = (WIDTH - e) / (WIDTH - 1.0)  # two derivatives vanish at both ends
    by_e = -30.0 * (z * (1.0 - z)) ** 2 / (WIDTH - 1.0)
    by_d = e * (2.0 / (distance + p[REACH]) - 2.0 * p[POWER] * distance / (square + size * size))
    return z * z * z * (10.0 - z * (15.0 - 6.0 * z)), by_e * by_d / distance


@jit()
def blended(whole: PairGravity, parts: PairGravity, s: float, slope: float, d: Vector, arm: Vector) -> PairGravity:
    """Return s whole + (1 - s) parts with its derivatives, s being that of the distance of two centres, d apart."""
    moved = slope * (whole[0] - parts[0])
    turned = cross(arm, d)  # the derivative of d^2/2 by a turn of the secondary, whose centre has that arm
    rest = 1.0 - s
    return (
        s * whole[0] + rest * parts[0],
        s * whole[1] + rest * parts[1] + moved * d[0],
        s * whole[2] + rest * parts[2] + moved * d[1],
        s * whole[3] + rest * parts[3] + moved * d[2],
        s * whole[4] + rest * parts[4] + moved * turned[0],
        s * whole[5] + rest * parts[5] + moved * turned[1],
        s * whole[6] + rest * parts[6] + moved * turned[2],
    )


@jit(RESULT(ARRAY, types.int64, types.int64, VECTOR, TRIANGLE), fastmath=REASSOCIATED)
def nodes(p: Array, a: int, b: int, x: Vector, r: Matrix) -> PairGravity:
    """Return the sum over the nodes of two elements: (w1 . w2) |d| and its derivatives."""
    n1, n2 = int(p[a + NODES]), int(p[b + NODES])
    i0, j0 = int(p[a + NODES_AT]), int(p[b + NODES_AT])
    x2, y2, z2 = p[j0 : j0 + n2], p[j0 + n2 : j0 + 2 * n2], p[j0 + 2 * n2 : j0 + 3 * n2]
    u2, v2, w2 = p[j0 + 3 * n2 : j0 + 4 * n2], p[j0 + 4 * n2 : j0 + 5 * n2], p[j0 + 5 * n2 : j0 + 6 * n2]
    energy = gx = gy = gz = mx = my = mz = 0.0
    for i in range(i0, i0 + n1):
        arm = rotate(r, (p[i], p[i + n1], p[i + 2 * n1]))
        u, v, w = rotate(r, (p[i + 3 * n1], p[i + 4 * n1], p[i + 5 * n1]))
        px, py, pz = x[0] + arm[0], x[1] + arm[1], x[2] + arm[2]
        fx = fy = fz = hx = hy = hz = 0.0
        for j in range(n2):
            dx, dy, dz = px - x2[j], py - y2[j], pz - z2[j]
            d = sqrt(dx * dx + dy * dy + dz * dz + TINY)
            k = (u * u2[j] + v * v2[j] + w * w2[j]) / d
            hx, hy, hz = hx + d * u2[j], hy + d * v2[j], hz + d * w2[j]  # sum of |d| w2
            fx, fy, fz = fx + k * dx, fy + k * dy, fz + k * dz  # sum of (w1 . w2) d/|d|
        energy += u * hx + v * hy + w * hz
        gx, gy, gz = gx + fx, gy + fy, gz + fz
        mx += arm[1] * fz - arm[2] * fy + v * hz - w * hy  # a turn moves the node and turns its weight
        my += arm[2] * fx - arm[0] * fz + w * hx - u * hz
        mz += arm[0] * fy - arm[1] * fx + u * hy - v * hx
    return energy, gx, gy, gz, mx, my, mz


@jit(RESULT(ARRAY, TRIANGLE, TRIANGLE, VECTOR), fastmath=REASSOCIATED)
def mean(p: Array, one: Matrix, two: Matrix, x: Vector) -> PairGravity:
    """Return the mean of |d| over two triangles by the rule of a face, and its derivatives; the arms are from x."""
    n, at = int(p[COUNT]), int(p[RULE])
    weight, s, t = p[at : at + n], p[at + n : at + 2 * n], p[at + 2 * n : at + 3 * n]
    ax, ay, az = two[0], two[1], two[2]
    bx, by, bz = two[3] - ax, two[4] - ay, two[5] - az
    cx, cy, cz = two[6] - ax, two[7] - ay, two[8] - az
    energy = gx = gy = gz = mx = my = mz = 0.0
    for i in range(n):
        px = one[0] + s[i] * (one[3] - one[0]) + t[i] * (one[6] - one[0])
        py = one[1] + s[i] * (one[4] - one[1]) + t[i] * (one[7] - one[1])
        pz = one[2] + s[i] * (one[5] - one[2]) + t[i] * (one[8] - one[2])
        u = fx = fy = fz = 0.0
        for j in range(n):
            dx = px - ax - s[j] * bx - t[j] * cx
            dy = py - ay - s[j] * by - t[j] * cy
            dz = pz - az - s[j] * bz - t[j] * cz
            d = sqrt(dx * dx + dy * dy + dz * dz + TINY)
            k = weight[j] / d
            u += weight[j] * d
            fx, fy, fz = fx + k * dx, fy + k * dy, fz + k * dz
        fx, fy, fz = weight[i] * fx, weight[i] * fy, weight[i] * fz
        energy += weight[i] * u
        gx, gy, gz = gx + fx, gy + fy, gz + fz
        mx += (py - x[1]) * fz - (pz - x[2]) * fy
        my += (pz - x[2]) * fx - (px - x[0]) * fz
        mz += (px - x[0]) * fy - (py - x[1]) * fx
    return energy, gx, gy, gz, mx, my, mz


@jit()
def middle(t: Matrix) -> Vector:
    """Return the centroid of a triangle."""
    return (t[0] + t[3] + t[6]) / 3.0, (t[1] + t[4] + t[7]) / 3.0, (t[2] + t[5] + t[8]) / 3.0


@jit()
def radius(t: Matrix, centre: Vector) -> float:
    """Return how far its corners reach from there."""
    a, b = difference((t[0], t[1], t[2]), centre), difference((t[3], t[4], t[5]), centre)
    c = difference((t[6], t[7], t[8]), centre)
    return sqrt(max(dot(a, a), dot(b, b), dot(c, c)))


@jit()
def quarter(t: Matrix, k: int) -> Matrix:
    """Return one of the four triangles between corners and midpoints: at a corner (0, 1, 2), or the inner one (3)."""
    p = (0.5 * (t[0] + t[3]), 0.5 * (t[1] + t[4]), 0.5 * (t[2] + t[5]))
    q = (0.5 * (t[3] + t[6]), 0.5 * (t[4] + t[7]), 0.5 * (t[5] + t[8]))
    r = (0.5 * (t[6] + t[0]), 0.5 * (t[7] + t[1]), 0.5 * (t[8] + t[2]))
    if k == 0:
        return t[0], t[1], t[2], p[0], p[1], p[2], r[0], r[1], r[2]
    if k == 1:
        return p[0], p[1], p[2], t[3], t[4], t[5], q[0], q[1], q[2]
    if k == 2:
        return r[0], r[1], r[2], q[0], q[1], q[2], t[6], t[7], t[8]
    return p[0], p[1], p[2], q[0], q[1], q[2], r[0], r[1], r[2]


@jit(RESULT(ARRAY, TRIANGLE, TRIANGLE, types.float64, VECTOR))
def triangles(p: Array, one: Matrix, two: Matrix, charge: float, x: Vector) -> PairGravity:
    """Return the mean of |d| over two triangles and its derivatives, dividing the larger one as often as need be."""
    c1, c2 = middle(one), middle(two)
    s1, s2 = radius(one, c1), radius(two, c2)
    d = difference(c1, c2)
    s, slope = share(p, charge, s1 + s2, dot(d, d))
    whole = mean(p, one, two, x) if s > 0.0 else ZERO
    if s == 1.0:
        return whole
    parts = ZERO
    for k in range(4):
        if s1 >= s2:
            parts = plus(parts, triangles(p, quarter(one, k), two, 0.25 * charge, x))
        else:
            parts = plus(parts, triangles(p, one, quarter(two, k), 0.25 * charge, x))
    quarters = (
        0.25 * parts[0], 0.25 * parts[1], 0.25 * parts[2], 0.25 * parts[3],
        0.25 * parts[4], 0.25 * parts[5], 0.25 * parts[6],
    )  # fmt: skip
    return blended(whole, quarters, s, slope, d, difference(c1, x))


@jit()
def faces(p: Array, a: int, b: int, x: Vector, r: Matrix) -> PairGravity:
    """Return (w1 . w2) times the mean of |d| over two faces, and its derivatives; w are their integrals of rho n dA."""
    f, g = int(p[a + FACE_AT]), int(p[b + FACE_AT])
    a1, b1 = rotate(r, (p[f], p[f + 1], p[f + 2])), rotate(r, (p[f + 3], p[f + 4], p[f + 5]))
    c1, w1 = rotate(r, (p[f + 6], p[f + 7], p[f + 8])), rotate(r, (p[f + 9], p[f + 10], p[f + 11]))
    one = (
        x[0] + a1[0], x[1] + a1[1], x[2] + a1[2], x[0] + b1[0], x[1] + b1[1], x[2] + b1[2],
        x[0] + c1[0], x[1] + c1[1], x[2] + c1[2],
    )  # fmt: skip
    two = (p[g], p[g + 1], p[g + 2], p[g + 3], p[g + 4], p[g + 5], p[g + 6], p[g + 7], p[g + 8])
    w2 = (p[g + 9], p[g + 10], p[g + 11])
    u, gx, gy, gz, mx, my, mz = triangles(p, one, two, p[a + CHARGE] * p[b + CHARGE], x)
    k, n = dot(w1, w2), cross(w1, w2)
    return k * u, k * gx, k * gy, k * gz, k * mx + n[0] * u, k * my + n[1] * u, k * mz + n[2] * u


@jit()
def as_it_is(p: Array, a: int, b: int, x: Vector, r: Matrix) -> tuple[float, float, Vector, Vector]:
    """Return how much of a pair of elements counts as it is, see `share`, its slope, the centres' d, and the arm."""
    arm = rotate(r, (p[a], p[a + 1], p[a + 2]))
    d = (x[0] + arm[0] - p[b], x[1] + arm[1] - p[b + 1], x[2] + arm[2] - p[b + 2])
    s, slope = share(p, p[a + CHARGE] * p[b + CHARGE], p[a + RADIUS] + p[b + RADIUS], dot(d, d))
    return s, slope, d, arm


@jit()
def first_has_parts(p: Array, a: int, b: int) -> bool:
    """Whether of two elements, not both of them faces, the first is to be replaced by its parts: it is the larger."""
    return bool(p[b + PARTS] == 0.0 or (p[a + PARTS] > 0.0 and p[a + RADIUS] >= p[b + RADIUS]))


@jit(RESULT(ARRAY, types.int64, types.int64, VECTOR, TRIANGLE))
def elements(p: Array, a: int, b: int, x: Vector, r: Matrix) -> PairGravity:
    """Return the sum over two elements: by their rules, or by those of the parts of the larger one."""
    s, slope, d, arm = as_it_is(p, a, b, x, r)
    whole = nodes(p, a, b, x, r) if s > 0.0 else ZERO
    if s == 1.0:
        return whole
    parts = ZERO
    if p[a + PARTS] == 0.0 and p[b + PARTS] == 0.0:
        parts = faces(p, a, b, x, r)
    elif first_has_parts(p, a, b):
        for k in range(int(p[a + PARTS])):
            parts = plus(parts, elements(p, int(p[a + PARTS_AT]) + ELEMENT * k, b, x, r))
    else:
        for k in range(int(p[b + PARTS])):
            parts = plus(parts, elements(p, a, int(p[b + PARTS_AT]) + ELEMENT * k, x, r))
    return blended(whole, parts, s, slope, d, arm)


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p is laid out by ``clusters.py``."""
    attitude = (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    u, gx, gy, gz, mx, my, mz = elements(p, int(p[SECONDARY]), int(p[PRIMARY]), (x, y, z), attitude)
    k = p[STRENGTH]
    return k * u, k * gx, k * gy, k * gz, k * mx, k * my, k * mz
