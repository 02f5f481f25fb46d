"""The continuous forms: rates for SciPy's solvers."""

from collections.abc import Callable
from math import sqrt
from typing import Any

import numpy as np

from binaryast.equations.base import Equations, Moment, angular_velocity, from_relative
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
        rows = (len(system.bodies),) if frame == "inertial" else ()
        self.variables = {name: (*rows, 3, 3) if name in ("R", "R2") else (*rows, 3) for name in VARIABLES[corner]}

    def rhs(self, t: float, y: Any) -> Floats:  # noqa: ARG002 - SciPy passes the time
        """Return the rates of ``y``: the right-hand side, with the signature that SciPy's solvers call."""
        rates: tuple[Floats, ...] = self._kernel(*self._arguments, *self.unpack(y).values())
        return np.concatenate([rate.ravel() for rate in rates])

    def scales(self, y: Any) -> Floats:
        """Return the size of each variable in units of the system, for the absolute tolerances of a solver.

        The unit of length is the smallest distance of two bodies in ``y``, that of time makes G times the whole mass 1,
        that of mass is each body's own (of a pair's relative motion, the reduced one), that of inertia half its trace.
        """
        length = self.invariants(y).separation
        time = sqrt(length**3 / sum(body.si.gm for body in self.system.bodies))
        inertia = np.array([np.trace(J) / 2 or 1.0 for J in self.J])
        m, J = self.m[:, None], inertia[:, None]
        if self.frame == "relative":
            m, J = np.array(self.reduced_mass), inertia[1]
        sizes: dict[str, Any] = {
            **dict.fromkeys(("v", "V", "v2"), length / time),
            **dict.fromkeys(("Omega", "Omega2"), 1 / time),
            **dict.fromkeys(("gamma", "Gamma"), m * length / time),
            "gamma2": self.m[0] * length / time,
            "Pi": J / time,
            "Pi2": inertia[0] / time,
            **dict.fromkeys(("x", "X", "x2"), length),
            **dict.fromkeys(("R", "R2"), 1.0),
        }
        return np.concatenate([np.broadcast_to(sizes[name], shape).ravel() for name, shape in self.variables.items()])

    def _from_moment(self, moment: Moment) -> Floats:
        if self.frame == "relative":
            known = self.relative(moment)
        else:
            v, Omega, x, R = moment
            Pi = np.einsum("nij,nj->ni", self.J, Omega)
            known = {"v": v, "Omega": Omega, "x": x, "R": R, "gamma": self.m[:, None] * v, "Pi": Pi}
        return self.pack(**{name: known[name] for name in self.variables})

    def _to_moment(self, **variables: Floats) -> Moment:
        if self.form == "lagrangian":
            return from_relative(**variables) if self.frame == "relative" else Moment(**variables)
        if self.frame == "inertial":
            return from_momenta(self.m, self.J, **variables)
        return from_relative_momenta(self, **variables)


def from_momenta(m: Floats, J: Floats, gamma: Floats, Pi: Floats, x: Floats, R: Floats) -> Moment:
    """Return all bodies from inertial momenta: v = gamma/m, Omega = J^-1 Pi."""
    Omega = np.array([angular_velocity(Ji, Pii) for Ji, Pii in zip(J, Pi, strict=True)])
    return Moment(gamma / m[:, None], Omega, x, R)


def from_relative_momenta(
    e: Equations, Gamma: Floats, Pi: Floats, Pi2: Floats, X: Floats, R: Floats, gamma2: Floats, x2: Floats, R2: Floats
) -> Moment:
    """Return both bodies from the momenta below (62)."""
    return from_relative(
        V=Gamma / e.reduced_mass,
        Omega=angular_velocity(R @ e.J1 @ R.T, Pi),
        Omega2=angular_velocity(e.J2, Pi2),
        X=X,
        R=R,
        v2=gamma2 / e.m2,
        x2=x2,
        R2=R2,
    )
