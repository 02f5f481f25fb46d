"""The variables of both frames and the Legendre transforms between them, continuous and discrete.

Each frame turns a `Snapshot`, which is (25)-(28)'s variables, into velocities or momenta and back, and momenta into
the differences that the summed Lagrangian maps carry: D, the increment of the position in one step, and g of (128).
"""

from typing import Any, NamedTuple, TypeAlias

import numpy as np

from binaryast.kernels.derivatives import derivatives
from binaryast.kernels.pointers import table_of
from binaryast.system import System
from binaryast.units import Floats

Variables: TypeAlias = dict[str, Floats]


class Snapshot(NamedTuple):
    """All bodies at one time as plain SI floats: v (n, 3), Omega (n, 3), x (n, 3), R (n, 3, 3) of (25)-(28)."""

    v: Floats
    Omega: Floats
    x: Floats
    R: Floats


class Inertial:
    """The inertial frame: any number of bodies, a row for each.

    Attributes
    ----------
    rows : tuple of int
        The leading axes of a variable.
    arguments : tuple
        What the kernels need before the variables.
    """

    def __init__(self, system: System) -> None:
        self.m = np.array([body.si.mass for body in system.bodies])
        self.J = np.array([np.diag(body.si.moments) for body in system.bodies])
        self.rows: tuple[int, ...] = (len(self.m),)
        self.potentials = table_of([pair.potential for pair in system.pairs])
        self.parameters = np.concatenate([pair.parameters for pair in system.pairs])
        ends = np.cumsum([len(pair.parameters) for pair in system.pairs])
        self.pairs = np.array(
            [
                (pair.primary, pair.secondary, end - len(pair.parameters), end)
                for pair, end in zip(system.pairs, ends, strict=True)
            ]
        )
        self.arguments: tuple[Any, ...] = (self.potentials, self.parameters, self.pairs, self.m, self.J)

    def variables(self, at: Snapshot) -> Variables:
        """Return velocities and momenta: gamma = m v, Pi = J Omega."""
        v, Omega, x, R = at
        Pi = np.einsum("nij,nj->ni", self.J, Omega)
        return {"v": v, "Omega": Omega, "x": x, "R": R, "gamma": self.m[:, None] * v, "Pi": Pi}

    def from_velocities(self, v: Floats, Omega: Floats, x: Floats, R: Floats) -> Snapshot:
        """Return the snapshot of velocities."""
        return Snapshot(v, Omega, x, R)

    def from_momenta(self, gamma: Floats, Pi: Floats, x: Floats, R: Floats) -> Snapshot:
        """Return the snapshot of momenta."""
        Omega = np.array([angular_velocity(J, Pi_i) for J, Pi_i in zip(self.J, Pi, strict=True)])
        return Snapshot(gamma / self.m[:, None], Omega, x, R)

    def differences(self, h: float, x: Floats, gamma: Floats, Pi: Floats, R: Floats) -> Variables:
        """Return the differences of momenta, by (86) and (90)."""
        dU, M = self.derivatives(x, R)
        rigid = np.any(self.J, axis=(-2, -1))[:, None]
        return {"x": x, "R": R, "D": h / self.m[:, None] * (gamma - h / 2 * dU), "g": rigid * h * (Pi + h / 2 * M)}

    def from_differences(self, h: float, x: Floats, R: Floats, D: Floats, g: Floats) -> Snapshot:
        """Return the snapshot of differences, by (86) and (90)."""
        dU, M = self.derivatives(x, R)
        return self.from_momenta(self.m[:, None] * D / h + h / 2 * dU, g / h - h / 2 * M, x, R)

    def from_configurations(self, h: float, x: Floats, R: Floats, next_x: Floats, next_R: Floats) -> Snapshot:
        """Return the snapshot of two configurations: of the first of them."""
        F = np.swapaxes(R, -1, -2) @ next_R  # (80)
        g = np.array([momentum_of(F_i, J) for F_i, J in zip(F, self.J, strict=True)])
        return self.from_differences(h, x, R, next_x - x, g)

    def sizes(self, length: float, time: float) -> dict[str, Any]:
        """Return the size of each continuous variable in units of length and time, and each body's own of mass."""
        m, J = self.m[:, None], typical_inertia(self.J)[:, None]
        return {
            "v": length / time,
            "Omega": 1 / time,
            "gamma": m * length / time,
            "Pi": J / time,
            "x": length,
            "R": 1.0,
        }

    def derivatives(self, x: Floats, R: Floats) -> tuple[Floats, Floats]:
        """Return dU/dx_i and M_i."""
        # copies, for compiled functions take no read-only arrays
        _, dU, M = derivatives(self.potentials, self.parameters, self.pairs, np.array(x), np.array(R))
        return dU, M


