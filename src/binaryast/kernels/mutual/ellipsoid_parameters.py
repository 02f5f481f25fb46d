"""What the exact potential of two ellipsoids needs: whose field is taken, and rules for the mean over the other one.

The field of a homogeneous ellipsoid is harmonic outside it, and the mean of a harmonic function over an ellipsoid
a >= b >= c is its mean over the focal disc, the ellipse of semi-axes h = sqrt(a^2 - c^2) and k = sqrt(b^2 - c^2) in the
plane of the two long axes, with a density as sqrt(1 - x^2/h^2 - y^2/k^2) (Maclaurin's theorem on confocal ellipsoids):
two integrals in the place of three, one for a spheroid of equal short axes, and none for a sphere. With x = h s and
y = k t sqrt(1 - s^2) the density is (1 - s^2) sqrt(1 - t^2): a product of two Gauss rules.

A Gauss rule of n nodes errs by rho^(-2n), where rho is the sum of the semi-axes of the ellipse with foci at the ends
-1 and 1 within which the function is regular. Here these ellipses belong to an ellipsoid a^2 + q, b^2 + q, c^2 + q,
confocal with the body, that does not reach the focal disc of the other one, to which that one's field can be continued:
across the disc rho is (sqrt(b^2 + q) + sqrt(c^2 + q))/k, along it (sqrt(a^2 + q) + sqrt(c^2 + q))/h. Masses off the rim
of the disc are resolved at the rate of their distance alone, log rho = asinh((sqrt(b^2 + q) - k)/h), but they are few:
`RIM`, found by trial, is what they may leave. So q says how many nodes are needed. There is a rule for each of several
q; the kernel takes the coarsest that leaves no more than round-off, so that the potential of a run is smooth to
round-off.
"""

from functools import lru_cache
from typing import NamedTuple

import numpy as np

from binaryast.kernels.moments import Floats

ROUNDOFF, RIM = 1e-16, 1e-9  # rho^(-2n) of all rules
STEP = 2.5  # from the q of a rule to the next
COARSEST = 4  # nodes along the long axis
LARGEST_RULE = 20_000  # nodes
# where in the parameters: G m1 m2; 1 where the nodes are in the secondary, -1 in the primary; squares of the semi-axes
# and of those of the focal disc (3 each) of the body whose field is taken; squares of the semi-axes of the one with the
# nodes (3); how many rules. Then q, first and count of each rule, coarsest first; then x, y, z, weight of each node.
SIDE, FIELD, DISC, NODES, RULES, HEADER = 1, 2, 5, 8, 11, 12
RULE, NODE = 3, 4


class Rules(NamedTuple):
    """Rules for the mean over an ellipsoid, the coarsest first: for each its q, and how many nodes along each axis."""

    axes: Floats
    q: list[float]
    counts: list[tuple[int, int]]

    @property
    def largest(self) -> int:
        """How many nodes the finest has."""
        return self.counts[-1][0] * self.counts[-1][1]


def parameters_of(monopole: float, secondary: Floats, primary: Floats) -> Floats:
    """Return the parameters from G m1 m2 and the semi-axes (3,) of both bodies; none where no rule is fine enough.

    The nodes are in the body that needs fewer at contact, as a rule the smaller one.
    """
    one, two = rules_of(secondary, primary), rules_of(primary, secondary)
    side, rules, field = (1.0, one, primary) if one.largest <= two.largest else (-1.0, two, secondary)
    if rules.largest > LARGEST_RULE:
        return np.zeros(0)
    squares = field**2
    header = [monopole, side, *squares, *(squares - squares.min()), *rules.axes**2, len(rules.q)]
    nodes = [nodes_of(rules.axes, *counts) for counts in rules.counts]
    first = HEADER + RULE * len(nodes)
    table: list[float] = []
    for q, rule in zip(rules.q, nodes, strict=True):
        table += [q, first, len(rule)]
        first += rule.size
    return np.concatenate([header, table, *(rule.ravel() for rule in nodes)])


def rules_of(axes: Floats, other: Floats) -> Rules:
    """Return the rules for an ellipsoid beside another, down to that for contact."""
    a, b, c = np.sort(axes)[::-1]
    # the focal disc of the other stays as far inside its surface as the focus of its longest section
    longest, shortest = other.max(), other.min()
    margin = shortest**2 / (longest + np.sqrt(longest**2 - shortest**2))
    q = [margin * (2 * c + margin)]
    counts = [_counts(q[0], a, b, c)]
    while counts[-1][0] > COARSEST:
        q.append(STEP * q[-1])
        counts.append(_counts(q[-1], a, b, c))
    return Rules(axes, q[::-1], counts[::-1])


def _counts(q: float, a: float, b: float, c: float) -> tuple[int, int]:
    """Return the numbers of nodes along the long and the middle axis of an ellipsoid."""
    h, k = np.sqrt(a * a - c * c), np.sqrt(b * b - c * c)
    middle, short = np.sqrt(b * b + q), np.sqrt(c * c + q)
    rim = _count((middle - k) / h, RIM) if h > 0 else 1
    return (
        max(_count(short / h, ROUNDOFF), rim) if h > 0 else 1,
        _count(short / k, ROUNDOFF) if k > 0 else 1,
    )


def _count(sinh: float, left: float) -> int:
    """Return the number of nodes that leave rho^(-2n) at log rho = asinh of this."""
    return int(np.ceil(-0.5 * np.log(left) / np.arcsinh(sinh)))


def nodes_of(axes: Floats, along: int, across: int) -> Floats:
    """Return nodes on the focal disc of an ellipsoid and their weights (k, 4): x, y, z and a part of one."""
    order = np.argsort(-axes, kind="stable")
    a, b, c = axes[order]
    s, ws = _gauss(along)
    angle = np.pi * np.arange(1, across + 1) / (across + 1)
    t, wt = np.cos(angle), np.sin(angle) ** 2 * 2 / (across + 1)  # Chebyshev's second kind
    result = np.zeros((along, across, NODE))
    result[:, :, order[0]] = np.sqrt(a * a - c * c) * s[:, None]
    result[:, :, order[1]] = np.sqrt(b * b - c * c) * np.sqrt(1 - s**2)[:, None] * t
    result[:, :, 3] = ws[:, None] * wt
    return result.reshape(-1, NODE)


@lru_cache
def _gauss(count: int) -> tuple[Floats, Floats]:
    """Return nodes and weights of the mean over -1 .. 1 with the density 1 - s^2, by Golub and Welsch."""
    k = np.arange(1, count)
    beside = np.sqrt(k * (k + 2) / ((2 * k + 1) * (2 * k + 3)))
    nodes, vectors = np.linalg.eigh(np.diag(beside, 1) + np.diag(beside, -1))
    weights = vectors[0] ** 2
    return (nodes - nodes[::-1]) / 2, (weights + weights[::-1]) / 2
