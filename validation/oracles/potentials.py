"""Mutual potentials in closed form: homogeneous ellipsoids by Carlson's integrals, thin rods by logarithms.

All are for G m1 m2 = 1, in the axes of the first body, which is at the origin: the energy U, its gradient with respect
to the centre X of the second, and the moment M = sum (R rho) x dU/dx over the second body's mass, which is minus its
torque.
"""

from typing import NamedTuple

import numpy as np
from scipy.integrate import quad_vec
from scipy.special import elliprd, elliprf

TWO_DEGREES = 1 / 10  # the mean over an ellipsoid of f(x + rho) is f + D f/10 + D^2 f/280 + .., D = sum a_i^2 d_i^2
FOUR_DEGREES = 1 / 280


class Attraction(NamedTuple):
    """U, dU/dX (3,) and the moment M (3,)."""

    energy: float
    gradient: np.ndarray
    moment: np.ndarray


def field_of_ellipsoid(axes: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the potential (...) and its gradient (..., 3) of a homogeneous ellipsoid of unit G m at points outside.

    -3/4 times the integral of (1 - sum x_i^2/(a_i^2 + u))/sqrt(prod (a_i^2 + u)) from lambda to infinity, where lambda
    is the confocal coordinate of the point: Carlson's R_F and R_D (DLMF 19.16, 19.33).
    """
    t = np.square(axes) + _confocal(np.square(axes), np.square(x))[..., None]
    rf = elliprf(t[..., 0], t[..., 1], t[..., 2])
    rd = np.stack([elliprd(t[..., (i + 1) % 3], t[..., (i + 2) % 3], t[..., i]) for i in range(3)], axis=-1)
    return -1.5 * rf + 0.5 * np.sum(x**2 * rd, axis=-1), x * rd


def _confocal(axes2: np.ndarray, x2: np.ndarray) -> np.ndarray:
    """Return the root lambda of sum x_i^2/(a_i^2 + lambda) = 1; Newton's steps from below do not overshoot it."""
    root = np.maximum(0.0, x2.sum(axis=-1) - axes2.max())
    for _ in range(20):
        t = axes2 + root[..., None]
        root = root + (np.sum(x2 / t, axis=-1) - 1) / np.sum(x2 / t**2, axis=-1)
    return root


def sphere_and_ellipsoid(axes: np.ndarray, x: np.ndarray, r: np.ndarray) -> Attraction:
    """Return the attraction of a sphere and an ellipsoid with attitude r (3, 3) at x.

    The sphere feels no torque about its own centre, and all torques add up to zero: M = -X x dU/dX.
    """
    energy, gradient = field_of_ellipsoid(axes, r.T @ x)  # even in x
    gradient = r @ gradient
    return Attraction(float(energy), gradient, -np.cross(x, gradient))


def two_ellipsoids(one: np.ndarray, two: np.ndarray, x: np.ndarray, r: np.ndarray, nodes: int = 16) -> Attraction:
    """Return the attraction of two ellipsoids: the mean over the second, by a product rule, of the first one's field.

    ``nodes`` is the number of nodes of each of the three rules; what they leave falls exponentially.
    """
    points, weights = ball(nodes)
    arms = points * two @ r.T
    energy, gradient = field_of_ellipsoid(one, x + arms)
    return Attraction(float(weights @ energy), weights @ gradient, weights @ np.cross(arms, gradient))


def ball(nodes: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points (k, 3) and weights (k,) of the mean over the unit ball: Gauss, Gauss, and the trapezoidal rule."""
    s, w = np.polynomial.legendre.leggauss(nodes)
    radius, cosine, angle = np.meshgrid((s + 1) / 2, s, 2 * np.pi / nodes * np.arange(nodes), indexing="ij")
    sine = np.sqrt(1 - cosine**2)
    points = np.stack([radius * sine * np.cos(angle), radius * sine * np.sin(angle), radius * cosine], axis=-1)
    weights = 3 * radius**2 * (w[:, None, None] / 2) * (w[:, None] / 2) / nodes
    return points.reshape(-1, 3), weights.ravel()


def fourth_degree(one: np.ndarray, two: np.ndarray, x: np.ndarray, r: np.ndarray) -> Attraction:
    """Return all terms of total degree 4 of two ellipsoids; a sphere is one without size."""
    P, Q = np.diag(np.square(one)), r @ np.diag(np.square(two)) @ r.T
    energy, gradient, by_Q = 0.0, np.zeros(3), np.zeros((3, 3))
    for factor, first, second, times in (
        (FOUR_DEGREES, P, P, 0),
        (TWO_DEGREES**2, P, Q, 1),
        (FOUR_DEGREES, Q, Q, 2),
    ):
        value, slope, by_second = _two_operators(first, second, x)
        energy -= factor * value
        gradient -= factor * slope
        by_Q -= factor * times * by_second
    # a turn of the second body by delta makes dQ = [delta] Q - Q [delta], so dU = tr(by_Q dQ) = M . delta
    k = Q @ by_Q - by_Q @ Q
    return Attraction(float(energy), gradient, -2 * np.array([k[2, 1], k[0, 2], k[1, 0]]))


def _two_operators(P: np.ndarray, Q: np.ndarray, x: np.ndarray) -> tuple[float, np.ndarray, np.ndarray]:
    """Return T = (sum P_ij d_i d_j)(sum Q_ij d_i d_j) 1/r, its gradient, and its symmetric derivative by Q."""
    r = np.linalg.norm(x)
    Px, Qx, p, q = P @ x, Q @ x, x @ P @ x, x @ Q @ x
    trace_P, trace_Q = np.trace(P), np.trace(Q)
    s7 = trace_P * q + trace_Q * p + 4 * (Px @ Qx)
    s5 = trace_P * trace_Q + 2 * np.trace(P @ Q)
    value = 105 * p * q / r**9 - 15 * s7 / r**7 + 3 * s5 / r**5
    gradient = 210 * (q * Px + p * Qx) / r**9 - 30 * (trace_P * Qx + trace_Q * Px + 2 * (P @ Qx + Q @ Px)) / r**7
    gradient -= (945 * p * q / r**11 - 105 * s7 / r**9 + 15 * s5 / r**7) * x
    xx, Pxx = np.outer(x, x), np.outer(Px, x)
    by_Q = 105 * p * xx / r**9 - 15 * (trace_P * xx + p * np.eye(3) + 2 * (Pxx + Pxx.T)) / r**7
    return value, gradient, by_Q + 3 * (trace_P * np.eye(3) + 2 * P) / r**5


def collinear_rods(one: float, two: float, distance: float) -> Attraction:
    """Return the attraction of two thin rods of half-lengths ``one`` and ``two`` in one line, along x."""
    ends, signs = _ends(one, two, distance)
    scale = -1 / (4 * one * two)
    energy, force = scale * signs @ (ends * np.log(ends)), scale * signs @ np.log(ends)
    return Attraction(float(energy), np.array([force, 0, 0]), np.zeros(3))


def parallel_rods(one: float, two: float, distance: float, offset: float) -> Attraction:
    """Return the attraction of two parallel thin rods along x, the second at (distance, offset, 0)."""
    ends, signs = _ends(one, two, distance)
    scale = -1 / (4 * one * two)
    root, inverse = np.hypot(ends, offset), np.arcsinh(ends / offset)
    energy = scale * signs @ (ends * inverse - root)
    gradient = scale * np.array([signs @ inverse, -signs @ root / offset, 0])
    # the lateral pull on the second rod at s, whose end of the first is at w = distance + s +- one, times the arm s
    first = np.array([1, 1, -1, -1]) * one
    arm = (ends * root - offset**2 * inverse) / 2 - (distance + first) * root
    return Attraction(float(energy), gradient, np.array([0, 0, -scale * signs @ arm / offset]))


def _ends(one: float, two: float, distance: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the distances between the ends of two rods along x, and their signs in the double integral."""
    return distance + np.array([one + two, one - two, -one + two, -one - two]), np.array([1, -1, -1, 1])


def rod_and_rod(one: float, two: float, x: np.ndarray, axis: np.ndarray) -> Attraction:
    """Return the attraction of a thin rod along x and one along ``axis`` at x.

    It is a numerical integral, along the second, of the first one's field in closed form.
    """

    def density(s: float) -> np.ndarray:
        arm = s * axis
        energy, gradient = field_of_rod(one, x + arm)
        return np.concatenate([[energy], gradient, np.cross(arm, gradient)]) / (2 * two)

    values, _ = quad_vec(density, -two, two, epsabs=0, epsrel=1e-15, limit=200)
    return Attraction(float(values[0]), values[1:4], values[4:])


def field_of_rod(half: float, x: np.ndarray) -> tuple[float, np.ndarray]:
    """Return the potential and its gradient (3,) of a thin rod along x of unit G m, at a point off its line."""
    ends, across2 = x[0] + half * np.array([1, -1]), x[1] ** 2 + x[2] ** 2
    root = np.sqrt(ends**2 + across2)
    across = np.sqrt(across2)
    energy = -(np.arcsinh(ends[0] / across) - np.arcsinh(ends[1] / across)) / (2 * half)
    lateral = (ends[0] / root[0] - ends[1] / root[1]) / (2 * half * across2)
    along = -(1 / root[0] - 1 / root[1]) / (2 * half)
    return float(energy), np.array([along, lateral * x[1], lateral * x[2]])
