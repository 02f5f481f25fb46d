"""A pair for heyoka's Taylor integrator, as friendly to it as we can: variables of order one, few products.

The variables are relative position and velocity, in the primary's turning axes or in inertial ones, the quaternion of
the relative attitude R, that of the primary, and both spins, each in its own body's axes. Nothing here comes from the
package's own expressions: gravity is that of ``one_ellipsoid.py``, ``degree_four.py`` and ``two_ellipsoids.py``, or
the sum over pairs of points below.
"""

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import heyoka as hy
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.benchmark import degree_four, two_ellipsoids
from validation.benchmark.expressions import Exerted, InversePowers, Place, cross
from validation.benchmark.one_ellipsoid import pure_gradient
from validation.oracles import taylor
from validation.oracles.taylor import REAL, Start, Units

AXES = ("primary", "inertial")  # of relative position and velocity
Vector = Any  # three expressions


def matrix(q: Vector) -> Any:
    """Return the rotation matrix of a unit quaternion, scalar last."""
    x, y, z, w = q
    xx, yy, zz = x * x, y * y, z * z
    xy, xz, yz, wx, wy, wz = x * y, x * z, y * z, w * x, w * y, w * z
    return np.array(
        [
            [1.0 - 2.0 * (yy + zz), 2.0 * (xy - wz), 2.0 * (xz + wy)],
            [2.0 * (xy + wz), 1.0 - 2.0 * (xx + zz), 2.0 * (yz - wx)],
            [2.0 * (xz - wy), 2.0 * (yz + wx), 1.0 - 2.0 * (xx + yy)],
        ]
    )


def product_with(q: Vector, a: Vector, sign: float) -> Vector:
    """Return twice the product of a quaternion and a vector, the vector to its right (1) or to its left (-1)."""
    c = cross(q[:3], a)
    return np.array([*(q[3] * a[i] + sign * c[i] for i in range(3)), -hy.sum([q[i] * a[i] for i in range(3)])])


