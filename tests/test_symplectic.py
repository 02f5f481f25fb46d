"""The maps are symplectic on T*SE(3)^n: a finite-difference Jacobian against the canonical form, left-trivialised.

A variation of a body is (delta x, eta, delta gamma, delta Pi) with delta R = R S(eta) (16). The canonical form of two
of them is dx1.dgamma2 - dx2.dgamma1 + eta1.dPi2 - eta2.dPi1 + Pi.(eta1 x eta2).
"""

from collections.abc import Callable

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from validation.cases import four_bodies, tumbling_pair

import binaryast as ba
from binaryast import working
from binaryast.equations.base import Moment
from tests.conftest import take_steps

# Differences of order 8 in steps of 2e-3: truncation below 1e-15, round-off 1e-13 for equal masses. In the units of the
# lighter body it is as much more as the root of the masses' ratio: the largest seen is 7e-12.
NOISE = 3e-11
WIDTH = 2e-3
WEIGHTS = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))

Map = Callable[[ba.System, ba.State, float], Moment]


def production(system: ba.System, state: ba.State, h: float, *, inertial: bool) -> Moment:
    w = working.of(system, state, inertial=inertial)
    take_steps(w, h, 1)
    motion = w.from_rows(w.state[None, : w.row_size], np.array([h]))
    return Moment(motion.velocity[0], motion.spin[0], motion.position[0], motion.attitude[0])


def printed(system: ba.System, state: ba.State, h: float, *, frame: str) -> Moment:
    equations = ba.equations.discrete(system, step=h * u.s, frame=frame)
    return equations.to_moment(equations.advance(equations.from_state(state)))


MAPS: dict[str, Map] = {
    "the production step of a pair": lambda *a: production(*a, inertial=False),
    "the production step of bodies": lambda *a: production(*a, inertial=True),
    "(118)-(127)": lambda *a: printed(*a, frame="relative"),
    "(93)-(97)": lambda *a: printed(*a, frame="inertial"),
}


class Chart:
    """Variations of a state in units of order one: length l, time t, each body's own mass and inertia."""

    def __init__(self, system: ba.System, length: float, time: float) -> None:
        self.length, self.time = length, time
        self.m = np.array([body.si.mass for body in system.bodies])
        self.J = np.array([body.si.moments for body in system.bodies])
        self.rigid = self.J[:, 0] > 0
        self.inertia = np.where(self.rigid, self.J.max(axis=1), 1.0)
        # each block of the canonical form, over the largest of all m l^2/t, so that its elements are of order one
        self.orbit = self.m * length**2 / time
        self.spin = self.inertia / time

    def varied(self, state: ba.State, z: np.ndarray) -> ba.State:
        dx, eta, dv, dPi = z.reshape(len(self.m), 4, 3).transpose(1, 0, 2)
        turn = Rotation.from_rotvec(eta * self.rigid[:, None]).as_matrix()
        dOmega = np.divide(dPi * self.spin[:, None], self.J, out=np.zeros_like(self.J), where=self.J > 0)
        return ba.State(
            state.position + dx * self.length * u.m,
            state.velocity + dv * self.length / self.time * u.m / u.s,
            state.attitude @ turn,
            state.spin + dOmega * u.rad / u.s,
        )

    def variation(self, one: Moment, base: Moment) -> np.ndarray:
        eta = Rotation.from_matrix(np.swapaxes(base.R, -1, -2) @ one.R).as_rotvec()
        dPi = self.J * (one.Omega - base.Omega) / self.spin[:, None]
        parts = ((one.x - base.x) / self.length, eta, (one.v - base.v) * self.time / self.length, dPi)
        return np.stack(parts, axis=1).ravel()

    def form(self, Omega: np.ndarray) -> np.ndarray:
        """Return the matrix of the canonical form where the bodies spin so, each body's block in its own unit."""
        result = np.zeros((12 * len(self.m), 12 * len(self.m)))
        one = np.eye(3)
        for i in range(len(self.m)):
            Pi = self.J[i] * Omega[i] / self.spin[i]
            block = np.zeros((12, 12))
            block[0:3, 6:9], block[6:9, 0:3] = self.orbit[i] * one, -self.orbit[i] * one
            block[3:6, 9:12], block[9:12, 3:6] = self.spin[i] * one, -self.spin[i] * one
            block[3:6, 3:6] = self.spin[i] * np.array([[0, Pi[2], -Pi[1]], [-Pi[2], 0, Pi[0]], [Pi[1], -Pi[0], 0]])
            result[12 * i : 12 * i + 12, 12 * i : 12 * i + 12] = block
        return result


def defect(step: Map, system: ba.System, state: ba.State, h: float, length: float, time: float) -> float:
    """Return the largest element of D^T W' D - W, in the units of the two variables that it belongs to."""
    chart = Chart(system, length, time)
    base = step(system, state, h)
    free = np.repeat(np.stack([np.full_like(chart.rigid, True), chart.rigid] * 2, axis=1).ravel(), 3)
    columns = []
    for k in np.flatnonzero(free):
        z = np.zeros(len(free))
        column = np.zeros(len(free))
        for multiple, weight in WEIGHTS:
            z[k] = multiple * WIDTH
            ahead, behind = (step(system, chart.varied(state, sign * z), h) for sign in (1, -1))
            column += weight * (chart.variation(ahead, base) - chart.variation(behind, base)) / WIDTH
        columns.append(column)
    jacobian = np.array(columns).T
    before, after = chart.form(state.si.spin)[np.ix_(free, free)], chart.form(base.Omega)
    error = jacobian.T @ after @ jacobian - before
    unit = np.sqrt(np.repeat(np.stack([chart.orbit, chart.spin] * 2, axis=1).ravel(), 3)[free])
    return float(np.abs(error / np.outer(unit, unit)).max())


@pytest.mark.parametrize("name", MAPS)
def test_dumbbells(name: str) -> None:
    system, state = ba.catalogue.load("dumbbells")
    near = ba.propagate(system, state, duration=6 * u.s, integrator=ba.LGVI(1e-3 * u.s))[-1]
    assert defect(MAPS[name], system, near, 0.02, 1.0, 1.0) < NOISE


@pytest.mark.parametrize("name", MAPS)
def test_a_tumbling_pair(name: str) -> None:
    assert defect(MAPS[name], *tumbling_pair(), 300.0, 1000.0, 5000.0) < NOISE


@pytest.mark.parametrize("name", [name for name in MAPS if "pair" not in name and "118" not in name])
def test_four_bodies(name: str) -> None:
    assert defect(MAPS[name], *four_bodies(1e10), 300.0, 1000.0, 5000.0) < NOISE


def test_a_method_that_is_not_symplectic_fails() -> None:
    """Euler's method on the same equations, seen by the same eyes."""

    def euler(system: ba.System, state: ba.State, h: float) -> Moment:
        equations = ba.equations.continuous(system, frame="inertial", form="lagrangian")
        y = equations.from_state(state)
        moment = equations.to_moment(y + h * equations.rhs(0.0, y))
        return moment._replace(R=Rotation.from_matrix(moment.R).as_matrix())

    system, state = ba.catalogue.load("dumbbells")
    assert defect(euler, system, state, 0.02, 1.0, 1.0) > 1e-5
