"""The mutual potential of two mass distributions, cut at a total degree N of both.

With rho1 in the secondary turned by R, rho2 in the primary, and a z axis along X, only equal orders m couple:

    U = -G m1 m2/r sum over l1 + l2 <= N of (l1 + l2)! r^-(l1 + l2) (-1)^(l1 + m) w_m (c1 c2 + s1 s2),

w_0 = 1 and w_m = 2, where c1 and s1 of l1, m and c2 and s2 of l2, m are the specific moments of the harmonics of
``harmonics.py`` about the mass centres; degree 1 vanishes. This is the expansion of 1/|X + R rho1 - rho2| in
L! R_L0(rho2 - R rho1)/r^(L + 1), with R_LM(a + b) = sum over l, m of R_lm(a) R_(L - l)(M - m)(b). Of its O(N^3)
products most are spent on bringing the moments into these axes, by turns about z and exchanges of x and z alone.

All this is plain Python on numbers of any kind, for both bodies side by side: on arrays it evaluates many
configurations, and on symbols it writes out the compiled kernels (``multipole_kernels.py``).
"""

from math import factorial
from typing import NamedTuple, TypeAlias

from binaryast.kernels.harmonics import exchange
from binaryast.kernels.lanes import Lanes, Number

Numbers: TypeAlias = list[Number]
POLE = 1e-40  # the square of an angle at which the azimuth of a direction does not matter


class Moments(NamedTuple):
    """The moments c and s of both bodies by degree and order, the secondary's times (-1)^l."""

    c: list[Numbers]
    s: list[Numbers]


class Aligned(NamedTuple):
    """Both bodies' moments, each degree over r^l, in axes e1, e2, e3 with e3 along X, in the primary's frame.

    The secondary's are in -e1, -e2, e3: half a turn more, which takes in (-1)^m.
    """

    moments: Moments
    inverse: Number  # 1/r
    e1: tuple[Number, Number, Number]
    e2: tuple[Number, Number, Number]
    e3: tuple[Number, Number, Number]


def multiples(cosine: Number, sine: Number, highest: int) -> tuple[Numbers, Numbers]:
    """Return cos(m a) and sin(m a) for m = 0 .. highest, each from those of two halves of m."""
    cosines, sines = [1.0, cosine], [0.0, sine]
    for m in range(2, highest + 1):
        i, j = m // 2, m - m // 2
        cosines.append(cosines[i] * cosines[j] - sines[i] * sines[j])
        sines.append(sines[i] * cosines[j] + cosines[i] * sines[j])
    return cosines, sines


def turned(c: Numbers, s: Numbers, angle: tuple[Numbers, Numbers]) -> tuple[Numbers, Numbers]:
    """Return the moments of one degree after a turn about z: (c_m + i s_m) e^(i m a)."""
    cosines, sines = angle
    orders = range(1, len(c))
    return (
        [c[0], *(c[m] * cosines[m] - s[m] * sines[m] for m in orders)],
        [0.0, *(c[m] * sines[m] + s[m] * cosines[m] for m in orders)],
    )


def exchanged(l: int, c: Numbers, s: Numbers, highest: int) -> tuple[Numbers, Numbers]:
    """Return the moments of degree l with (-z, y, x) in the place of (x, y, z), up to an order."""
    new_c, new_s = (
        [sum(row[m] * old[m] for m in range(l + 1) if row[m]) for row in matrix[: highest + 1]]
        for matrix, old in zip((matrix.tolist() for matrix in exchange(l)), (c, s), strict=True)
    )
    return new_c, new_s


def coupled_orders(l: int, degree: int) -> int:
    """Return up to which order degree l of one body meets degrees of the other: degree 0 alone, or 2 and more."""
    rest = degree - l
    return min(l, rest) if rest > 1 else 0


def needed_orders(l: int, degree: int) -> int:
    """Return up to which order energy and torque ask for degree l: a torque joins neighbouring orders."""
    return min(l, coupled_orders(l, degree) + 1)


