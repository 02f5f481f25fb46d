"""Whether two bodies touch: their surfaces as sets of ellipsoids, each pair by the function of Perram and Wertheim.

Two ellipsoids with centres d apart and matrices A, B (x.A^-1 x = 1 on the surface) are apart exactly where the
concave function F(s) = s (1 - s) d.[(1 - s) A + s B]^-1 d exceeds 1 somewhere in 0 < s < 1 (J. Comput. Phys. 58, 409,
1985); for spheres the first look, at s = a/(a + b), decides. A point is an ellipsoid without size.

Grown by the root of the largest F both just touch, in a plane that the originals are away from: their gap is at least
that root less 1, times the sum of their smallest semi-axes. So they can move by that before they touch, and a way is
looked at in strides of this length: no contact on it is missed, however short.
"""

from math import inf, sqrt

from binaryast.kernels.arrays import vector_at
from binaryast.kernels.jit import Array, Matrix, Quaternion, Vector, jit
from binaryast.kernels.so3 import dot, quaternion_to_matrix, relative_attitude, rotate, rotate_back

# surfaces: for each body the radius of a sphere about its mass centre that holds it, its smallest semi-axis, where its
# pieces begin, how many they are, and whether it pulls: of two that do not, neither is looked at; then for each piece
# its centre and the six elements xx, xy, xz, yy, yz, zz of its matrix, in the body's frame.
RADIUS = 0
SMALLEST = 1
FIRST = 2
COUNT = 3
PULLS = 4
HEADER = 5  # for each body
PIECE = 9
GOLDEN = 0.6180339887498949
LOOKS = 40  # the golden section is then 4e-9 wide, and the largest value right to round-off
CLOSE = 1e-3  # of the smallest semi-axis: a gap that a way may have to be looked at more closely
MOST_STRIDES = 200  # of a way
ARC = 1.12  # how much an angle is longer at most than twice the chord between its two quaternions

Symmetric = tuple[float, float, float, float, float, float]


@jit()
def turned(r: Matrix, s: Symmetric) -> Symmetric:
    """Return R S R^T."""
    xx, xy, xz, yy, yz, zz = s
    a = rotate(r, (xx, xy, xz))  # columns of R S
    b = rotate(r, (xy, yy, yz))
    c = rotate(r, (xz, yz, zz))
    top = rotate(r, (a[0], b[0], c[0]))
    middle = rotate(r, (a[1], b[1], c[1]))
    bottom = rotate(r, (a[2], b[2], c[2]))
    return top[0], top[1], top[2], middle[1], middle[2], bottom[2]


@jit()
def separation_function(s: float, d: Vector, a: Symmetric, b: Symmetric) -> float:
    """Return F(s)."""
    t = 1.0 - s
    xx, xy, xz = t * a[0] + s * b[0], t * a[1] + s * b[1], t * a[2] + s * b[2]
    yy, yz, zz = t * a[3] + s * b[3], t * a[4] + s * b[4], t * a[5] + s * b[5]
    cxx, cxy, cxz = yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy
    cyy, cyz, czz = xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy
    determinant = xx * cxx + xy * cxy + xz * cxz
    v = (
        cxx * d[0] + cxy * d[1] + cxz * d[2],
        cxy * d[0] + cyy * d[1] + cyz * d[2],
        cxz * d[0] + cyz * d[1] + czz * d[2],
    )
    return s * t * dot(d, v) / determinant


@jit()
def size_of(a: Symmetric) -> float:
    """Return the root of the sum of the squared semi-axes."""
    return sqrt(a[0] + a[3] + a[5])


@jit()
def first_look(d: Vector, a: Symmetric, b: Symmetric) -> float:
    """Return F where it is largest for spheres: never more than the largest F, and the same where one is a point."""
    size_a, size_b = size_of(a), size_of(b)
    if size_a == 0.0 or size_b == 0.0:  # F is linear in s: twice what it is in the middle
        return 2.0 * separation_function(0.5, d, a, b)
    return separation_function(size_a / (size_a + size_b), d, a, b)


@jit()
def largest(d: Vector, a: Symmetric, b: Symmetric) -> float:
    """Return the largest F: below 1 two ellipsoids overlap, at 1 they touch."""
    if size_of(a) == 0.0 or size_of(b) == 0.0:
        return first_look(d, a, b)
    low, high = 0.0, 1.0
    left, right = 1.0 - GOLDEN, GOLDEN
    f_left, f_right = separation_function(left, d, a, b), separation_function(right, d, a, b)
    for _ in range(LOOKS):
        if f_left > f_right:
            high, right, f_right = right, left, f_left
            left = high - GOLDEN * (high - low)
            f_left = separation_function(left, d, a, b)
        else:
            low, left, f_left = left, right, f_right
            right = low + GOLDEN * (high - low)
            f_right = separation_function(right, d, a, b)
    return max(f_left, f_right)


