"""The continuous forms: rates for SciPy's solvers."""

from collections.abc import Callable
from math import sqrt
from typing import Any

import numpy as np

from binaryast.equations.base import Equations
from binaryast.equations.legendre import Snapshot
from binaryast.kernels import continuous
from binaryast.system import System
from binaryast.units import Floats

NUMBERS = {
    ("inertial", "lagrangian"): "(25)-(28)",
    ("inertial", "hamiltonian"): "(29)-(32)",
    ("relative", "lagrangian"): "(55)-(62)",
    ("relative", "hamiltonian"): "(63)-(70)",
}
VARIABLES = {
    ("inertial", "lagrangian"): ("v", "Omega", "x", "R"),
    ("inertial", "hamiltonian"): ("gamma", "Pi", "x", "R"),
    ("relative", "lagrangian"): ("V", "Omega", "Omega2", "X", "R", "v2", "x2", "R2"),
    ("relative", "hamiltonian"): ("Gamma", "Pi", "Pi2", "X", "R", "gamma2", "x2", "R2"),
}
KERNELS: dict[tuple[str, str], Callable[..., Any]] = {
    ("inertial", "lagrangian"): continuous.lagrangian_inertial,
    ("inertial", "hamiltonian"): continuous.hamiltonian_inertial,
    ("relative", "lagrangian"): continuous.lagrangian_relative,
    ("relative", "hamiltonian"): continuous.hamiltonian_relative,
}


class ContinuousEquations(Equations):
    """A continuous form; made by `binaryast.equations.continuous`."""

    def __init__(self, system: System, frame: str, form: str) -> None:
        super().__init__(system, frame, form)
        corner = (frame, form)
        self.numbers, self._kernel = NUMBERS[corner], KERNELS[corner]
        rows = self._frame.rows
        self.variables = {name: (*rows, 3, 3) if name in ("R", "R2") else (*rows, 3) for name in VARIABLES[corner]}

    def rhs(self, t: float, y: Any) -> Floats:  # noqa: ARG002 - SciPy passes the time
        """Return the rates of ``y``: the right-hand side, with the signature that SciPy's solvers call.

        Raises
        ------
        InputError
            For an array of another length, or where a rate is not a number.
        """
        rates = self._call(self._kernel, *self._frame.arguments, *self.unpack(y).values())
        return self._finite(np.concatenate([rate.ravel() for rate in rates]))

    def scales(self, y: Any) -> Floats:
        """Return the size of each variable in units of the system, for the absolute tolerances of a solver.

        The unit of length is the smallest distance of two bodies in ``y``, that of time makes G times the whole mass 1,
        that of mass is each body's own (of a pair's relative motion, the reduced one), that of inertia half its trace.
        """
        length = self.invariants(y).separation
        time = sqrt(length**3 / sum(body.si.gm for body in self.system.bodies))
        sizes = self._frame.sizes(length, time)
        return np.concatenate([np.broadcast_to(sizes[name], shape).ravel() for name, shape in self.variables.items()])

    def _from_snapshot(self, at: Snapshot) -> Floats:
        known = self._frame.variables(at)
        return self.pack(**{name: known[name] for name in self.variables})

    def _to_snapshot(self, **variables: Floats) -> Snapshot:
        if self.form == "lagrangian":
            return self._frame.from_velocities(**variables)
        return self._frame.from_momenta(**variables)
