"""Several point masses for heyoka's Taylor integrator: its own N-body model, in units of order one."""

from typing import Any

import heyoka as hy
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.benchmark.heyoka_problem import in_quadruple, rounded
from validation.oracles import taylor
from validation.oracles.taylor import REAL, Start, Units


class HeyokaPoints:
    """The equations of several points and their start."""

    def __init__(self, system: ba.System, state: ba.State, *, kind: type = float) -> None:
        self.kind, self.count = kind, len(system.bodies)
        self.units = Units.of(system, state)
        self.start = Start.of(system, state, self.units)
        gms = [hy.expression(rounded(gm, kind)) for gm in self.start.gm]
        self.equations = hy.model.nbody(self.count, masses=gms)

    @property
    def y(self) -> Any:
        """The start: place and velocity of each body in turn."""
        return rounded(np.concatenate([self.start.x, self.start.v], axis=1).ravel(), self.kind)

    def snapshot(self, y: Any) -> Snapshot:
        """Return where the bodies are, in SI."""
        rows = in_quadruple(y).reshape(self.count, 6)
        R, Omega = np.array([np.eye(3).astype(REAL)] * self.count), np.zeros((self.count, 3)).astype(REAL)
        return taylor.in_si(Snapshot(rows[:, 3:], Omega, rows[:, :3], R), self.units)
