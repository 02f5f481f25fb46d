"""Mutual potentials as heyoka's expressions, written down from their definitions; heyoka differentiates them."""

from itertools import combinations_with_replacement
from typing import Any

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.gravity import Gravity
from validation.oracles.taylor import REAL, Array, Units, numbers


def points_of(body: ba.RigidBody, gravity: Gravity, units: Units) -> list[tuple[Array, Any]]:
    """Return the points (position in the body frame, share of the mass) that a body attracts with."""
    if isinstance(gravity, ba.PointMass) or isinstance(body.shape, (ba.Sphere, ba.Point)):
        return [(numbers(np.zeros(3).astype(REAL)), numbers(np.ones(1).astype(REAL))[0])]
    if not isinstance(gravity, ba.PointPairs) or not isinstance(body.shape, ba.Dumbbell):
        raise ValueError(f"expected a dumbbell, a sphere or a point and their points, got {body.shape}, {gravity}")
    half = body.shape.length.value / 2 / units.length
    return [(numbers(np.array([x, 0.0, 0.0]).astype(REAL)), hy.expression(REAL(0.5))) for x in (half, -half)]


def norm(d: Array) -> Any:
    """Return the length of a vector of expressions."""
    return hy.sqrt(d @ d)


def point_pairs(gm1: Any, m2: Any, points1: list[Any], points2: list[Any], d: Any) -> Any:
    """Return U = -G sum dm1 dm2/|d|, ``d(rho1, rho2)`` being the vector from one point to the other: (14)."""
    return sum(-gm1 * m2 * (f1 * f2) / norm(d(rho1, rho2)) for rho1, f1 in points1 for rho2, f2 in points2)


def maccullagh(gm1: Any, m1: Any, m2: Any, J1: Array, J2: Array, X: Array, R: Array) -> Any:
    """Return MacCullagh's U(X, R): both monopoles, and each body's moments of inertia on the other's mass."""
    r = norm(X)
    G = gm1 / m1
    JR = R @ np.diag(J1) @ R.T
    one = J1.sum() - 3.0 * (X @ JR @ X) / (r * r)
    two = J2.sum() - 3.0 * (X @ np.diag(J2) @ X) / (r * r)
    return -gm1 * m2 / r - G * m2 * one / (2.0 * r * r * r) - G * m1 * two / (2.0 * r * r * r)


def squares_of(body: ba.RigidBody, units: Units) -> Array:
    """Return the squares of an ellipsoid's semi-axes."""
    if not isinstance(body.shape, ba.Ellipsoid):
        raise ValueError(f"expected an ellipsoid, got {body.shape}")
    axes = np.array([axis.value / units.length for axis in (body.shape.a, body.shape.b, body.shape.c)]).astype(REAL)
    return numbers(axes * axes)


def ellipsoids(
    gm1: Any, m2: Any, squares1: Array, squares2: Array, x: Array, R1: Array, R2: Array, *, degree: int
) -> Any:
    """Return U of two homogeneous ellipsoids in any axes, from Taylor's series of 1/|x + rho| to degree 2 or 4.

    With D = sum a_i^2 (R e_i . grad)^2 the mean of f(x + R rho) over an ellipsoid is f + D f/10 + D^2 f/280 + ..;
    heyoka differentiates 1/|x|. Of second degree it holds for any body if a_i^2 is 5 J_d/m.
    """
    if degree not in (2, 4):
        raise ValueError(f"expected degree 2 or 4, got {degree}")
    tenth, small = (hy.expression(REAL(1.0) / REAL(n)) for n in (10.0, 280.0))  # not rounded to double
    D1, D2 = R1 @ np.diag(squares1) @ R1.T, R2 @ np.diag(squares2) @ R2.T
    total = 1.0 / norm(x) + tenth * contracted(derivatives(x, 2), D1 + D2)
    if degree == 4:
        fourth = derivatives(x, 4)
        total += small * (contracted(fourth, D1, D1) + contracted(fourth, D2, D2))
        total += tenth * tenth * contracted(fourth, D1, D2)
    return -gm1 * m2 * total


def derivatives(x: Array, order: int) -> Array:
    """Return all derivatives of an order of 1/|x|, as an array with so many axes of 3."""
    y = np.array([hy.make_vars(f"place_{k}") for k in range(3)], dtype=object)
    place = dict(zip(map(str, y), x, strict=True))
    known = {(): 1.0 / norm(y)}
    for k in range(order):
        for indices in combinations_with_replacement(range(3), k + 1):
            known[indices] = hy.diff(known[indices[:-1]], y[indices[-1]])
    result = np.empty((3,) * order, dtype=object)
    for indices in np.ndindex(result.shape):
        result[indices] = hy.subs(known[tuple(sorted(indices))], place)
    return result


def contracted(tensor: Array, *matrices: Array) -> Any:
    """Return the sum of a tensor's elements times those of symmetric matrices, one for each two of its axes."""
    for matrix in matrices:
        tensor = (tensor * matrix).sum(axis=(-2, -1))
    return tensor
