"""Trees of the faces of a body, for the surface integrals of `binaryast.PolyhedronPair`.

A rule is a set of nodes x_i with vector weights w_i, so that the sum of w_i p(x_i) is the integral of rho n p dA for
every polynomial p up to a degree. A face has that of its triangle. A cluster takes as many of the nodes of its parts as
there are polynomials, those that tell the polynomials apart best, and weights that keep all the integrals. Moments of
mass are integrals of rho n p dA by Gauss's theorem: the whole body's rule has them all up to one degree less.
"""

from typing import NamedTuple

import numpy as np

from binaryast.kernels.mutual import polyhedra
from binaryast.kernels.selection import select
from binaryast.units import Floats, Indices

# Rules for triangles, of even degrees: in each line the weight of a point of an orbit, and two of the three
# barycentric coordinates, whose permutations are the orbit.
# D. A. Dunavant, Int. J. Numer. Methods Eng. 21 (1985) 1129; brought to the last digit by the order conditions.
ORBITS: dict[int, list[tuple[float, float, float]]] = {
    6: [
        (0.1167862757263794, 0.2492867451709104, 0.2492867451709104),
        (0.05084490637020682, 0.06308901449150223, 0.06308901449150223),
        (0.08285107561837356, 0.05314504984481694, 0.3103524510337844),
    ],
    8: [
        (0.1443156076777872, 1 / 3, 1 / 3),
        (0.09509163426728459, 0.4592925882927232, 0.4592925882927232),
        (0.10321737053471824, 0.17056930775176024, 0.17056930775176024),
        (0.03245849762319808, 0.05054722831703097, 0.05054722831703097),
        (0.027230314174435007, 0.008394777409957643, 0.26311282963463806),
    ],
}
FROM = {6: 1e-4, 8: 0.0}  # from which accuracy on a degree is the fastest, as measured
SCALE = 0.007  # the factor of the estimated error: the largest error of dU/dX that was measured, near contact, over it
EQUAL = 1e-13  # a node that tells polynomials apart by less than this, over the first one, is not needed


class Surface(NamedTuple):
    """Triangles (F, 3, 3) [m] in the body frame and the density (F,) behind each, of a body of mass one [1/m3]."""

    triangles: Floats
    densities: Floats


class Rule(NamedTuple):
    """Nodes (n, 3) and vector weights (n, 3)."""

    nodes: Floats
    weights: Floats


def face_rule(degree: int) -> Floats:
    """Return weights and two coordinates (n, 3) of the rule of a triangle, of area one: a + s (b - a) + t (c - a)."""
    rows = []
    for weight, s, t in ORBITS[degree]:
        orbit = {(round(a, 12), round(b, 12)): (a, b) for a, b in _permutations(s, t)}
        rows += [(weight, a, b) for a, b in orbit.values()]
    rule = np.array(rows)
    rule[:, 0] /= rule[:, 0].sum()
    return rule


def _permutations(s: float, t: float) -> list[tuple[float, float]]:
    """Return the six places of a point with barycentric coordinates s, t and the rest."""
    rest = 1 - s - t
    return [(s, t), (t, s), (s, rest), (rest, s), (t, rest), (rest, t)]


def polynomials(points: Floats, degree: int) -> Floats:
    """Return products of Legendre's polynomials up to a total degree at points (n, 3) of the cube: (n, count)."""
    powers = np.indices((degree + 1,) * 3).reshape(3, -1)
    x, y, z = points.T
    table = np.polynomial.legendre.legvander3d(x, y, z, [degree] * 3)
    return np.asarray(table[:, powers.sum(axis=0) <= degree])


def reduced(rule: Rule, degree: int) -> Rule:
    """Return a rule of fewer nodes with the same integrals of all polynomials up to a degree."""
    low, high = rule.nodes.min(axis=0), rule.nodes.max(axis=0)
    values = polynomials((2 * rule.nodes - low - high) / (high - low).max(), degree)
    if values.shape[0] <= values.shape[1]:
        return rule
    chosen, weights = np.zeros(values.shape[1], dtype=np.int64), np.zeros((values.shape[1], 3))
    sums = np.ascontiguousarray(rule.weights.T @ values)
    count = select(chosen, weights, np.ascontiguousarray(values), sums, EQUAL)
    return Rule(rule.nodes[chosen[:count]], weights[:count])