class HeyokaProblem:
    """The equations of a pair and its start.

    Parameters
    ----------
    system, state
        Two ellipsoids with `binaryast.Multipole` of an even degree, or bodies of points with `binaryast.PointPairs`.
    axes : {"primary", "inertial"}
        Those of position and velocity.
    kind : type
        The floating-point type, such as float or numpy.longdouble.
    expanded : bool
        Of pairs of points: whether |p - rho|^2 is written as |p|^2 + |rho|^2 - 2 p.rho, which spares six products in
        seven, or as the sum of the squares of p - rho, as one writes it.
    """

    def __init__(
        self,
        system: ba.System,
        state: ba.State,
        *,
        axes: str = "primary",
        kind: type = float,
        expanded: bool = True,
    ) -> None:
        self.system, self.kind, self.expanded = system, kind, expanded
        self.inertial = axes == "inertial"
        self.relative = not (self.inertial and isinstance(system.gravity, ba.Multipole) and system.gravity.degree < 4)
        self.units = Units.of(system, state)
        self.start = Start.of(system, state, self.units)
        self.equations = self._equations()

    def constant(self, value: Any) -> Any:
        """Return a constant of the integrator's precision."""
        if isinstance(value, Fraction):
            value = REAL(value.numerator) / REAL(value.denominator)
        return hy.expression(rounded(value, self.kind))

    def _equations(self) -> list[tuple[Any, Any]]:
        x, v, spin2, spin1 = (np.array(hy.make_vars(*(f"{name}{i}" for i in "xyz"))) for name in ("p", "v", "S", "s"))
        q, q2 = (np.array(hy.make_vars(*(f"{name}{i}" for i in "xyzw"))) for name in ("r", "Q"))
        R = matrix(q)  # of the secondary, from its own axes to inertial ones or to the primary's
        dot_q, dot_q2 = 0.5 * product_with(q, spin1, 1.0), 0.5 * product_with(q2, spin2, 1.0)
        R2 = matrix(q2) if self.inertial else None
        X = R2.T @ x if self.inertial else x
        if self.relative:
            dot_q = dot_q - 0.5 * product_with(q, spin2, -1.0)
        exerted = self._exerted(X, R.T @ (X if self.relative else x), R)
        m = self.start.m
        scale = self.constant((m[0] + m[1]) / (m[0] * m[1]))
        if self.relative:
            force = exerted.force2 + R @ exerted.force1
            force = R2 @ force if self.inertial else force
        else:
            force = R2 @ exerted.force2 + R @ exerted.force1
        acceleration = scale * (exerted.radial * x + force)
        if self.inertial:
            dot_x, dot_v = v, acceleration
        else:
            dot_x, dot_v = v - cross(spin2, x), acceleration - cross(spin2, v)
        dot_spin2 = self._euler(spin2, self.start.J[0], exerted.torque2)
        dot_spin1 = self._euler(spin1, self.start.J[1], exerted.torque1)
        names = np.concatenate([x, v, q, q2, spin2, spin1])
        return list(zip(names, np.concatenate([dot_x, dot_v, dot_q, dot_q2, dot_spin2, dot_spin1]), strict=True))

    def _euler(self, spin: Vector, J: Any, torque: Vector) -> Vector:
        """Return Euler's equations."""
        result = []
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            result.append(
                self.constant((J[j] - J[k]) / J[i]) * (spin[j] * spin[k]) + self.constant(1 / J[i]) * torque[i]
            )
        return np.array(result)

    def _exerted(self, X: Vector, Y: Vector, R: Any) -> Exerted:
        gravity = self.system.gravity
        if isinstance(gravity, ba.PointPairs):
            return self._of_points(X, R)
        if isinstance(gravity, ba.Multipole):
            return self._of_ellipsoids(X, Y, R, gravity.degree)
        raise ValueError(f"gravity: expected PointPairs or Multipole, got {gravity!r}")

    def _of_ellipsoids(self, X: Vector, Y: Vector, R: Any, degree: int) -> Exerted:
        """Return what ellipsoids exert on each other to a total degree."""
        k = self.constant(self.start.gm[1] * self.start.m[0])
        squares2, squares1 = (self._squares(body) for body in self.system.bodies)
        x2 = [part * part for part in X]
        at = Place(X, Y, x2, [part * part for part in Y[:2]], R, InversePowers(hy.sum(x2)))
        force2 = pure_gradient(squares2, degree, X, at.x2, at.r, self.constant)
        force1 = pure_gradient(squares1, degree, Y, at.y2, at.r, self.constant)
        parts = [Exerted(-at.r[3], force2, force1, -cross(X, force2), -cross(Y, force1))]
        if degree == 4:
            parts.append(degree_four.exerted(squares1, squares2, at, self.constant))
        elif degree > 4:
            parts.append(two_ellipsoids.exerted(squares1, squares2, degree, at, self.constant))
        return Exerted(*(k * sum(part[1:], part[0]) for part in zip(*parts, strict=True)))

    def _squares(self, body: ba.RigidBody) -> list[Any]:
        """Return the squares of an ellipsoid's semi-axes."""
        axes = [REAL(axis.value / self.units.length) for axis in (body.shape.a, body.shape.b, body.shape.c)]
        return [self.constant(axis * axis) for axis in axes]

    def _points(self, body: ba.RigidBody) -> tuple[Any, Any]:
        """Return the points of a body in units of length, and their shares of its mass."""
        points, shares = points_of(body)
        return (points / self.units.length).astype(REAL), shares.astype(REAL)

    def _of_points(self, X: Vector, R: Any) -> Exerted:
        """Return what sets of points exert on each other."""
        k = self.start.gm[1] * self.start.m[0]
        (points2, shares2), (points1, shares1) = (self._points(body) for body in self.system.bodies)
        force, moment = [[], [], []], [[], [], []]
        for rho1, share1 in zip(points1, shares1, strict=True):
            arm = [hy.sum([self.constant(rho1[j]) * R[i, j] for j in range(3) if rho1[j] != 0]) for i in range(3)]
            p = [X[i] + arm[i] for i in range(3)]
            of_one = self._pull(p, points2, shares2, k * share1)
            for i in range(3):
                force[i].append(of_one[i])
                moment[i].append(cross(arm, of_one)[i])
        F = np.array([hy.sum(part) for part in force])
        turn = np.array([hy.sum(part) for part in moment])
        return Exerted(0.0, F, np.zeros(3), -cross(X, F) - turn, R.T @ turn)

    def _pull(self, p: Vector, points: Any, shares: Any, k: Any) -> Vector:
        """Return the force of some points on one at p."""
        if not self.expanded:
            d = [[p[i] - self.constant(rho[i]) for i in range(3)] for rho in points]
            w = [self.constant(-k * share) * hy.sum([part * part for part in one]) ** -1.5
                 for one, share in zip(d, shares, strict=True)]  # fmt: skip
            return [hy.sum([one[i] * weight for one, weight in zip(d, w, strict=True)]) for i in range(3)]
        square = hy.sum([part * part for part in p])
        weights = []
        for rho in points:
            linear = [self.constant(-2 * rho[i]) * p[i] for i in range(3) if rho[i] != 0]
            weights.append(hy.sum([square, self.constant(rho @ rho), *linear]) ** -1.5)
        whole = hy.sum([self.constant(-k * share) * w for share, w in zip(shares, weights, strict=True)])
        back = [
            hy.sum(
                [self.constant(k * share * rho[i]) * w for share, rho, w in zip(shares, points, weights, strict=True)]
            )
            for i in range(3)
        ]
        return [p[i] * whole + back[i] for i in range(3)]

    @property
    def y(self) -> Any:
        """The start, in the order of the equations."""
        s = self.start
        x, v = s.x[1] - s.x[0], s.v[1] - s.v[0]
        if not self.inertial:
            x, v = s.R[0].T @ x, s.R[0].T @ v
        R = s.R[0].T @ s.R[1] if self.relative else s.R[1]
        parts = (x, v, quaternion(R), quaternion(s.R[0]), s.Omega[0], s.Omega[1])
        return rounded(np.concatenate(parts), self.kind)

    def integrator(self, tolerance: float, *, compact: bool) -> Any:
        """Compile an integrator."""
        return hy.taylor_adaptive(
            self.equations, self.y, tol=self.kind(tolerance), compact_mode=compact, fp_type=self.kind
        )

    def right_hand_side(self) -> Callable[[Any], Any]:
        """Return the compiled right-hand side of the equations."""
        names, values = zip(*self.equations, strict=True)
        return hy.cfunc(list(values), vars=list(names), fp_type=self.kind)

    def snapshot(self, y: Any) -> Snapshot:
        """Return where the bodies are, in SI; of the barycentre at rest in the origin."""
        x, v, q, q2, spin2, spin1 = np.split(in_quadruple(y), np.cumsum([3, 3, 4, 4, 3]))
        R, R2 = (rotation(part) for part in (q, q2))
        if not self.inertial:
            x, v = R2 @ x, R2 @ v
        R1 = R2 @ R if self.relative else R
        shares = self.start.m[::-1] / self.start.m.sum()
        signs = np.array([-1, 1])[:, None]
        at = Snapshot(
            signs * shares[:, None] * v, np.array([spin2, spin1]), signs * shares[:, None] * x, np.array([R2, R1])
        )
        return taylor.in_si(at, self.units)


