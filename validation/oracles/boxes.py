"""Two homogeneous boxes by volume integrals: neither surfaces nor triangles.

For G m1 m2 = 1, in the axes of the first box, which is at the origin, as in ``potentials.py``.
"""

from itertools import pairwise

import numpy as np

from validation.oracles.potentials import Attraction


def parallel(one: np.ndarray, two: np.ndarray, x: np.ndarray, nodes: int) -> Attraction:
    """Return the attraction of boxes of half-sizes ``one`` and ``two``, their axes parallel, the second at x.

    The integrals over both of a function of their points' difference d are one over d, with a weight for each axis: the
    length over which both points can move together, or the first moment of it for the arm. The weights are polynomials
    between their kinks, where Gauss's rules of so many nodes are used.
    """
    axes = [_weights(a, b, c, nodes) for a, b, c in zip(one, two, x, strict=True)]
    d = np.stack(np.meshgrid(*[axis[0] for axis in axes], indexing="ij"), axis=-1)
    inverse = 1 / np.linalg.norm(d, axis=-1)
    masses = 1 / (64 * np.prod(one) * np.prod(two))
    lengths = [axis[1] for axis in axes]
    energy = -masses * np.einsum("i,j,k,ijk", *lengths, inverse)
    pull = d * inverse[..., None] ** 3
    gradient = masses * np.einsum("i,j,k,ijkl->l", *lengths, pull)
    moment = np.zeros(3)
    for i in range(3):  # the arm along one axis, the pull along another
        first = [axes[k][2 if k == i else 1] for k in range(3)]
        arm = masses * np.einsum("i,j,k,ijkl->l", *first, pull)
        moment += np.cross(np.eye(3)[i], arm)
    return Attraction(float(energy), gradient, moment)


def _weights(one: float, two: float, x: float, nodes: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return nodes of d = x + s - t with |s| < two, |t| < one, and weights of the integrals of 1 and of s."""
    kinks = np.unique(x + np.array([-two - one, -two + one, two - one, two + one]))
    g, w = np.polynomial.legendre.leggauss(nodes)
    d = np.concatenate([(a + b) / 2 + (b - a) / 2 * g for a, b in pairwise(kinks)])
    w = np.concatenate([(b - a) / 2 * w for a, b in pairwise(kinks)])
    low, high = np.maximum(-two, d - x - one), np.minimum(two, d - x + one)  # where s can be
    return d, w * (high - low), w * (high**2 - low**2) / 2


def turned(one: np.ndarray, two: np.ndarray, x: np.ndarray, r: np.ndarray, nodes: int) -> Attraction:
    """Return the same with an attitude r (3, 3) of the second: both as point masses at Gauss's nodes, every pair."""
    g, w = np.polynomial.legendre.leggauss(nodes)
    points = np.stack(np.meshgrid(g, g, g, indexing="ij"), axis=-1).reshape(-1, 3)
    weights = np.prod(np.stack(np.meshgrid(w, w, w, indexing="ij"), axis=-1).reshape(-1, 3), axis=1) / 8
    energy, gradient, moment = 0.0, np.zeros(3), np.zeros(3)
    for arm, weight in zip(points * two @ r.T, weights, strict=True):
        d = x + arm - points * one
        inverse = 1 / np.linalg.norm(d, axis=1)
        pull = weight * (weights * inverse**3) @ d
        energy -= weight * float(weights @ inverse)
        gradient += pull
        moment += np.cross(arm, pull)
    return Attraction(energy, gradient, moment)
