"""The field of a homogeneous polyhedron, exact at every point: R. A. Werner, D. J. Scheeres, CMDA 65 (1996) 313-344.

With r from the point to anywhere on an edge e or a face f, and w = G rho (their potential is positive, ours negative):

    U     = -1/2 (sum_e r.E r L  -  sum_f r.F r omega)          (10)
    dU/dx =       sum_e E r L    -  sum_f F r omega             (15)
    ddU   =      -sum_e E L      +  sum_f F omega               (16)
    tr ddU =                        sum_f w omega               (17): 4 pi G rho inside, 0 outside

E = w (n_A m_A + n_B m_B) holds the normals of an edge's two faces and, in each face, the edge's own; F = w n n.

Far away these sums cancel: at r they lose (r/size)^2. Because sum E |e| = 0, sum E r |e| = 0 and sum r.E r |e| = 6 G M,
|e|/r may be taken from every L, and the sums then lose r/size only. Each L - |e|/r is formed without a difference of
what is nearly equal. Layers of other densities are further edges and faces of the same sums, with weights of their own.

Edges and faces are worked on in blocks, twice: first all of a block by series, in the vector lanes of the processor;
then, one by one, those that the point is too near to, if there are any.
"""

from math import atan2, log, pi, sqrt

from numba import types

from binaryast.kernels.jit import ARRAY, ROWS, Array, Vector, jit
from binaryast.kernels.so3 import cross, dot

# A table: radius of a sphere about the origin that holds all vertices, G M, w of the surface, number of blocks of edges
# and of faces; then the blocks, each with its columns one after the other, filled up with what weighs nothing.
RADIUS, GM, WEIGHT, EDGE_BLOCKS, FACE_BLOCKS = range(5)
HEADER = 5
BLOCK = 64  # edges or faces
EDGE = 13  # columns: both ends (6), length, E: xx, xy, xz, yy, yz, zz
FACE = 14  # columns: corners (9), unit normal (3), twice the area, w
SMALL = 0.125  # below it the series' next term is under 1e-17
NEAR = 0.75  # above it a point is so near to an edge that r1 + r2 - |e| would cancel
ROUNDING = 2e-15  # of the distance from a plane, over the radius
INSIDE = 4.0 * pi - 1e-6  # solid angle of the surface from a point that is inside beyond doubt
LANES = {"reassoc", "nsz", "contract"}  # lets a sum over a block run in vector lanes

Field = tuple[float, float, float, float, float, float, float, float, float, float, float]


@jit()
def column(p: Array, k: int, first: int) -> Vector:
    """Return three columns that follow each other, at p[k] in the first of them."""
    return p[k + first * BLOCK], p[k + (first + 1) * BLOCK], p[k + (first + 2) * BLOCK]


@jit()
def difference(a: Vector, b: Vector) -> Vector:
    """Return a - b."""
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


@jit(fastmath=LANES)
def odd_series(q: float, s: float) -> float:
    """Return q s/3 + q s^2/5 + ..: atanh(q) - q for s = q^2, and atan(q) - q for s = -q^2."""
    return (
        q * s * (1 / 3 + s * (1 / 5 + s * (1 / 7 + s * (1 / 9 + s * (1 / 11 + s * (1 / 13 + s * (1 / 15 + s / 17)))))))
    )


@jit(fastmath=LANES)
def far_logarithm(at: Vector, one: Vector, two: Vector, e: float, scale: float, excess: float) -> tuple[float, bool]:
    """Return L - |e|/scale of an edge between two vertices, and whether it is far enough for it: zero, if not.

    L = 2 atanh(|e|/(r1 + r2)), and scale - r = (scale^2 - r^2)/(scale + r); excess = scale^2 - |at|^2.
    """
    a, b = difference(one, at), difference(two, at)
    r1, r2 = sqrt(dot(a, a)), sqrt(dot(b, b))
    total = r1 + r2
    first = excess + dot(one, difference(at, a))
    second = excess + dot(two, difference(at, b))
    s1, s2 = scale + r1, scale + r2
    q = e / total
    far = q < SMALL
    logarithm = 2.0 * odd_series(q, q * q) + q * (first * s2 + second * s1) / (s1 * s2 * scale)
    return logarithm if far else 0.0, far


@jit()
def near_logarithm(a: Vector, b: Vector, e: float, floor: float) -> float:
    """Return L = ln((r1 + r2 + |e|)/(r1 + r2 - |e|)) of an edge with ends at a and b; zero, if it is far.

    With t1 and t2, the parts of the edge on both sides of the foot of the perpendicular, r1 + r2 - |e| is
    (r1 - t1) + (r2 - t2), and r - t = d^2/(r + t) for the distance d from the edge's line. On the edge itself L is
    infinite, and E r L zero: d is not taken to be less than what round-off leaves of it.
    """
    r1, r2 = sqrt(dot(a, a)), sqrt(dot(b, b))
    total = r1 + r2
    if e < NEAR * total:
        return log((total + e) / (total - e))
    u = ((b[0] - a[0]) / e, (b[1] - a[1]) / e, (b[2] - a[2]) / e)
    t1, t2 = -dot(a, u), dot(b, u)
    across = cross(a, u) if r1 < r2 else cross(b, u)
    square = max(dot(across, across), floor * floor)
    gap = (square / (r1 + t1) if t1 > 0.0 else r1 - t1) + (square / (r2 + t2) if t2 > 0.0 else r2 - t2)
    return log((total + e) / gap)


@jit(fastmath=LANES)
def half_angle(a: Vector, b: Vector, c: Vector, height: float, area2: float) -> tuple[float, float]:
    """Return y, x with tan(omega/2) = y/x for a face with corners at a, b, c: (27), with a.(b x c) = 2 area height."""
    r1, r2, r3 = sqrt(dot(a, a)), sqrt(dot(b, b)), sqrt(dot(c, c))
    return area2 * height, r1 * (r2 * r3 + dot(b, c)) + r2 * dot(a, c) + r3 * dot(a, b)