def points_of(body: ba.RigidBody) -> tuple[np.ndarray, np.ndarray]:
    """Return the points (n, 3) [m] of a body in its own frame and their shares of its mass."""
    points, shares = body.points
    return np.asarray(points), np.asarray(shares)


def rounded(values: Any, kind: type) -> Any:
    """Return numbers of quadruple precision in another type: nothing converts real128 to a long double directly."""
    values = np.asarray(values).astype(REAL)
    high = values.astype(float)
    result = high.astype(kind) + (values - high.astype(REAL)).astype(float).astype(kind)
    return result[()]


def in_quadruple(values: Any) -> Any:
    """Return numbers of a shorter type in quadruple precision."""
    high = values.astype(float)
    return high.astype(REAL) + (values - high).astype(float).astype(REAL)


def quaternion(R: Any) -> Any:
    """Return the unit quaternion of a rotation matrix, scalar last, to all its digits."""
    q = Rotation.from_matrix(R.astype(float)).as_quat().astype(REAL)
    # one Newton step: the turn from q to R, a small one, is half its vector
    D = rotation(q).T @ R
    x, y, z = (D[2, 1] - D[1, 2]) / 4, (D[0, 2] - D[2, 0]) / 4, (D[1, 0] - D[0, 1]) / 4
    a, b, c, w = q
    q = np.array(
        [w * x + a + b * z - c * y, w * y + b + c * x - a * z, w * z + c + a * y - b * x, w - a * x - b * y - c * z]
    )
    return q / np.sqrt(q @ q)


def rotation(q: Any) -> Any:
    """Return the rotation matrix of a quaternion of about unit length."""
    x, y, z, w = q / np.sqrt(q @ q)
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
