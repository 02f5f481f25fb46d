"""What the variational maps keep, and what a Runge-Kutta method does not: ``python -m validation.structure``.

Symplecticity by a finite-difference Jacobian, reversal, energy, momenta and rotations over 10^5 to 10^7 stages of each
family, the paper's Figs 5 and 6, and a year of a triple.

A variation of a body is (delta x, eta, delta gamma, delta Pi) with delta R = R S(eta) (16). The canonical form of two
of them on T*SE(3) is dx1.dgamma2 - dx2.dgamma1 + eta1.dPi2 - eta2.dPi1 + Pi.(eta1 x eta2).
"""

import warnings
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast import working
from binaryast.equations.legendre import Snapshot
from binaryast.integrators import Stepping
from validation.cases.paper import UNIT_OF_ENERGY
from validation.steps import snapshot, take_steps
from validation.systems import four_bodies, tumbling_pair

Map = Callable[[ba.System, ba.State, float], Snapshot]
WIDTH = 2e-3  # of the differences, in units of the system
WEIGHTS = ((1, 4 / 5), (2, -1 / 5), (3, 4 / 105), (4, -1 / 280))  # of order 8: truncation below 1e-15


def production(system: ba.System, state: ba.State, h: float, *, integrator: Stepping) -> Snapshot:
    """Take one production step."""
    w = working.of(system, state, inertial=integrator.is_inertial(system))
    take_steps(w, h, 1, integrator=integrator)
    return snapshot(w, h)


def printed(system: ba.System, state: ba.State, h: float, *, frame: str) -> Snapshot:
    """Take one step as printed."""
    equations = ba.equations.discrete(system, step=h * u.s, frame=frame)
    return equations.snapshot(equations.advance(equations.from_state(state)))


def euler(system: ba.System, state: ba.State, h: float) -> Snapshot:
    """Take one step of Euler's method on (25)-(28), which is not symplectic: the check must see that."""
    equations = ba.equations.continuous(system, frame="inertial", form="lagrangian")
    y = equations.from_state(state)
    moment = equations.snapshot(y + h * equations.rhs(0.0, y))
    return moment._replace(R=Rotation.from_matrix(moment.R).as_matrix())


def runge_kutta(system: ba.System, state: ba.State, h: float, *, method: str) -> Snapshot:
    """Take one step of a Runge-Kutta method on (25)-(28), and then the nearest rotations: not symplectic either."""
    equations = ba.equations.continuous(system, frame="inertial", form="lagrangian")
    y = equations.from_state(state)
    never = {"rtol": 1e200, "atol": 1e200}
    end = solve_ivp(equations.rhs, (0, h), y, method=method, first_step=h, max_step=2 * h, **never).y[:, -1]
    at = equations.snapshot(end)
    return at._replace(R=Rotation.from_matrix(at.R).as_matrix())


OTHERS: dict[str, Map] = {
    "Euler's method": euler,
    "RK45": lambda *a: runge_kutta(*a, method="RK45"),
    "DOP853": lambda *a: runge_kutta(*a, method="DOP853"),
}
SECOND = 1 * u.s  # the steps that are taken are given with each look
RELATIVE: dict[str, Stepping] = {
    "LGVI of order 2": ba.LGVI(SECOND),
    "LGVI of order 4": ba.LGVI(SECOND, order=4),
    "LGVI of order 8": ba.LGVI(SECOND, order=8),
    "Splitting rkn6a": ba.Splitting(SECOND),
    "Splitting ss10": ba.Splitting(SECOND, scheme="ss10"),
    "KeplerSplitting aba864": ba.KeplerSplitting(SECOND),
}
INERTIAL: dict[str, Stepping] = {
    "LGVI of order 2, inertial": ba.LGVI(SECOND, frame="inertial"),
    "LGVI of order 8, inertial": ba.LGVI(SECOND, order=8, frame="inertial"),
    "Splitting rkn6a, inertial": ba.Splitting(SECOND, frame="inertial"),
    "Splitting ss10, inertial": ba.Splitting(SECOND, scheme="ss10", frame="inertial"),
}
INTEGRATORS = RELATIVE | INERTIAL
MAPS: dict[str, Map] = {
    name: partial(production, integrator=integrator) for name, integrator in INTEGRATORS.items()
} | {
    "(118)-(127)": partial(printed, frame="relative"),
    "(93)-(97)": partial(printed, frame="inertial"),
}
OF_BODIES = (*INERTIAL, "(93)-(97)")
EXACT = tuple(name for name in INTEGRATORS if "Splitting" in name)  # these turn bodies as far as a step may be long


