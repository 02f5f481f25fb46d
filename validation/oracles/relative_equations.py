"""The continuous equations of relative motion (55)-(62), exactly as the paper prints them, for heyoka.

The potential is written down from its definition; dU/dX and dU/dR are heyoka's derivatives of it, M is (54) of them.
"""

from typing import Any

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.oracles import mutual_potentials, taylor
from validation.oracles.taylor import REAL, Array, Start, Units, gradient, numbers, variables

SHAPES = {"V": (3,), "Omega": (3,), "Omega2": (3,), "X": (3,), "R": (3, 3), "v2": (3,), "x2": (3,), "R2": (3, 3)}


def S(a: Array) -> Array:  # noqa: N802
    """Return S(a) of section 2.2."""
    zero = 0.0 * a[0]
    return np.array([[zero, -a[2], a[1]], [a[2], zero, -a[0]], [-a[1], a[0], zero]], dtype=object)


class RelativeEquations:
    """(55)-(62) of a pair, with its start, in units of order one."""

    def __init__(self, system: ba.System, state: ba.State) -> None:
        self.units = Units.of(system, state)
        self.start = Start.of(system, state, self.units)
        self.symbols = {name: variables(name, *shape) for name, shape in SHAPES.items()}
        self.equations = self._equations(self._potential(system))

    def _potential(self, system: ba.System) -> Any:
        """Return U(X, R)."""
        (m2, m1), (_, gm1), (J2, J1) = (numbers(values) for values in (self.start.m, self.start.gm, self.start.J))
        X, R = self.symbols["X"], self.symbols["R"]
        if isinstance(system.gravity, ba.SecondDegree):
            return mutual_potentials.maccullagh(gm1, m1, m2, J1, J2, X, R)
        if isinstance(system.gravity, ba.Multipole):
            squares = [mutual_potentials.squares_of(body, self.units) for body in reversed(system.bodies)]
            one = numbers(np.eye(3).astype(REAL))
            return mutual_potentials.ellipsoids(gm1, m2, *squares, X, R, one, degree=system.gravity.degree)
        points2, points1 = (mutual_potentials.points_of(body, system.gravity, self.units) for body in system.bodies)
        return mutual_potentials.point_pairs(gm1, m2, points1, points2, lambda rho1, rho2: X + R @ rho1 - rho2)

    def _equations(self, U: Any) -> list[tuple[Any, Any]]:
        """Return the equations, each as a variable and its derivative."""
        V, Omega, Omega2, X, R, v2, _, R2 = self.symbols.values()
        (m2, m1), (J2, J1) = numbers(self.start.m), numbers(self.start.J)
        dX, dR = gradient(U, X, R)
        m = m1 * m2 / (m1 + m2)
        M = sum(S(R[:, p]) @ dR[:, p] for p in range(3))  # (54)
        JR, inverse_JR = R @ np.diag(J1) @ R.T, R @ np.diag(1.0 / J1) @ R.T
        dot_R = S(Omega) @ R - S(Omega2) @ R  # (59)
        dot_JR = dot_R @ np.diag(J1) @ R.T + R @ np.diag(J1) @ dot_R.T
        derivatives = (
            -dX / m - S(Omega2) @ V,  # (55)
            inverse_JR @ (-M - S(Omega2) @ (JR @ Omega) - dot_JR @ Omega),  # (56), (J_R Omega)' a product's derivative
            (S(X) @ dX + M - S(Omega2) @ (J2 * Omega2)) / J2,  # (57)
            V - S(Omega2) @ X,  # (58)
            dot_R,
            R2 @ dX / m2,  # (60)
            v2,  # (61)
            R2 @ S(Omega2),  # (62)
        )
        pairs = zip(self.symbols.values(), derivatives, strict=True)
        return [pair for symbol, value in pairs for pair in zip(symbol.ravel(), np.ravel(value), strict=True)]

    @property
    def y(self) -> Array:
        """The start, in the order of the equations: (34)-(39)."""
        s = self.start
        to_primary = s.R[0].T
        R = to_primary @ s.R[1]
        X, V = to_primary @ (s.x[1] - s.x[0]), to_primary @ (s.v[1] - s.v[0])
        parts = (V, R @ s.Omega[1], s.Omega[0], X, R.ravel(), s.v[0], s.x[0], s.R[0].ravel())
        return np.concatenate(parts)

    def right_hand_side_error(self, system: ba.System, state: ba.State) -> float:
        """Return the largest error of the package's (55)-(62) at the start, in units of order one."""
        symbols, values = zip(*self.equations, strict=True)
        ours = ba.equations.continuous(system, frame="relative", form="lagrangian")
        derivatives = ours.unpack(ours.rhs(0.0, ours.from_state(state)))
        found = hy.cfunc(list(values), vars=list(symbols), fp_type=REAL)(self.y)
        length, time, _ = self.units
        units = {"V": length / time**2, "Omega": time**-2, "X": length / time, "R": 1 / time}
        units |= {"v2": units["V"], "x2": units["X"], "R2": units["R"], "Omega2": units["Omega"]}
        errors = []
        for name, value in self._by_name(found).items():
            expected = value.astype(float)
            errors.append(np.abs(derivatives[name] / units[name] - expected).max() / max(1.0, np.abs(expected).max()))
        return float(max(errors))

    def _by_name(self, y: Array) -> dict[str, Array]:
        """Return the variables of a flat array."""
        result, begin = {}, 0
        for name, shape in SHAPES.items():
            size = int(np.prod(shape))
            result[name], begin = y[begin : begin + size].reshape(shape), begin + size
        return result

    def at(self, time: float, *, precise: bool = True) -> Snapshot:
        """Return where the bodies are after a time [s], in SI and in quadruple precision."""
        y = taylor.integrate(self.equations, self.y, time / self.units.time, precise=precise)
        V, Omega, Omega2, X, R, v2, x2, R2 = self._by_name(y).values()
        velocity, position = np.array([v2, v2 + R2 @ V]), np.array([x2, x2 + R2 @ X])
        at = Snapshot(velocity, np.array([Omega2, R.T @ Omega]), position, np.array([R2, R2 @ R]))
        return taylor.in_si(at, self.units)
