"""Whether two bodies touch: their surfaces as sets of ellipsoids, each pair by the function of Perram and Wertheim.

Two ellipsoids with centres d apart and matrices A, B (x.A^-1 x = 1 on the surface) are apart exactly where the
concave function F(s) = s (1 - s) d.[(1 - s) A + s B]^-1 d exceeds 1 somewhere in 0 < s < 1 (J. Comput. Phys. 58, 409,
1985); for spheres the first look, at s = a/(a + b), decides. A point is an ellipsoid without size.
"""

from math import sqrt

from binaryast.kernels.arrays import vector_at
from binaryast.kernels.jit import Array, Matrix, Vector, jit
from binaryast.kernels.so3 import dot, relative_attitude, rotate, rotate_back

# surfaces: for each body the radius of a sphere about its mass centre that holds it, its smallest semi-axis, where its
# pieces begin, how many they are, and whether it pulls: of two that do not, neither is looked at; then for each piece its centre and the six elements xx, xy, xz, yy, yz, zz of its
# matrix, in the body's frame.
RADIUS = 0
SMALLEST = 1
FIRST = 2
COUNT = 3
PULLS = 4
HEADER = 5  # for each body
PIECE = 9
GOLDEN = 0.6180339887498949
LOOKS = 40  # the golden section is then 4e-9 wide

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
def overlap(d: Vector, a: Symmetric, b: Symmetric) -> bool:
    """Whether two ellipsoids overlap."""
    size_a, size_b = sqrt(a[0] + a[3] + a[5]), sqrt(b[0] + b[3] + b[5])
    if separation_function(size_a / (size_a + size_b), d, a, b) > 1.0:
        return False
    low, high = 0.0, 1.0
    left, right = 1.0 - GOLDEN, GOLDEN
    f_left, f_right = separation_function(left, d, a, b), separation_function(right, d, a, b)
    for _ in range(LOOKS):
        if f_left > 1.0 or f_right > 1.0:
            return False
        if f_left > f_right:
            high, right, f_right = right, left, f_left
            left = high - GOLDEN * (high - low)
            f_left = separation_function(left, d, a, b)
        else:
            low, left, f_left = left, right, f_right
            right = low + GOLDEN * (high - low)
            f_right = separation_function(right, d, a, b)
    return True


@jit()
def placed_touches(x: Vector, r: Matrix, surfaces: Array, one: int, two: int) -> bool:
    """Whether any piece of body ``one`` overlaps any piece of body ``two``, at X and R in the frame of ``two``."""
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
            if overlap(d, (*vector_at(surfaces, k + 3), *vector_at(surfaces, k + 6)), b):
                return True
    return False


@jit()
def can_touch(surfaces: Array, one: int, two: int) -> bool:
    """Whether both bodies have a surface, and one of them an extent: two points never meet."""
    both = surfaces[HEADER * one + COUNT] * surfaces[HEADER * two + COUNT]
    return bool(both * (surfaces[HEADER * one + RADIUS] + surfaces[HEADER * two + RADIUS]) > 0.0)


@jit()
def touch_on_the_way(
    before: Vector, after: Vector, r2: Matrix, r1: Matrix, surfaces: Array, one: int, two: int
) -> bool:
    """Whether two bodies touch on a straight way of body ``one`` relative to body ``two``, in inertial axes.

    The part of the way within reach is looked at in places no further apart than half the smallest semi-axis, and at
    its end, with the attitudes of the end.
    """
    reach = surfaces[HEADER * one + RADIUS] + surfaces[HEADER * two + RADIUS]
    way = (after[0] - before[0], after[1] - before[1], after[2] - before[2])
    square = dot(way, way)
    closest = -dot(before, way) / square if square > 0.0 else 1.0  # of the whole straight line
    point = (before[0] + closest * way[0], before[1] + closest * way[1], before[2] + closest * way[2])
    inside = reach * reach - dot(point, point)
    if inside <= 0.0 or not can_touch(surfaces, one, two):
        return False
    half = sqrt(inside / square) if square > 0.0 else 0.0
    first, last = max(0.0, closest - half), min(1.0, closest + half)
    if first > last:
        return False
    r = relative_attitude(r2, r1)
    smaller = min(surfaces[HEADER * one + SMALLEST], surfaces[HEADER * two + SMALLEST])
    larger = max(surfaces[HEADER * one + SMALLEST], surfaces[HEADER * two + SMALLEST])
    spacing = 0.5 * (smaller if smaller > 0.0 else larger)
    places = 1 + int((last - first) * sqrt(square) / spacing)
    for place in range(1, places + 1):
        s = first + (last - first) * place / places
        x = rotate_back(r2, (before[0] + s * way[0], before[1] + s * way[1], before[2] + s * way[2]))
        if placed_touches(x, r, surfaces, one, two):
            return True
    return False
