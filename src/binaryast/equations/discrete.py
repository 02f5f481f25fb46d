"""The discrete forms: maps from one step to the next."""

from collections.abc import Callable
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.equations.base import Equations
from binaryast.equations.legendre import Snapshot
from binaryast.errors import InputError, StepError
from binaryast.kernels import discrete
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
MOST_STEPS = 10**15


class DiscreteEquations(Equations):
    """A discrete form; made by `binaryast.equations.discrete`.

    Attributes
    ----------
    step : Quantity
        The step h [s].
    summed : bool
        Whether a Lagrangian form carries differences instead of a second configuration.
    """

    def __init__(self, system: System, step: Quantity, frame: str, form: str, summed: bool = False) -> None:
        super().__init__(system, frame, form)
        self.h = float(to_si(step, "s", "step", sign="positive"))
        self.step, self.summed = quantity(self.h, "s"), summed
        self._made_of = (system, self.step, frame, form, summed)
        if summed and form != "lagrangian":
            raise InputError("equations: summed=True is of the Lagrangian form: the Hamiltonian one is summed as it is")
        self.numbers = NUMBERS[frame, form]
        corner = (frame, "summed" if summed else form)
        self._kernel = KERNELS[corner]
        rows = self._frame.rows
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
            For an array of another length, steps that are no whole number, or where the result is not a number.
        """
        whole = isinstance(steps, (int, np.integer)) and not isinstance(steps, bool) and abs(int(steps)) <= MOST_STEPS
        if not whole or (self.summed and steps < 0):
            raise InputError(f"steps: expected a whole number{' >= 0' if self.summed else ''}, got {brief(steps)}")
        result = self._finite(self._checked(y).copy())
        variables = list(self.unpack(result).values())
        h = self.h if steps >= 0 else -self.h
        if self.form == "lagrangian" and steps < 0:  # the second configuration becomes the first
            variables = [*variables[len(variables) // 2 :], *variables[: len(variables) // 2]]
        status = self._call(self._kernel, *self._frame.arguments, h, abs(int(steps)), *variables)
        self._finite(result)
        if status != COMPLETED:
            at = self.snapshot(result)
            self._finite(np.concatenate([part.ravel() for part in self._inertial.derivatives(at.x, at.R)]))
            raise StepError(
                f"step: {self.h:g} s turns {self.system.names[status - NO_ROTATION]} too far: the implicit equation "
                "(128) has a solution only for h Omega < 1: take a smaller step"
            )
        return result

    def _from_snapshot(self, at: Snapshot) -> Floats:
        known = self._frame.variables(at)
        if self.form == "lagrangian":
            hamiltonian = DiscreteEquations(self.system, self.step, self.frame, "hamiltonian")
            momenta = {name: known[name] for name in hamiltonian.variables}
            if self.summed:
                known = self._frame.differences(self.h, **momenta)
            else:  # the second configuration is that of the Hamiltonian map, by (86), (90) and their relative likes
                later = hamiltonian.unpack(hamiltonian.advance(hamiltonian.pack(**momenta)))
                known |= {f"next_{name}": value for name, value in later.items()}
        return self.pack(**{name: known[name] for name in self.variables})

    def _to_snapshot(self, **variables: Floats) -> Snapshot:
        if self.form == "hamiltonian":
            return self._frame.from_momenta(**variables)
        if self.summed:
            return self._frame.from_differences(self.h, **variables)
        return self._frame.from_configurations(self.h, **variables)
