"""The discrete forms: maps from one step to the next."""

from collections.abc import Callable
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.equations.base import Equations, Moment
from binaryast.equations.continuous import from_momenta, from_relative_momenta
from binaryast.errors import InputError, StepError
from binaryast.kernels import discrete
from binaryast.kernels.derivatives import derivatives
from binaryast.kernels.status import COMPLETED, NO_ROTATION
from binaryast.system import System
from binaryast.units import Floats, brief, quantity, to_si

NUMBERS = {
    ("inertial", "lagrangian"): "(78)-(80)",
    ("inertial", "hamiltonian"): "(93)-(97)",
    ("relative", "lagrangian"): "(112)-(117)",
    ("relative", "hamiltonian"): "(118)-(127)",
}
VARIABLES = {
    ("inertial", "lagrangian"): ("x", "R", "next_x", "next_R"),
    ("inertial", "summed"): ("x", "R", "D", "g"),
    ("inertial", "hamiltonian"): ("x", "gamma", "Pi", "R"),
    ("relative", "lagrangian"): ("X", "R", "R2", "x2", "next_X", "next_R", "next_R2", "next_x2"),
    ("relative", "summed"): ("X", "R", "R2", "x2", "D", "g", "g2", "D2"),
    ("relative", "hamiltonian"): ("X", "Gamma", "Pi", "Pi2", "R", "x2", "gamma2", "R2"),
}
KERNELS: dict[tuple[str, str], Callable[..., Any]] = {
    ("inertial", "lagrangian"): discrete.lagrangian_inertial,
    ("inertial", "summed"): discrete.summed_inertial,
    ("inertial", "hamiltonian"): discrete.hamiltonian_inertial,
    ("relative", "lagrangian"): discrete.lagrangian_relative,
    ("relative", "summed"): discrete.summed_relative,
    ("relative", "hamiltonian"): discrete.hamiltonian_relative,
}
MATRICES = ("R", "R2", "next_R", "next_R2")