def of_setting(setting: "Setting") -> dict[str, Map]:
    """Return the maps that apply to a setting."""
    return {name: step for name, step in MAPS.items() if len(setting.system.bodies) == 2 or name in OF_BODIES}


class Setting(NamedTuple):
    """A system, units of length [m] and time [s] that make all of order one, and a step [s] as long as can be.

    Over a short step every accurate method is symplectic as far as differences can tell: here h Omega is 0.7 to 0.8.
    """

    system: ba.System
    state: ba.State
    h: float
    length: float
    time: float


def settings() -> dict[str, Setting]:
    """Return where symplecticity is looked at."""
    system, state = ba.catalogue.load("dumbbells")
    near = ba.propagate(system, state, duration=6 * u.s, integrator=ba.LGVI(1e-3 * u.s))[-1]
    return {
        "dumbbells": Setting(system, near, 0.08, 1.0, 1.0),
        "a tumbling pair": Setting(*tumbling_pair(), 1050.0, 1000.0, 5000.0),
        "four bodies": Setting(*four_bodies(1e10), 1050.0, 1000.0, 5000.0),
    }


def longer(setting: Setting) -> Setting:
    """Return a setting with a step four times as long: h Omega is about 3."""
    return setting._replace(h=4 * setting.h)


class Chart:
    """Variations of a state in units of order one: of length and time, and each body's own of mass and inertia."""

    def __init__(self, s: Setting) -> None:
        self.length, self.time = s.length, s.time
        self.m = np.array([body.si.mass for body in s.system.bodies])
        self.J = np.array([body.si.moments for body in s.system.bodies])
        self.rigid = self.J[:, 0] > 0
        self.orbit = self.m * s.length**2 / s.time  # the units of a body's blocks of the canonical form
        self.spin = np.where(self.rigid, self.J.max(axis=1), 1.0) / s.time

    def varied(self, state: ba.State, z: np.ndarray) -> ba.State:
        """Return a state with a variation."""
        dx, eta, dv, dPi = z.reshape(len(self.m), 4, 3).transpose(1, 0, 2)
        turn = Rotation.from_rotvec(eta * self.rigid[:, None]).as_matrix()
        dOmega = np.divide(dPi * self.spin[:, None], self.J, out=np.zeros_like(self.J), where=self.J > 0)
        return ba.State(
            state.position + dx * self.length * u.m,
            state.velocity + dv * self.length / self.time * u.m / u.s,
            state.attitude @ turn,
            state.spin + dOmega * u.rad / u.s,
        )

    def variation(self, one: Snapshot, base: Snapshot) -> np.ndarray:
        """Return the variation that leads from one moment to another."""
        eta = Rotation.from_matrix(np.swapaxes(base.R, -1, -2) @ one.R).as_rotvec()
        dPi = self.J * (one.Omega - base.Omega) / self.spin[:, None]
        parts = ((one.x - base.x) / self.length, eta, (one.v - base.v) * self.time / self.length, dPi)
        return np.stack(parts, axis=1).ravel()

    def form(self, Omega: np.ndarray) -> np.ndarray:
        """Return the matrix of the canonical form where the bodies spin so."""
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


def symplectic_defect(step: Map, s: Setting) -> float:
    """Return the largest element of D^T W' D - W, in the units of the two variables that it belongs to."""
    chart = Chart(s)
    base = step(s.system, s.state, s.h)
    free = np.repeat(np.stack([np.full_like(chart.rigid, True), chart.rigid] * 2, axis=1).ravel(), 3)
    columns = []
    for k in np.flatnonzero(free):
        z, column = np.zeros(len(free)), np.zeros(len(free))
        for multiple, weight in WEIGHTS:
            z[k] = multiple * WIDTH
            ahead, behind = (step(s.system, chart.varied(s.state, sign * z), s.h) for sign in (1, -1))
            column += weight * (chart.variation(ahead, base) - chart.variation(behind, base)) / WIDTH
        columns.append(column)
    jacobian = np.array(columns).T
    before, after = chart.form(s.state.si.spin)[np.ix_(free, free)], chart.form(base.Omega)
    unit = np.sqrt(np.repeat(np.stack([chart.orbit, chart.spin] * 2, axis=1).ravel(), 3)[free])
    return float(np.abs((jacobian.T @ after @ jacobian - before) / np.outer(unit, unit)).max())


