"""The moments of a homogeneous polyhedron, by sums over its faces.

Each face (a, b, c) and the origin make a tetrahedron of signed volume J/6, J = det(a, b, c). The integral of a monomial
over it is exact:

    int x^al dV = J al!/(|al| + 3)! H_al,    sum_al H_al k^al = 1/((1 - k.a)(1 - k.b)(1 - k.c)),

from int exp(k.x) dV, whose terms of one degree are the complete homogeneous polynomials of k.a, k.b and k.c. Signed
tetrahedra make the sum right for every closed surface, wherever the origin lies.
"""

import numpy as np
from numba import types

from binaryast.kernels.jit import ARRAY, Array, Indices, jit
from binaryast.kernels.so3 import cross, dot

VERTICES = types.Array(types.float64, 2, "C", readonly=True)
FACES = types.Array(types.int64, 2, "C", readonly=True)
LANES = 8  # faces that are worked on side by side, in the vector lanes of the processor


@jit()
def divide(h: Array, degree: int, a: Array) -> None:
    """Divide the power series with coefficients H_al by 1 - k.a, in place: H_al += sum_i a_i H_(al - e_i).

    The coefficients h (count, LANES) are ordered as in moments.py: within degree n by rows of j + k = q, in each of
    them by k. The corner a (3, LANES) is another one in each lane.
    """
    below, here = 0, 1  # where degrees n - 1 and n begin
    for n in range(1, degree + 1):
        for t in range(n * (n + 1) // 2):  # al - e_x has the same q and k
            for lane in range(LANES):
                h[here + t, lane] += a[0, lane] * h[below + t, lane]
        source, target = below, here + 1
        for q in range(1, n + 1):
            for k in range(q):  # al - e_y has q - 1 and k
                for lane in range(LANES):
                    h[target + k, lane] += a[1, lane] * h[source + k, lane]
            for k in range(q):  # al - e_z has q - 1 and k - 1
                for lane in range(LANES):
                    h[target + k + 1, lane] += a[2, lane] * h[source + k, lane]
            source += q
            target += q + 1
        below, here = here, here + (n + 1) * (n + 2) // 2


@jit()
def gather(corners: Array, vertices: Array, faces: Indices, first: int) -> None:
    """Put the corners (3, 3, LANES) of the next faces side by side; behind the last face they are all zero."""
    for lane in range(LANES):
        for corner in range(3):
            for axis in range(3):
                inside = first + lane < len(faces)
                corners[corner, axis, lane] = vertices[faces[first + lane, corner], axis] if inside else 0.0


@jit()
def factors(total: Array, degree: int, factorial: Array) -> None:
    """Multiply by al!/(|al| + 3)!, in place."""
    t = 0
    for n in range(degree + 1):
        for q in range(n + 1):
            for k in range(q + 1):
                total[t] *= factorial[n - q] * factorial[q - k] * factorial[k] / factorial[n + 3]
                t += 1


@jit(ARRAY(VERTICES, FACES, types.int64), allocates=True)
def volume_moments(vertices: Array, faces: Indices, degree: int) -> Array:
    """Return the integrals of x^i y^j z^k dV up to a total degree, in the order of moments.py; the first is the volume.

    The sums over the faces are compensated (Kahan).
    """
    size = (degree + 1) * (degree + 2) * (degree + 3) // 6
    corners = np.zeros((3, 3, LANES))
    h, sums, lost = np.zeros((size, LANES)), np.zeros((size, LANES)), np.zeros((size, LANES))
    for first in range(0, len(faces), LANES):
        gather(corners, vertices, faces, first)
        a, b, c = corners[0], corners[1], corners[2]
        h[:] = 0.0
        for lane in range(LANES):  # J, which all coefficients have as a factor
            h[0, lane] = dot(
                (a[0, lane], a[1, lane], a[2, lane]),
                cross((b[0, lane], b[1, lane], b[2, lane]), (c[0, lane], c[1, lane], c[2, lane])),
            )
        divide(h, degree, a)
        divide(h, degree, b)
        divide(h, degree, c)
        for t in range(size):
            for lane in range(LANES):
                term = h[t, lane] - lost[t, lane]
                longer = sums[t, lane] + term
                lost[t, lane] = (longer - sums[t, lane]) - term
                sums[t, lane] = longer
    total = np.zeros(size)
    for t in range(size):
        for lane in range(LANES):
            total[t] += sums[t, lane]
    factorial = np.ones(degree + 4)
    for n in range(1, degree + 4):
        factorial[n] = factorial[n - 1] * n
    factors(total, degree, factorial)
    return total
