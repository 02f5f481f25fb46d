"""The equations of motion of bodies as formulas, in variables of order one, and the numbers that go with them.

They are (25)-(28) of the paper in the variables of the production steps: positions and velocities in inertial axes
about the barycentre, attitudes as quaternions, spins in the body frames; then what gravity has carried round. heyoka
chooses its steps by the largest variable, so that these are over units of the system: powers of two, which round
nothing. What does not change, the attitude of a point, is none of the variables.
"""

from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from binaryast.kernels.bodies import layout
from binaryast.state import State
from binaryast.system import System
from binaryast.taylor.attraction import Constant, Formula, formula_of, power_of_two
from binaryast.taylor.vectors import (
    Number,
    Numbers,
    added,
    conjugate,
    cross,
    product,
    quaternion_to_matrix,
    rotate,
    rotate_back,
    scaled,
    subtracted,
)
from binaryast.units import Floats
from binaryast.working.base import ratios
from binaryast.working.bodies import WorkingBodies


class Place(NamedTuple):
    """Where a body is: x, v, quaternion and spin."""

    x: Numbers
    v: Numbers
    q: Numbers
    spin: Numbers


class Formulas:
    """The motion of a system as formulas.

    Attributes
    ----------
    time : float
        The unit of time [s].
    start : ndarray
        The variables at the start.
    """

    def __init__(self, system: System, state: State, working: WorkingBodies) -> None:
        self.system, self.count = system, len(system.bodies)
        position, _, attitude, _ = state.si
        self.length = power_of_two(float(np.linalg.norm(position[1] - position[0])))
        self.pairs: list[Formula] = [formula_of(system, pair, self.length) for pair in system.pairs]
        gm = sum(body.si.gm for body in system.bodies[:2])
        self.time = power_of_two(float(np.sqrt(self.length**3 / gm)))
        self.fixed = working.state[: layout.MOTION * self.count].copy()
        self.changing = np.flatnonzero(self._changing())
        self.units = self._units()[self.changing]
        attitudes = (self.changing >= layout.attitude_of(self.count)) & (self.changing < layout.momentum_of(self.count))
        self.quaternions = np.flatnonzero(attitudes).reshape(-1, 4)
        carried = [
            formula.carried(attitude[pair.primary].T @ attitude[pair.secondary])
            for formula, pair in zip(self.pairs, system.pairs, strict=True)
        ]
        self.sizes = [len(numbers) for numbers in carried]
        self.start = np.concatenate([self.fixed[self.changing] / self.units, *carried])

    def _changing(self) -> NDArray[np.bool_]:
        """Return which numbers of the motion change."""
        bodies = np.array([not body.is_point for body in self.system.bodies])
        return np.concatenate([np.full(6 * self.count, True), np.repeat(bodies, 4), np.repeat(bodies, 3)])

    def _units(self) -> Floats:
        """Return the units of the motion; angular momenta are those of spins of one."""
        n, moments = self.count, np.concatenate([body.si.moments for body in self.system.bodies])
        lengths = np.full(3 * n, self.length)
        return np.concatenate([lengths, lengths / self.time, np.ones(4 * n), moments / self.time])

    def normalise(self, variables: Floats) -> None:
        """Make quaternions one long again, in place: round-off would add up over many steps."""
        q = variables[self.quaternions]
        variables[self.quaternions] = q + 0.5 * q * (1.0 - np.sum(q * q, axis=1, keepdims=True))

    def motion(self, variables: Floats) -> Floats:
        """Return the motion (13 n,), as a working state begins with it."""
        result = self.fixed.copy()
        result[self.changing] = variables[: len(self.changing)] * self.units
        return result

    def rates(self, variables: Numbers, constant: Constant) -> list[Number]:
        """Return the rates of all variables, in their order."""
        bodies, carried = self._places(variables)
        matrices = [quaternion_to_matrix(body.q) for body in bodies]
        accelerations: list[Numbers] = [[0.0] * 3 for _ in bodies]
        turns: list[Numbers] = [[0.0] * 3 for _ in bodies]
        of_carried: list[Number] = []
        for pair, formula, numbers in zip(self.system.pairs, self.pairs, carried, strict=True):
            two, one = pair.primary, pair.secondary
            r = quaternion_to_matrix(product(conjugate(bodies[two].q), bodies[one].q))  # R, (35)
            x = rotate_back(matrices[two], subtracted(bodies[one].x, bodies[two].x))  # X, (34)
            exerted = formula.attraction(x, r, numbers, constant)
            of_carried += formula.rates(numbers, subtracted(rotate(r, bodies[one].spin), bodies[two].spin))
            force = rotate(matrices[two], exerted.gradient)  # on the primary
            torque_2 = added(cross(x, exerted.gradient), exerted.moment)
            torque_1 = scaled(-1.0, rotate_back(r, exerted.moment))
            for body, sign, torque in ((one, -1.0, torque_1), (two, 1.0, torque_2)):
                by_mass, by_moments = self._scales(body, formula.strength)
                accelerations[body] = added(accelerations[body], scaled(constant(sign * by_mass), force))
                turn = [constant(k) * component for k, component in zip(by_moments, torque, strict=True)]
                turns[body] = added(turns[body], turn)
        every = [
            *(component for body in bodies for component in body.v),  # (26)
            *(component for acceleration in accelerations for component in acceleration),  # (25)
            *(rate for body in bodies for rate in scaled(0.5, product(body.q, [*body.spin, 0.0]))),  # (28)
            *(rate for i, turn in enumerate(turns) for rate in self._of_spin(i, bodies[i], turn, constant)),  # (27)
        ]
        return [*(every[k] for k in self.changing), *of_carried]

    def _places(self, variables: Numbers) -> tuple[list[Place], list[Numbers]]:
        """Return where the bodies are, and what each pair has carried round."""
        n, motion = self.count, list(self.fixed.tolist())
        for k, variable in zip(self.changing, variables, strict=False):
            motion[k] = variable
        groups = []
        for begin, size in ((0, 3), (layout.velocity_of(n), 3), (layout.attitude_of(n), 4), (layout.momentum_of(n), 3)):
            groups.append([motion[begin + size * i : begin + size * (i + 1)] for i in range(n)])
        ends = len(self.changing) + np.cumsum([0, *self.sizes])
        carried = [variables[begin:end] for begin, end in pairwise(ends)]
        return [Place(*parts) for parts in zip(*groups, strict=True)], carried

    def _scales(self, body: int, strength: float) -> tuple[float, list[float]]:
        """Return what a force and a torque over G m1 m2 have to be multiplied with; none turns a point."""
        si = self.system.bodies[body].si
        scale = strength * self.time**2 / self.length
        return scale / si.mass / self.length**2, [scale / moment if moment > 0 else 0.0 for moment in si.moments]

    def _of_spin(self, body: int, place: Place, turn: Numbers, constant: Constant) -> list[Number]:
        """Return the rates of a spin: what the body's own turning does to it, and a torque over its moments."""
        _, differences = ratios(self.system.bodies[body].si.moments)
        own = [constant(float(k)) for k in differences]
        (x, y, z), (a, b, c) = place.spin, own
        return added((a * (y * z), b * (z * x), c * (x * y)), turn)