def reversal_error(system: ba.System, state: ba.State, h: float, integrator: Stepping, count: int = 1) -> float:
    """Return how far some steps forward and as many back lead away: of distance, speed, radian and spin."""
    w = working.of(system, state, inertial=integrator.is_inertial(system))
    start = w.from_rows(w.state[None, : w.row_size], np.zeros(1))
    take_steps(w, h, count, integrator=integrator)
    take_steps(w, -h, count, integrator=integrator)
    end = w.from_rows(w.state[None, : w.row_size], np.zeros(1))
    return max(float(np.abs(one - two).max() / np.abs(two).max()) for one, two in zip(end[:4], start[:4], strict=True))


class Kept(NamedTuple):
    """Over a run: energy over |E0| and over |U0|, momenta, rotation error; and how much of the energy is a drift.

    The angular momentum is relative, the linear one over sum m |v|; the drift is over the whole run and over |E0|, with
    its standard deviation.
    """

    energy: float
    energy_over_potential: float
    angular: float
    linear: float
    rotation: float
    rotation_of_rows: float
    drift: tuple[float, float]


def kept(system: ba.System, state: ba.State, integrator: Stepping, stages: int) -> Kept:
    """Return what a run of so many stages keeps: as many evaluations of gravity."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.StepWarning)
        run = ba.propagate(
            system, state, duration=stages // integrator.shares.stages * integrator.step, integrator=integrator
        )
    return Kept(
        run.max_relative_energy_error,
        run.max_energy_error_over_potential,
        run.max_relative_angular_momentum_error,
        run.max_relative_linear_momentum_error,
        run.max_rotation_error,
        float(run.rotation_error.max()),
        drift(run.energy.value / abs(run.energy.value[0])),
    )


def drift(values: np.ndarray, blocks: int = 100) -> tuple[float, float]:
    """Return how far values go from end to end, by a straight line through means of blocks, and its deviation."""
    means = np.array([part.mean() for part in np.array_split(values - values[0], blocks)])
    (slope, _), covariance = np.polyfit(np.arange(blocks), means, 1, cov=True)
    return float(slope) * blocks, float(np.sqrt(covariance[0, 0])) * blocks


class Long(NamedTuple):
    """A long run: what its system is called, and a method with steps so short that its truncation is round-off."""

    name: str
    system: ba.System
    state: ba.State
    integrator: Stepping


def long_runs() -> list[Long]:
    """Return the runs in which the families show their round-off."""
    didymos, tumbling = ("didymos", *ba.catalogue.load("didymos")), ("tumbling pair", *tumbling_pair())
    second = u.s
    return [
        Long(*didymos, ba.LGVI(120 * second, order=8)),
        Long(*didymos, ba.Splitting(300 * second)),
        Long(*didymos, ba.Splitting(300 * second, frame="inertial")),
        Long(*didymos, ba.Splitting(900 * second, scheme="ss10")),
        Long(*didymos, ba.KeplerSplitting(300 * second)),
        Long(*tumbling, ba.LGVI(90 * second, order=8)),
        Long(*tumbling, ba.Splitting(200 * second)),
        Long(*tumbling, ba.Splitting(200 * second, frame="inertial")),
        Long(*tumbling, ba.Splitting(900 * second, scheme="ss10")),
        Long(*tumbling, ba.KeplerSplitting(120 * second)),
    ]


def conserved() -> None:
    """Print what runs of 10^5 to 10^7 stages keep."""
    print("kept, of energy over |E0| and |U0|, angular and linear momentum, rotation at every step and in saved rows;")
    print("and the drift of the energy over the run, with its deviation")
    runs = [
        Long("didymos", *ba.catalogue.load("didymos"), ba.LGVI(40 * u.s)),
        Long("didymos", *ba.catalogue.load("didymos"), ba.LGVI(40 * u.s, frame="inertial")),
        Long("sn263", *ba.catalogue.load("sn263"), ba.LGVI(60 * u.s)),
        *long_runs(),
    ]
    for run in runs:
        method = f"{type(run.integrator).__name__} {run.integrator.shares.name}, {run.integrator.frame or 'default'}"
        print(f"  {run.name}, {method} frame, steps of {run.integrator.step:g}")
        for stages in (10**5, 10**6, 10**7):
            *figures, (total, deviation) = kept(run.system, run.state, run.integrator, stages)
            print(f"    {stages:8}:", *(f"{value:.1e}" for value in figures), f"drift {total:+.1e} +- {deviation:.1e}")


def figure_5() -> tuple[float, float]:
    """Return the largest |E - E0| in the paper's units and ||I - R^T R|| of (118)-(127) as printed, to t = 15."""
    system, state = ba.catalogue.load("dumbbells")
    equations = ba.equations.discrete(system, step=2e-4 * u.s, frame="relative", form="hamiltonian")
    y = equations.from_state(state)
    start = equations.invariants(y)
    energy_error = rotation_error = 0.0
    for _ in range(15_000):  # a look at every fifth step
        y = equations.advance(y, 5)
        now = equations.invariants(y)
        energy_error = max(energy_error, abs(now.energy - start.energy))
        rotation_error = max(rotation_error, now.rotation_error)
    return energy_error / UNIT_OF_ENERGY, rotation_error


