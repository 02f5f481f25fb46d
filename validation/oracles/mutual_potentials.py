"""Mutual potentials as heyoka's expressions, written down from their definitions; heyoka differentiates them."""

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


def second_moments(gm1: Any, m1: Any, m2: Any, Jd1: Array, Jd2: Array, x: Array, R1: Array, R2: Array) -> Any:
    """Return the same in inertial axes, from Taylor's series of 1/|x + rho| to second degree.

    U = -G m1 m2/|x| - (G/2) (m2 R1 J_d1 R1^T + m1 R2 J_d2 R2^T) : grad grad (1/|x|), which heyoka differentiates.
    """
    G = gm1 / m1
    y = np.array([hy.make_vars(f"place_{k}") for k in range(3)], dtype=object)
    hessian = np.array([[hy.diff(hy.diff(1.0 / norm(y), a), b) for b in y] for a in y], dtype=object)
    place = dict(zip(map(str, y), x, strict=True))
    second = np.array([[hy.subs(element, place) for element in row] for row in hessian], dtype=object)
    moments = m2 * (R1 @ np.diag(Jd1) @ R1.T) + m1 * (R2 @ np.diag(Jd2) @ R2.T)
    return -gm1 * m2 / norm(x) - 0.5 * G * (moments * second).sum()