@jit(fastmath=LANES)
def edge_terms(p: Array, k: int, logarithm: float, r: Vector) -> Field:
    """Return what an edge adds to -2 U, dU/dx, ddU and sum w omega."""
    xx, xy, xz = logarithm * p[k + 7 * BLOCK], logarithm * p[k + 8 * BLOCK], logarithm * p[k + 9 * BLOCK]
    yy, yz, zz = logarithm * p[k + 10 * BLOCK], logarithm * p[k + 11 * BLOCK], logarithm * p[k + 12 * BLOCK]
    x, y, z = r
    gx, gy, gz = xx * x + xy * y + xz * z, xy * x + yy * y + yz * z, xz * x + yz * y + zz * z
    return gx * x + gy * y + gz * z, gx, gy, gz, -xx, -xy, -xz, -yy, -yz, -zz, 0.0


@jit(fastmath=LANES)
def face_terms(omega: float, height: float, n: Vector) -> Field:
    """Return what a face adds to them; omega with its weight."""
    x, y, z = n
    f = -omega * height
    hx, hy, hz = omega * x, omega * y, omega * z
    return f * height, f * x, f * y, f * z, hx * x, hx * y, hx * z, hy * y, hy * z, hz * z, omega


@jit(fastmath=LANES)
def plus(s: Field, t: Field) -> Field:
    """Return the sum of two fields."""
    return (
        s[0] + t[0], s[1] + t[1], s[2] + t[2], s[3] + t[3], s[4] + t[4], s[5] + t[5],
        s[6] + t[6], s[7] + t[7], s[8] + t[8], s[9] + t[9], s[10] + t[10],
    )  # fmt: skip


@jit(fastmath=LANES)
def edge_block(p: Array, start: int, at: Vector, scale: float, excess: float, radius: float, total: Field) -> Field:
    """Return the total with a block of edges."""
    near = 0
    for k in range(start, start + BLOCK):
        one, two = column(p, k, 0), column(p, k, 3)
        logarithm, far = far_logarithm(at, one, two, p[k + 6 * BLOCK], scale, excess)
        total = plus(total, edge_terms(p, k, logarithm, difference(one, at)))
        near += 0 if far else 1
    if near > 0:
        for k in range(start, start + BLOCK):
            one, two, e = column(p, k, 0), column(p, k, 3), p[k + 6 * BLOCK]
            if not far_logarithm(at, one, two, e, scale, excess)[1]:
                a = difference(one, at)
                logarithm = near_logarithm(a, difference(two, at), e, ROUNDING * radius) - e / scale
                total = plus(total, edge_terms(p, k, logarithm, a))
    return total


@jit(fastmath=LANES)
def face_block(p: Array, start: int, at: Vector, radius: float, total: Field) -> Field:
    """Return the total with a block of faces.

    A face in whose plane the point is adds nothing: that is the mean of its two sides, +-2 pi in the face itself.
    """
    near = 0
    for k in range(start, start + BLOCK):
        a, b, c = difference(column(p, k, 0), at), difference(column(p, k, 3), at), difference(column(p, k, 6), at)
        n = column(p, k, 9)
        height = dot(n, a)
        y, x = half_angle(a, b, c, height, p[k + 12 * BLOCK])
        far = abs(y) < SMALL * x
        t = y / x
        omega = 2.0 * p[k + 13 * BLOCK] * (t + odd_series(t, -t * t))
        total = plus(total, face_terms(omega if far else 0.0, height, n))
        near += 0 if far else 1
    if near > 0:
        for k in range(start, start + BLOCK):
            a, b, c = difference(column(p, k, 0), at), difference(column(p, k, 3), at), difference(column(p, k, 6), at)
            n = column(p, k, 9)
            height = dot(n, a)
            y, x = half_angle(a, b, c, height, p[k + 12 * BLOCK])
            if not abs(y) < SMALL * x and abs(height) > ROUNDING * radius:
                total = plus(total, face_terms(2.0 * p[k + 13 * BLOCK] * atan2(y, x), height, n))
    return total


@jit()
def field_at(p: Array, start: int, at: Vector) -> Field:
    """Return U, dU/dx (3), ddU (xx, xy, xz, yy, yz, zz) and sum w omega of the table that starts at p[start].

    On the surface itself the second derivatives are the mean of both sides; on an edge, where they are infinite, those
    at a distance of round-off.
    """
    radius, square = p[start + RADIUS], dot(at, at)
    scale = max(sqrt(square), radius)
    excess = max(radius * radius - square, 0.0)
    total = (6.0 * p[start + GM] / scale, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)
    k = start + HEADER
    for _ in range(int(p[start + EDGE_BLOCKS])):
        total = edge_block(p, k, at, scale, excess, radius, total)
        k += EDGE * BLOCK
    for _ in range(int(p[start + FACE_BLOCKS])):
        total = face_block(p, k, at, radius, total)
        k += FACE * BLOCK
    u, gx, gy, gz, hxx, hxy, hxz, hyy, hyz, hzz, laplacian = total
    return -0.5 * u, gx, gy, gz, hxx, hxy, hxz, hyy, hyz, hzz, laplacian


@jit(types.void(ARRAY, ROWS, ROWS))
def fields(table: Array, points: Array, result: Array) -> None:
    """Put the field (P, 11) at points (P, 3), one after the other."""
    for i in range(len(points)):
        row = field_at(table, 0, (points[i, 0], points[i, 1], points[i, 2]))
        for j in range(len(row)):
            result[i, j] = row[j]
