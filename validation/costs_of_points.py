"""What a step of point masses costs beside REBOUND's, in the same rounds, and where our time goes.

REBOUND's leapfrog and WHFast are called as they are compiled, without watching anything; its half steps are joined
(``safe_mode`` 0). Ours are steps of a run: energy, momenta and contact are looked at after each of them.
"""

import statistics
from collections.abc import Callable
from importlib.util import find_spec
from typing import Any

import astropy.units as u
import numba
import numpy as np

import binaryast as ba
from binaryast import working
from binaryast.integrators import Stepping
from binaryast.kernels.bodies.stages import exert
from binaryast.working import Working
from validation.oracles import nbody
from validation.steps import take_steps
from validation.timing import Job, interleaved

COUNTS = (2, 3, 10)
STEP = 60.0  # s, of orbits of 7 h and more
SECOND = 1 * u.s
ROUNDS = 9


def points(count: int) -> tuple[ba.System, ba.State]:
    """Return a heavy point and others on circles about it, each half as far again as the one before."""
    masses = np.array([1e12] + [1e8] * (count - 1))
    orders, phases = np.arange(count), 2.4 * np.arange(count)
    radius = np.where(orders > 0, 1e3 * 1.5**orders, 0.0)
    speed = np.sqrt(ba.constants.G * masses[0] / np.where(orders > 0, radius, np.inf))
    zero = np.zeros(count)
    place = radius[:, None] * np.stack([np.cos(phases), np.sin(phases), 0.01 * orders], axis=1)
    velocity = speed[:, None] * np.stack([-np.sin(phases), np.cos(phases), zero], axis=1)
    bodies = [ba.RigidBody(str(i), ba.Point(), mass=mass * u.kg) for i, mass in enumerate(masses)]
    state = ba.State(place * u.m, velocity * u.m / u.s, [np.eye(3)] * count, np.zeros((count, 3)) * u.rad / u.s)
    return ba.System(bodies, gravity=ba.PointMass()), state


def ours(system: ba.System, state: ba.State, integrator: Stepping) -> Callable[[int], None]:
    """Return a function that takes watched steps."""
    w = working.of(system, state, inertial=integrator.is_inertial(system))
    start = w.state.copy()

    def take(count: int) -> None:
        w.state[:] = start
        take_steps(w, STEP, count, integrator=integrator, touching=True)

    return take


def rebounds(system: ba.System, state: ba.State, name: str) -> Callable[[int], None]:
    """Return a function that takes steps of REBOUND's."""
    sim = nbody.simulation(system, state.si.position, state.si.velocity, name)
    sim.dt = STEP

    def take(count: int) -> None:
        sim.steps(count)
        sim.synchronize()

    return take


def jobs(count: int) -> dict[str, Job]:
    """Return the jobs of so many points."""
    system, state = points(count)
    tested: dict[str, Stepping] = {"LGVI": ba.LGVI(SECOND), "Splitting leapfrog": ba.Splitting(SECOND, "leapfrog")}
    if count == 2:
        tested["LGVI, inertial frame"] = ba.LGVI(SECOND, frame="inertial")
        tested["KeplerSplitting aba864, 7 stages"] = ba.KeplerSplitting(SECOND)
    each = 200_000 // count**2
    found: dict[str, Job] = {name: (ours(system, state, integrator), each) for name, integrator in tested.items()}
    for name in ("leapfrog", "whfast"):
        found[f"REBOUND {name}"] = rebounds(system, state, name), each
    return found


@numba.njit
def repeat_step(
    repeats: int, step: Any, state: Any, constants: Any, shares: Any, table: Any, parameters: Any, external: Any
) -> None:
    """Take unwatched steps."""
    for _ in range(repeats):
        step(state, constants, shares, table, parameters, external, STEP)


@numba.njit
def repeat_gravity(repeats: int, state: Any, constants: Any, table: Any, parameters: Any) -> None:
    """Evaluate gravity of all pairs."""
    for _ in range(repeats):
        exert(state, constants, table, parameters)


@numba.njit
def repeat_watch(repeats: int, measure: Any, state: Any, constants: Any) -> float:
    """Look at what is watched."""
    total = 0.0
    for _ in range(repeats):
        total += measure(state, constants)[0]
    return total


@numba.njit
def repeat_contact(repeats: int, touching: Any, state: Any, surfaces: Any, before: Any) -> int:
    """Look for contact."""
    total = 0
    for _ in range(repeats):
        total += touching(state, surfaces, before)
    return total


def parts(w: Working, kernel: Any, shares: np.ndarray, count: int) -> dict[str, Job]:
    """Return the parts of a watched step in the inertial frame: the step, gravity in it, the watch, contact."""
    start, each = w.state.copy(), 100_000 // count**2
    return {
        "step": (
            lambda k: repeat_step(k, kernel, w.state, w.constants, shares, w.attraction, w.parameters, w.external),
            each,
        ),
        "gravity in it": (lambda k: repeat_gravity(k, w.state, w.constants, w.attraction, w.parameters), each),
        "watch": (lambda k: repeat_watch(k, w.measure, w.state, w.constants), each),
        "contact": (lambda k: repeat_contact(k, w.touching, w.state, w.surfaces, start), each),
    }


def main() -> None:
    """Measure and print, where REBOUND is installed."""
    if find_spec("rebound") is None:
        print("\nREBOUND is not installed: point masses are not compared")
        return
    print(f"\n{'points: one step':44} {'us, median':>12} {'us, best':>10} {'leapfrog':>9} {'whfast':>8}")
    for count in COUNTS:
        times = interleaved(jobs(count), ROUNDS)
        for name, values in times.items():
            over = [np.array(values) / times[f"REBOUND {other}"] for other in ("leapfrog", "whfast")]
            ratios = " ".join(f"{statistics.median(ratio):8.2f}" for ratio in over)
            print(f"{count:2} {name:41} {statistics.median(values):12.3f} {min(values):10.3f}  {ratios}")
    print("the last columns: over REBOUND's, median of rounds")
    integrator = ba.LGVI(SECOND, frame="inertial")
    for count in COUNTS:
        w = working.of(*points(count), inertial=True)
        kernel = integrator.kernel(inertial=True)
        found = interleaved(parts(w, kernel, integrator.shares.shares, count), ROUNDS)
        print(f"{count:2} points: " + ", ".join(f"{name} {min(values):.3f} us" for name, values in found.items()))


if __name__ == "__main__":
    main()