@jit()
def placed(whole: bool, x: Vector, r: Matrix, surfaces: Array, one: int, two: int) -> float:
    """Return the smallest F of all pieces of two bodies, at X and R in the frame of ``two``.

    It is the ``whole`` maximum of F, or else the first look at it, which is less.
    """
    smallest = inf
    first_1, first_2 = int(surfaces[HEADER * one + FIRST]), int(surfaces[HEADER * two + FIRST])
    for i in range(int(surfaces[HEADER * one + COUNT])):
        at = first_1 + PIECE * i
        centre = rotate(r, vector_at(surfaces, at))
        b = turned(r, (*vector_at(surfaces, at + 3), *vector_at(surfaces, at + 6)))
        for j in range(int(surfaces[HEADER * two + COUNT])):
            k = first_2 + PIECE * j
            d = (
                x[0] + centre[0] - surfaces[k],
                x[1] + centre[1] - surfaces[k + 1],
                x[2] + centre[2] - surfaces[k + 2],
            )
            a = (*vector_at(surfaces, k + 3), *vector_at(surfaces, k + 6))
            smallest = min(smallest, largest(d, a, b) if whole else first_look(d, a, b))
    return smallest


@jit()
def clearance(x: Vector, r: Matrix, surfaces: Array, one: int, two: int) -> float:
    """Return the smallest of the largest F, less 1: 0 where two bodies touch, below where they overlap.

    Where they are further than half as much again as the spheres that hold them it is that of these spheres.
    """
    reach = surfaces[HEADER * one + RADIUS] + surfaces[HEADER * two + RADIUS]
    spheres: float = dot(x, x) / (reach * reach) - 1.0
    if spheres > 1.25:
        return spheres
    return placed(True, x, r, surfaces, one, two) - 1.0


@jit()
def can_touch(surfaces: Array, one: int, two: int) -> bool:
    """Whether both bodies have a surface, and one of them an extent: two points never meet."""
    both = surfaces[HEADER * one + COUNT] * surfaces[HEADER * two + COUNT]
    return bool(both * (surfaces[HEADER * one + RADIUS] + surfaces[HEADER * two + RADIUS]) > 0.0)


@jit()
def between(q: Quaternion, p: Quaternion, s: float) -> Matrix:
    """Return an attitude on the way from one to another."""
    sign = 1.0 if q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3] >= 0.0 else -1.0
    t, u = 1.0 - s, s * sign
    m = (t * q[0] + u * p[0], t * q[1] + u * p[1], t * q[2] + u * p[2], t * q[3] + u * p[3])
    length = sqrt(m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + m[3] * m[3])
    return quaternion_to_matrix((m[0] / length, m[1] / length, m[2] / length, m[3] / length))


@jit()
def turn_between(q: Quaternion, p: Quaternion) -> float:
    """Return about the angle between two attitudes [rad], never less."""
    cosine = abs(q[0] * p[0] + q[1] * p[1] + q[2] * p[2] + q[3] * p[3])
    return 2.0 * ARC * sqrt(max(0.0, 2.0 - 2.0 * cosine))


@jit()
def bulge(way: Vector, before: Vector, after: Vector) -> float:
    """Return about how far an arc goes away from its chord, by the velocities at its ends: a h^2/8."""
    change = (after[0] - before[0], after[1] - before[1], after[2] - before[2])
    mean = (after[0] + before[0], after[1] + before[1], after[2] + before[2])
    square = dot(mean, mean)
    return 0.25 * sqrt(dot(way, way) * dot(change, change) / square) if square > 0.0 else 0.0


@jit()
def may_touch(
    before: Vector,
    after: Vector,
    aside: float,
    turns: tuple[Quaternion, Quaternion, Quaternion, Quaternion],
    surfaces: Array,
    one: int,
    two: int,
) -> bool:
    """Whether two bodies may touch on a way: whether they come as near as the way bulges ``aside``, and a little more.

    The way leads body ``one`` relative to body ``two`` on a straight line, in inertial axes; ``turns`` are the
    attitudes of ``two``, before and after, and of ``one``.
    """
    reach = surfaces[HEADER * one + RADIUS] + surfaces[HEADER * two + RADIUS] + aside
    way = (after[0] - before[0], after[1] - before[1], after[2] - before[2])
    square = dot(way, way)
    closest = -dot(before, way) / square if square > 0.0 else 1.0  # of the whole straight line
    point = (before[0] + closest * way[0], before[1] + closest * way[1], before[2] + closest * way[2])
    inside = reach * reach - dot(point, point)
    if inside <= 0.0 or not can_touch(surfaces, one, two):
        return False
    half = sqrt(inside / square) if square > 0.0 else 0.0
    s, last = max(0.0, closest - half), min(1.0, closest + half)
    if square == 0.0:
        s, last = 0.0, 1.0
    smallest_1, smallest_2 = surfaces[HEADER * one + SMALLEST], surfaces[HEADER * two + SMALLEST]
    close = aside + CLOSE * (min(smallest_1, smallest_2) if smallest_1 * smallest_2 > 0.0 else smallest_1 + smallest_2)
    length = (
        sqrt(square)
        + surfaces[HEADER * two + RADIUS] * turn_between(turns[0], turns[1])
        + surfaces[HEADER * one + RADIUS] * turn_between(turns[2], turns[3])
    )
    for _ in range(MOST_STRIDES):
        if s > last:
            return False
        r2 = between(turns[0], turns[1], s)
        r = relative_attitude(r2, between(turns[2], turns[3], s))
        x = rotate_back(r2, (before[0] + s * way[0], before[1] + s * way[1], before[2] + s * way[2]))
        gap = (sqrt(placed(False, x, r, surfaces, one, two)) - 1.0) * (smallest_1 + smallest_2)
        if gap <= close:  # the first look may see too little
            gap = (sqrt(placed(True, x, r, surfaces, one, two)) - 1.0) * (smallest_1 + smallest_2)
        if gap <= close:
            return True
        if length == 0.0:
            return False
        s += gap / length
    return True
