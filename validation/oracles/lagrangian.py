"""The motion from the Lagrangian (15) alone: heyoka forms the Euler-Lagrange equations in twelve coordinates or more.

Nothing here knows an equation of motion, a moment or a reduced variable. Coordinates of a body are its position and
three angles, R = R(0) Rz Ry Rx, which are regular while the second stays away from a right angle: short arcs.
"""

from typing import Any

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.oracles import mutual_potentials, taylor
from validation.oracles.taylor import REAL, Array, Start, Units, numbers, variables


def rotation(angles: Array) -> Array:
    """Return Rz Ry Rx of three angles, of expressions or of numbers."""
    cosine, sine = (np.cos, np.sin) if angles.dtype == REAL else (hy.cos, hy.sin)
    (cz, cy, cx), (sz, sy, sx) = ([f(angle) for angle in angles] for f in (cosine, sine))
    return np.array(
        [
            [cz * cy, cz * sy * sx - sz * cx, cz * sy * cx + sz * sx],
            [sz * cy, sz * sy * sx + cz * cx, sz * sy * cx - cz * sx],
            [-sy, cy * sx, cy * cx],
        ]
    )


def rates(angles: Array, Omega: Array) -> Array:
    """Return the rates of the angles of a spin in the body frame."""
    _, y, x = angles
    z_rate = (Omega[1] * np.sin(x) + Omega[2] * np.cos(x)) / np.cos(y)
    return np.array([z_rate, Omega[1] * np.cos(x) - Omega[2] * np.sin(x), Omega[0] + z_rate * np.sin(y)])


def spin(angles: Array, rate: Array) -> Array:
    """Return the spin in the body frame of the rates of the angles."""
    _, y, x = angles
    z_rate, y_rate, x_rate = rate
    return np.array(
        [
            x_rate - z_rate * np.sin(y),
            y_rate * np.cos(x) + z_rate * np.sin(x) * np.cos(y),
            z_rate * np.cos(x) * np.cos(y) - y_rate * np.sin(x),
        ]
    )


class LagrangianMotion:
    """The motion of any number of bodies by (15), in units of order one."""

    def __init__(self, system: ba.System, state: ba.State) -> None:
        self.system, self.units = system, Units.of(system, state)
        self.start = Start.of(system, state, self.units)
        self.rigid = [not body.is_point for body in system.bodies]
        n = len(system.bodies)
        self.x, self.dx = variables("x", n, 3), variables("v", n, 3)
        self.angles, self.dangles = variables("angle", n, 3), variables("rate", n, 3)
        self.R = [numbers(self.start.R[i]) @ rotation(self.angles[i]) for i in range(n)]
        coordinates = [*self.x.ravel(), *self.angles[self.rigid].ravel()]
        velocities = [*self.dx.ravel(), *self.dangles[self.rigid].ravel()]
        self.equations = hy.lagrangian(self._kinetic() - self._potential(), coordinates, velocities)

    def _kinetic(self) -> Any:
        """Return T of (12): tr(S J_d S^T)/2 is tr(R' J_d R'^T)/2, R' = R S."""
        m, J = numbers(self.start.m), self._nonstandard()
        total = sum(0.5 * m[i] * (self.dx[i] @ self.dx[i]) for i in range(len(m)))
        for i in np.flatnonzero(self.rigid):
            pairs = list(zip(self.angles[i], self.dangles[i], strict=True))
            dot_R = [[sum(hy.diff(element, q) * dq for q, dq in pairs) for element in row] for row in self.R[i]]
            total += 0.5 * sum(J[i][k] * dot_R[p][k] * dot_R[p][k] for p in range(3) for k in range(3))
        return total

    def _nonstandard(self) -> Array:
        """Return J_d of each body, J = tr(J_d) I - J_d."""
        J = self.start.J
        return numbers(REAL(0.5) * J.sum(axis=1)[:, None] - J)

    def _potential(self) -> Any:
        """Return U of all pairs, in inertial coordinates."""
        m, gm, Jd = numbers(self.start.m), numbers(self.start.gm), self._nonstandard()
        total = 0.0
        for pair in self.system.pairs:
            two, one = pair.primary, pair.secondary
            x, R1, R2 = self.x[one] - self.x[two], self.R[one], self.R[two]
            if isinstance(pair.gravity, ba.Multipole):
                squares = [mutual_potentials.squares_of(self.system.bodies[i], self.units) for i in (one, two)]
                degree = pair.gravity.degree
                total += mutual_potentials.ellipsoids(gm[one], m[two], *squares, x, R1, R2, degree=degree)
                continue
            if isinstance(pair.gravity, ba.SecondDegree):
                squares = [5.0 * Jd[i] / m[i] for i in (one, two)]
                total += mutual_potentials.ellipsoids(gm[one], m[two], *squares, x, R1, R2, degree=2)
                continue
            bodies = [self.system.bodies[i] for i in (one, two)]
            sets = [mutual_potentials.points_of(body, pair.gravity, self.units) for body in bodies]

            def d(rho1: Array, rho2: Array, x: Array = x, R1: Array = R1, R2: Array = R2) -> Array:
                return x + R1 @ rho1 - R2 @ rho2

            total += mutual_potentials.point_pairs(gm[one], m[two], *sets, d)
        return total

    def at(self, time: float, *, precise: bool = True) -> Snapshot:
        """Return where the bodies are after a time [s], in SI and in quadruple precision."""
        s, n, k = self.start, len(self.x), sum(self.rigid)
        zero = np.zeros(3).astype(REAL)
        angle_rates = np.array([rates(zero, Omega) for Omega in s.Omega])[self.rigid]
        y = np.concatenate([s.x.ravel(), np.zeros(3 * k).astype(REAL), s.v.ravel(), angle_rates.ravel()])
        y = taylor.integrate(self.equations, y, time / self.units.time, precise=precise)
        x, angles, v, rate = np.split(y, np.cumsum([3 * n, 3 * k, 3 * n]))
        R, Omega = s.R.copy(), s.Omega.copy()
        for i, a, b in zip(np.flatnonzero(self.rigid), angles.reshape(k, 3), rate.reshape(k, 3), strict=True):
            R[i], Omega[i] = s.R[i] @ rotation(a), spin(a, b)
        return taylor.in_si(Snapshot(v.reshape(n, 3), Omega, x.reshape(n, 3), R), self.units)