class DiscreteEquations(Equations):
    """A discrete form; made by `binaryast.equations.discrete`.

    Attributes
    ----------
    step : Quantity
        The step h [s].
    summed : bool
        Whether a Lagrangian form carries differences instead of a second configuration.
    """

    def __init__(self, system: System, step: Quantity, frame: str, form: str, *, summed: bool = False) -> None:
        super().__init__(system, frame, form)
        self.h = float(to_si(step, "s", "step", sign="positive"))
        self.step, self.summed = quantity(self.h, "s"), summed
        if summed and form != "lagrangian":
            raise InputError("equations: summed=True is of the Lagrangian form: the Hamiltonian one is summed as it is")
        self.numbers = NUMBERS[frame, form]
        corner = (frame, "summed" if summed else form)
        self._kernel = KERNELS[corner]
        rows = (len(system.bodies),) if frame == "inertial" else ()
        self.variables = {name: (*rows, 3, 3) if name in MATRICES else (*rows, 3) for name in VARIABLES[corner]}

    def advance(self, y: Any, steps: int = 1) -> Floats:
        """Return ``y`` some steps later.

        Parameters
        ----------
        y : array-like
            The variables.
        steps : int
            How many; negative ones go back in time, which the summed forms do not.

        Returns
        -------
        ndarray

        Raises
        ------
        StepError
            Where a body would turn too far in one step, for which (128) has no solution.
        InputError
            For an array of another length, or steps that are no whole number.
        """
        if not isinstance(steps, (int, np.integer)) or (self.summed and steps < 0):
            raise InputError(f"steps: expected a whole number{' >= 0' if self.summed else ''}, got {brief(steps)}")
        result: Floats = np.array(y, dtype=np.float64)
        variables = list(self.unpack(result).values())
        h = self.h if steps >= 0 else -self.h
        if self.form == "lagrangian" and steps < 0:  # the second configuration becomes the first
            variables = [*variables[len(variables) // 2 :], *variables[: len(variables) // 2]]
        status: int = self._kernel(*self._arguments, h, abs(int(steps)), *variables)
        if status != COMPLETED:
            raise StepError(
                f"step: {self.h:g} s turns {self.system.names[status - NO_ROTATION]} too far: the implicit equation "
                "(128) has a solution only for h Omega < 1: take a smaller step"
            )
        return result

    def _hamiltonian(self) -> "DiscreteEquations":
        """Return the Hamiltonian form of the same map."""
        return DiscreteEquations(self.system, self.step, self.frame, "hamiltonian")

    def _from_moment(self, moment: Moment) -> Floats:
        if self.form == "hamiltonian":
            known = self.relative(moment) if self.frame == "relative" else self._momenta(moment)
            return self.pack(**{name: known[name] for name in self.variables})
        hamiltonian = self._hamiltonian()
        y = hamiltonian._from_moment(moment)
        now, later = hamiltonian.unpack(y), hamiltonian.unpack(hamiltonian.advance(y))  # (86), (90), or (118)-(127)
        if not self.summed:
            later = {f"next_{name}": value for name, value in later.items()}
            return self.pack(**{name: (now | later)[name] for name in self.variables})
        return self.pack(**{name: (now | self._differences(**now))[name] for name in self.variables})

    def _momenta(self, moment: Moment) -> dict[str, Floats]:
        v, Omega, x, R = moment
        return {"x": x, "gamma": self.m[:, None] * v, "Pi": np.einsum("nij,nj->ni", self.J, Omega), "R": R}

    def _to_moment(self, **variables: Floats) -> Moment:
        if self.form == "hamiltonian":
            momenta = variables
        elif self.summed:
            momenta = self._momenta_of_differences(**variables)
        else:
            momenta = self._momenta_of_differences(**self._summed(**variables))
        if self.frame == "relative":
            return from_relative_momenta(self, **momenta)
        return from_momenta(self.m, self.J, **momenta)

    def _summed(self, **variables: Floats) -> dict[str, Floats]:
        """Return the variables of the summed form from two configurations."""
        if self.frame == "inertial":
            x, R, next_x, next_R = variables.values()
            F = np.swapaxes(R, -1, -2) @ next_R  # (80)
            g = np.array([_vee_of_128(Fi, Ji) for Fi, Ji in zip(F, self.J, strict=True)])
            return {"x": x, "R": R, "D": next_x - x, "g": g}
        X, R, R2, x2, next_X, next_R, next_R2, next_x2 = variables.values()
        F2 = R2.T @ next_R2  # (116)
        F = F2 @ next_R @ R.T  # (115)
        return {
            "X": X,
            "R": R,
            "R2": R2,
            "x2": x2,
            "D": F2 @ next_X - X,
            "g": _vee_of_128(F, R @ self.J1 @ R.T),
            "g2": _vee_of_128(F2, self.J2),
            "D2": next_x2 - x2,
        }

    def _differences(self, **momenta: Floats) -> dict[str, Floats]:
        """Return D and g, the discrete Legendre transform: (86) and (90), (118), (123)-(125)."""
        h = self.h
        if self.frame == "inertial":
            x, gamma, Pi, R = momenta.values()
            dU, M = self._derivatives(x, R)
            return {"D": h / self.m[:, None] * (gamma - h / 2 * dU), "g": h * (Pi + h / 2 * M)}
        X, Gamma, Pi, Pi2, R, _, gamma2, R2 = momenta.values()
        dU, M = self._derivatives(X, R)
        return {
            "D": h / self.reduced_mass * (Gamma - h / 2 * dU),
            "g": h * (Pi - h / 2 * M),
            "g2": h * (Pi2 + h / 2 * (np.cross(X, dU) + M)),
            "D2": h / self.m2 * (gamma2 + h / 2 * R2 @ dU),
        }

    def _momenta_of_differences(self, **summed: Floats) -> dict[str, Floats]:
        """Return the momenta of D and g, the inverse of `_differences`."""
        h = self.h
        if self.frame == "inertial":
            x, R, D, g = summed.values()
            dU, M = self._derivatives(x, R)
            return {"x": x, "gamma": self.m[:, None] * D / h + h / 2 * dU, "Pi": g / h - h / 2 * M, "R": R}
        X, R, R2, x2, D, g, g2, D2 = summed.values()
        dU, M = self._derivatives(X, R)
        return {
            "X": X,
            "Gamma": self.reduced_mass * D / h + h / 2 * dU,
            "Pi": g / h + h / 2 * M,
            "Pi2": g2 / h - h / 2 * (np.cross(X, dU) + M),
            "R": R,
            "x2": x2,
            "gamma2": self.m2 * D2 / h - h / 2 * R2 @ dU,
            "R2": R2,
        }

    def _derivatives(self, x: Floats, R: Floats) -> tuple[Floats, Floats]:
        """Return dU/dx_i and M_i of all bodies, or dU/dX and M of the pair."""
        if self.frame == "relative":
            values = np.array(self.system.attraction(x, R)[1:])
            return values[:3], values[3:]
        potentials, p, pairs = self._everything[:3]
        _, dU, M = derivatives(potentials, p, pairs, np.ascontiguousarray(x), np.ascontiguousarray(R))
        return dU, M


def _vee_of_128(F: Floats, J: Floats) -> Floats:
    """Return g of S(g) = F J_d - J_d F^T."""
    Jd = np.trace(J) / 2 * np.eye(3) - J
    A = F @ Jd - Jd @ F.T
    return np.array([A[2, 1], A[0, 2], A[1, 0]])