class Tree:
    """The elements of one body, laid out one after the other, parts of one element side by side.

    Parameters
    ----------
    surface : Surface
        The body.
    degree : int
        The even degree of its rules.
    start : int
        Where in the parameters it begins.
    """

    def __init__(self, surface: Surface, degree: int, start: int) -> None:
        self.surface, self.degree, self.start = surface, degree, start
        self.edges = surface.triangles[:, 1:] - surface.triangles[:, :1]
        self.areas = np.cross(self.edges[:, 0], self.edges[:, 1]) / 2 * surface.densities[:, None]
        self.charges = np.linalg.norm(self.areas, axis=1)
        self.centroids = surface.triangles.mean(axis=1)
        self.rule = face_rule(degree)
        count = (degree + 1) * (degree + 2) * (degree + 3) // 6
        self.few = max(1, count // len(self.rule))  # so many faces have no more nodes than a cluster
        self.blocks: list[Floats] = []
        self.size = 0
        root = self._room(polyhedra.ELEMENT)
        self._element(root, np.arange(len(self.areas)))

    @property
    def values(self) -> Floats:
        """All of it as one array."""
        return np.concatenate(self.blocks)

    def _room(self, size: int) -> Floats:
        """Return a new block at the end."""
        block = np.zeros(size)
        self.blocks.append(block)
        self.size += size
        return block

    def _put(self, values: Floats) -> int:
        """Append values and return where in the parameters they are."""
        place = self.start + self.size
        self._room(values.size)[:] = values.ravel()
        return place

    def _element(self, record: Floats, members: Indices) -> Rule:
        """Fill the record of an element, after its parts, and return its rule."""
        if len(members) == 1:
            rule = self._face(record, int(members[0]))
        else:
            groups = self._groups(members)
            record[polyhedra.PARTS] = len(groups)
            record[polyhedra.PARTS_AT] = self.start + self.size
            records = self._room(polyhedra.ELEMENT * len(groups)).reshape(len(groups), -1)
            rules = [self._element(one, group) for one, group in zip(records, groups, strict=True)]
            rule = Rule(*(np.concatenate(parts) for parts in zip(*rules, strict=True)))
            rule = reduced(rule, self.degree)
        corners = self.surface.triangles[members].reshape(-1, 3)
        centre = (corners.min(axis=0) + corners.max(axis=0)) / 2 if len(members) > 1 else corners.mean(axis=0)
        record[:3] = centre
        record[polyhedra.RADIUS] = np.linalg.norm(corners - centre, axis=1).max()
        record[polyhedra.CHARGE] = self.charges[members].sum()
        record[polyhedra.NODES] = len(rule.nodes)
        record[polyhedra.NODES_AT] = self._put(np.concatenate([rule.nodes.T, rule.weights.T]))
        return rule

    def _face(self, record: Floats, face: int) -> Rule:
        """Keep the corners of a face, and return its rule."""
        corners = self.surface.triangles[face]
        record[polyhedra.FACE_AT] = self._put(np.concatenate([corners.ravel(), self.areas[face]]))
        nodes = corners[0] + self.rule[:, 1:] @ self.edges[face]
        return Rule(nodes, self.rule[:, :1] * self.areas[face])

    def _groups(self, members: Indices) -> list[Indices]:
        """Return the faces one by one where they are few, else two halves across their longest extent."""
        if len(members) <= self.few:
            return [members[i : i + 1] for i in range(len(members))]
        places = self.centroids[members]
        order = np.argsort(places[:, np.argmax(np.ptp(places, axis=0))], kind="stable")
        half = len(members) // 2
        return [members[order[:half]], members[order[half:]]]


def parameters_of(secondary: Surface, primary: Surface, *, gravity: float, accuracy: float) -> Floats:
    """Return what ``kernels/mutual/polyhedra.py`` needs.

    ``gravity`` is G m1 m2 for densities of bodies of mass one, ``accuracy`` the relative error that is asked for.
    """
    degree = next(degree for degree, lowest in FROM.items() if accuracy >= lowest)
    rule = face_rule(degree)
    header = np.zeros(polyhedra.HEADER)
    one = Tree(secondary, degree, polyhedra.HEADER + rule.size)
    two = Tree(primary, degree, polyhedra.HEADER + rule.size + one.size)
    reach = sum(float(np.linalg.norm(body.triangles, axis=-1).max()) for body in (secondary, primary))
    header[polyhedra.STRENGTH] = gravity / 2
    header[polyhedra.SCALE], header[polyhedra.REACH] = SCALE / accuracy, reach
    header[polyhedra.POWER] = degree // 2 + 1
    header[polyhedra.SECONDARY], header[polyhedra.PRIMARY] = one.start, two.start
    header[polyhedra.COUNT], header[polyhedra.RULE] = len(rule), polyhedra.HEADER
    return np.concatenate([header, rule.T.ravel(), one.values, two.values])