def aligned(lanes: Lanes, moments: Moments, degree: int, x: Numbers, r: Numbers) -> Aligned:
    """Bring both bodies' moments into axes along X (3), given R (9, row by row).

    In each body's own frame X is r (st cx, st cy, ct). A turn about z takes it into the plane of y and z, the exchange
    into that of x and y, another turn onto x, and the exchange onto z. The axes in which it then is z are
    (-cy, cx, 0), (-ct cx, -ct cy, st) and X/r; the secondary has to be turned about X from its own to the primary's.
    """
    r11, r12, r13, r21, r22, r23, r31, r32, r33 = r
    square = x[0] * x[0] + x[1] * x[1] + x[2] * x[2]
    inverse = 1.0 / lanes.sqrt(square)
    px = lanes.pair(r11 * x[0] + r21 * x[1] + r31 * x[2], x[0])  # R^T X, X
    py = lanes.pair(r12 * x[0] + r22 * x[1] + r32 * x[2], x[1])
    pz = lanes.pair(r13 * x[0] + r23 * x[1] + r33 * x[2], x[2])
    across = px * px + py * py
    root = lanes.sqrt(across)
    cx = lanes.where_larger(across, POLE * square, px / root, 1.0)
    cy = lanes.where_larger(across, POLE * square, py / root, 0.0)
    both = lanes.pair(inverse, inverse)
    ct, st = pz * both, root * both

    a, b = lanes.second(cx), lanes.second(cy)
    e1 = (-b, a, 0.0)
    e2 = (-lanes.second(ct) * a, -lanes.second(ct) * b, lanes.second(st))
    e3 = (x[0] * inverse, x[1] * inverse, x[2] * inverse)
    a, b = lanes.first(cx), lanes.first(cy)
    f1 = (r12 * a - r11 * b, r22 * a - r21 * b, r32 * a - r31 * b)  # the secondary's first axis
    cosine, sine = (-(f1[0] * e[0] + f1[1] * e[1] + f1[2] * e[2]) for e in (e1, e2))

    first, second = multiples(cy, cx, degree), multiples(-ct, -st, degree)
    third = multiples(lanes.pair(cosine, 1.0), lanes.pair(sine, 0.0), degree)
    result = Moments(moments.c[:2], moments.s[:2])
    power = both
    for l in range(2, degree + 1):
        power = power * both
        c, s = turned(moments.c[l], moments.s[l], first)
        c, s = exchanged(l, c, s, l)
        c, s = turned(c, s, second)
        c, s = exchanged(l, c, s, needed_orders(l, degree))
        c, s = turned(c, s, third)
        result.c.append([power * element for element in c])
        result.s.append([power * element for element in s])
    return Aligned(result, inverse, e1, e2, e3)


class Coupling(NamedTuple):
    """What aligned moments make, for each body over G m1 m2/r: -U, its parts times the degree l, and the torque."""

    u: Number
    radial: Number
    tx: Number
    ty: Number
    tz: Number


def coupled(lanes: Lanes, moments: Moments, degree: int, lowest: int = 0) -> Coupling:
    """Return the sums over degrees l1 + l2 from the lowest up to N."""
    c, s = moments
    other_c, other_s = ([[lanes.swapped(number) for number in row] for row in part] for part in moments)
    u = radial = tx = ty = tz = 0.0
    for l in (0, *range(2, degree + 1)):
        gc, gs = [0.0] * (l + 1), [0.0] * (l + 1)  # how -U depends on c_m and s_m, but for w_m
        for m in range(coupled_orders(l, degree) + 1):
            for k in (0, *range(2, degree - l + 1)):
                if k >= m and l + k >= lowest:
                    gc[m] += float(factorial(l + k)) * other_c[k][m]
                    gs[m] += float(factorial(l + k)) * other_s[k][m]
        part = c[l][0] * gc[0]
        for m in range(1, needed_orders(l, degree) + 1):
            part += 2.0 * (c[l][m] * gc[m] + s[l][m] * gs[m])
            # turns about x and y take R_lm to its neighbours of orders m - 1 and m + 1
            up, down = l - m + 1.0, l + m + 0.0
            tx += up * (gc[m] * s[l][m - 1] - gs[m] * c[l][m - 1]) + down * (gc[m - 1] * s[l][m] - gs[m - 1] * c[l][m])
            ty += up * (gc[m] * c[l][m - 1] + gs[m] * s[l][m - 1]) - down * (gc[m - 1] * c[l][m] + gs[m - 1] * s[l][m])
            tz += 2.0 * m * (c[l][m] * gs[m] - s[l][m] * gc[m])
        u += part
        radial += float(l) * part
    return Coupling(u, radial, tx, ty, tz)


def evaluated(lanes: Lanes, monopole: Number, moments: Moments, degree: int, x: Numbers, r: Numbers) -> Numbers:
    """Return U, dU/dX (3) and M (3); ``monopole`` is G m1 m2.

    Bodies that are turned together about X keep U, so what is across X in the force makes up for both torques.
    """
    frame = aligned(lanes, moments, degree, x, r)
    sums = coupled(lanes, frame.moments, degree)
    first, second = lanes.first, lanes.second
    k = monopole * frame.inverse
    slope = k * frame.inverse
    along1 = slope * (second(sums.ty) - first(sums.ty))
    along2 = slope * (first(sums.tx) - second(sums.tx))
    along3 = slope * (first(sums.u) + first(sums.radial) + second(sums.radial))
    m1, m2, m3 = k * first(sums.tx), k * first(sums.ty), -k * first(sums.tz)
    axes = list(zip(frame.e1, frame.e2, frame.e3, strict=True))
    gradient = [along1 * e1 + along2 * e2 + along3 * e3 for e1, e2, e3 in axes]
    moment = [m1 * e1 + m2 * e2 + m3 * e3 for e1, e2, e3 in axes]
    return [-k * first(sums.u), *gradient, *moment]