def figure_6() -> tuple[ba.Trajectory, ba.Trajectory]:
    """Return a loose Runge-Kutta run of (63)-(70) to t = 15, and a variational one with as many evaluations of U."""
    system, state = ba.catalogue.load("dumbbells")
    loose = ba.RungeKutta(method="RK45", rtol=1e-4, atol=1e-6)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.StepWarning)  # that it failed is the point
        failed = ba.propagate(system, state, duration=15 * u.s, integrator=loose)
    evaluations = 6 * failed.steps  # at the least: six to a step of theirs, one to a step of ours
    step = 15 / evaluations * (1 + 1e-6) * u.s
    return failed, ba.propagate(system, state, duration=15 * u.s, integrator=ba.LGVI(step))


def sn263() -> ba.Trajectory:
    """Return a year of the triple."""
    e = ba.catalogue.entry("sn263")
    return ba.propagate(e.system, e.state, duration=e.duration, integrator=e.integrator, save_every=e.save_every)


def main() -> None:
    """Print all of it."""
    print("symplectic: largest element of D^T W' D - W")
    for where, setting in settings().items():
        for name, step in of_setting(setting).items():
            long = f", at 4 h {symplectic_defect(step, longer(setting)):.1e}" if name in EXACT else ""
            print(f"  {where}, {name}: {symplectic_defect(step, setting):.1e}{long}")
        for name, step in OTHERS.items():
            at = symplectic_defect(step, setting), symplectic_defect(step, longer(setting))
            print(f"  {where}, to compare, {name}: {at[0]:.1e}, at 4 h {at[1]:.1e}")
    print("reversal: one step forward and back, and 2000, relative")
    for where, (system, state) in (("tumbling pair", tumbling_pair()), ("four bodies", four_bodies())):
        for name, integrator in (INTEGRATORS if len(system.bodies) == 2 else INERTIAL).items():
            once, often = (reversal_error(system, state, 20.0, integrator, count) for count in (1, 2000))
            print(f"  {where}, {name}: {once:.1e}, {often:.1e}")
    conserved()
    energy, rotation = figure_5()
    print(
        f"Fig. 5, (118)-(127) as printed: energy {energy:.4e} (paper 2.6966e-7), rotation {rotation:.2e} (2.8657e-13)"
    )
    failed, good = figure_6()
    for run in (failed, good):
        figures = f"{run.max_energy_error.value / UNIT_OF_ENERGY:.2e} (paper 1.1246e-2), {run.max_rotation_error:.2e}"
        print(f"  Fig. 6, {type(run.integrator).__name__}, {run.steps} steps: {figures} (2.2435e-2)")
    year = sn263()
    print(year.summary())


if __name__ == "__main__":
    main()