class Relative:
    """The relative frame of a pair: body 2, the primary, owns it, and is reconstructed beside it.

    Attributes
    ----------
    rows, arguments
        As of `Inertial`.
    """

    def __init__(self, system: System) -> None:
        self.system = system
        self.rows: tuple[int, ...] = ()
        one, two = system.secondary.si, system.primary.si
        self.m1, self.m2, self.m = one.mass, two.mass, system.reduced_mass
        self.J1, self.J2 = np.diag(one.moments), np.diag(two.moments)
        potentials = table_of([system.pairs[0].potential])
        self.arguments: tuple[Any, ...] = (potentials, system.parameters, self.m1, self.m2, self.J1, self.J2)

    def variables(self, at: Snapshot) -> Variables:
        """Return (34)-(37) and the momenta below (62), with v2, gamma2, x2 and R2."""
        v, Omega, x, attitude = at
        R2 = attitude[0]
        R = R2.T @ attitude[1]  # (35)
        V = R2.T @ (v[1] - v[0])  # (36)
        return {
            "V": V,
            "Omega": R @ Omega[1],  # (37)
            "Omega2": Omega[0],
            "Gamma": self.m * V,
            "Pi": R @ self.J1 @ Omega[1],
            "Pi2": self.J2 @ Omega[0],
            "X": R2.T @ (x[1] - x[0]),  # (34)
            "R": R,
            "v2": v[0],
            "gamma2": self.m2 * v[0],
            "x2": x[0],
            "R2": R2,
        }

    def from_velocities(
        self, V: Floats, Omega: Floats, Omega2: Floats, X: Floats, R: Floats, v2: Floats, x2: Floats, R2: Floats
    ) -> Snapshot:
        """Return the snapshot of velocities, by (34)-(37)."""
        return Snapshot(
            v=np.array([v2, v2 + R2 @ V]),
            Omega=np.array([Omega2, R.T @ Omega]),
            x=np.array([x2, x2 + R2 @ X]),
            R=np.array([R2, R2 @ R]),
        )

    def from_momenta(
        self, Gamma: Floats, Pi: Floats, Pi2: Floats, X: Floats, R: Floats, gamma2: Floats, x2: Floats, R2: Floats
    ) -> Snapshot:
        """Return the snapshot of the momenta below (62)."""
        Omega, Omega2 = angular_velocity(R @ self.J1 @ R.T, Pi), angular_velocity(self.J2, Pi2)
        return self.from_velocities(Gamma / self.m, Omega, Omega2, X, R, gamma2 / self.m2, x2, R2)

    def differences(
        self,
        h: float,
        X: Floats,
        Gamma: Floats,
        Pi: Floats,
        Pi2: Floats,
        R: Floats,
        x2: Floats,
        gamma2: Floats,
        R2: Floats,
    ) -> Variables:
        """Return the differences of momenta, by (118) and (123)-(125); D = F2_k X_{k+1} - X_k."""
        dU, M = self._derivatives(X, R)
        return {
            "X": X,
            "R": R,
            "R2": R2,
            "x2": x2,
            "D": h / self.m * (Gamma - h / 2 * dU),
            "g": h * (Pi - h / 2 * M),
            "g2": h * (Pi2 + h / 2 * (np.cross(X, dU) + M)) if np.any(self.J2) else np.zeros(3),
            "D2": h / self.m2 * (gamma2 + h / 2 * R2 @ dU),
        }

    def from_differences(
        self, h: float, X: Floats, R: Floats, R2: Floats, x2: Floats, D: Floats, g: Floats, g2: Floats, D2: Floats
    ) -> Snapshot:
        """Return the snapshot of differences, by (118) and (123)-(125)."""
        dU, M = self._derivatives(X, R)
        Gamma = self.m * D / h + h / 2 * dU
        Pi = g / h + h / 2 * M
        Pi2 = g2 / h - h / 2 * (np.cross(X, dU) + M)
        gamma2 = self.m2 * D2 / h - h / 2 * R2 @ dU
        return self.from_momenta(Gamma, Pi, Pi2, X, R, gamma2, x2, R2)

    def from_configurations(
        self,
        h: float,
        X: Floats,
        R: Floats,
        R2: Floats,
        x2: Floats,
        next_X: Floats,
        next_R: Floats,
        next_R2: Floats,
        next_x2: Floats,
    ) -> Snapshot:
        """Return the snapshot of two configurations: of the first of them."""
        F2 = R2.T @ next_R2  # (116)
        F = F2 @ next_R @ R.T  # (115)
        g, g2 = momentum_of(F, R @ self.J1 @ R.T), momentum_of(F2, self.J2)
        return self.from_differences(h, X, R, R2, x2, F2 @ next_X - X, g, g2, next_x2 - x2)

    def sizes(self, length: float, time: float) -> dict[str, Any]:
        """Return the size of each continuous variable in units of length and time, and of mass and inertia."""
        J1, J2 = typical_inertia(np.array([self.J1, self.J2]))
        return {
            **dict.fromkeys(("V", "v2"), length / time),
            **dict.fromkeys(("Omega", "Omega2"), 1 / time),
            "Gamma": self.m * length / time,
            "gamma2": self.m2 * length / time,
            "Pi": J1 / time,
            "Pi2": J2 / time,
            **dict.fromkeys(("X", "x2"), length),
            **dict.fromkeys(("R", "R2"), 1.0),
        }

    def _derivatives(self, X: Floats, R: Floats) -> tuple[Floats, Floats]:
        """Return dU/dX and M."""
        values = np.array(self.system.attraction(X, R)[1:])
        return values[:3], values[3:]


def angular_velocity(J: Floats, Pi: Floats) -> Floats:
    """Return Omega of J Omega = Pi; a point, which has no inertia, does not turn."""
    return np.linalg.solve(J, Pi) if np.any(J) else np.zeros(3)


def momentum_of(F: Floats, J: Floats) -> Floats:
    """Return g of S(g) = F J_d - J_d F^T (128)."""
    Jd = np.trace(J) / 2 * np.eye(3) - J
    A = F @ Jd - Jd @ F.T
    return np.array([A[2, 1], A[0, 2], A[1, 0]])


def typical_inertia(J: Floats) -> Floats:
    """Return half the trace of each matrix, 1 where there is none."""
    half = np.trace(J, axis1=-2, axis2=-1) / 2
    return np.where(half > 0, half, 1.0)
