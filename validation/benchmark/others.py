"""REBOUND's integrators in the limit of points, and SciPy's DOP853 on heyoka's compiled equations, as candidates."""

import time
from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_ivp

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.benchmark.measure import Candidate, Run
from validation.benchmark.problems import Problem
from validation.benchmark.taylor_runs import COMPACT, equations
from validation.oracles import nbody

STEPS = {"leapfrog": (4.0, 400.0, 5), "whfast": (10.0, 800.0, 5), "saba": (400.0, 20000.0, 7)}
TITLES = {"leapfrog": "leapfrog", "whfast": "WHFast", "saba": "SABA(10,6,4)"}


def rebound_candidates(problem: Problem) -> list[Candidate]:
    """Return REBOUND's leapfrog, WHFast, SABA and IAS15."""
    system, state = problem.make()
    result = []
    for name, (shortest, longest, count) in STEPS.items():
        for step in np.geomspace(longest, shortest, count):
            number = int(np.ceil(problem.duration / step))
            go = rebound_run(system, state, problem.duration, name, number)
            result.append(Candidate("REBOUND", TITLES[name], f"{problem.duration / number:.4g} s", go))
    for epsilon in (1e-1, 1e-3, 1e-5, 1e-7, 1e-9):
        go = rebound_run(system, state, problem.duration, "ias15", epsilon=epsilon)
        result.append(Candidate("REBOUND", "IAS15", f"{epsilon:g}", go))
    return result


def rebound_run(
    system: ba.System, state: ba.State, duration: float, name: str, count: int = 0, epsilon: float = 1e-9
) -> Callable[[], Run]:
    """Return a function that runs one of REBOUND's integrators once: so many steps, or IAS15 to a tolerance."""

    def go() -> Run:
        sim = nbody.simulation(system, state.si.position, state.si.velocity, name)
        if name == "ias15":
            sim.integrator.epsilon = epsilon
            sim.dt = 1e-4 * duration
            began = time.thread_time()
            sim.integrate(duration)
        else:
            if name == "saba":
                sim.integrator.safe_mode = 0
            sim.dt = duration / count
            began = time.thread_time()
            sim.steps(count)
        position, velocity = nbody.motion(sim)
        seconds = time.thread_time() - began
        return Run(seconds, seconds, Snapshot(velocity, state.si.spin, position, state.si.attitude))

    return go


def scipy_candidates(problem: Problem) -> list[Candidate]:
    """Return DOP853 at a few tolerances, with heyoka's compiled right-hand side."""
    at = equations(problem, COMPACT)
    rates = at.right_hand_side()
    end = problem.duration / at.units.time

    def run_of(tolerance: float) -> Callable[[], Run]:
        def go() -> Run:
            began = time.thread_time()
            solution = solve_ivp(
                lambda _, y: rates(y), (0.0, end), at.y, method="DOP853", rtol=tolerance, atol=tolerance, t_eval=[end]
            )
            seconds = time.thread_time() - began
            return Run(seconds, seconds, at.snapshot(solution.y[:, -1]))

        return go

    return [Candidate("SciPy", "DOP853", f"{tolerance:g}", run_of(tolerance)) for tolerance in (1e-7, 1e-9, 1e-11)]
