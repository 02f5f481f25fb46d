"""The edges of the paper's commutative cube (Fig. 7), measured: ``python -m validation.cube``.

Its corners are the eight forms: continuous or discrete, inertial or relative, Lagrangian or Hamiltonian. Along an edge
two forms are the same motion, but for the step where one of them is discrete.
"""

from functools import cache
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.integrate import solve_ivp

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.differences import Difference, difference
from validation.systems import four_bodies, wobbling_pair

STEPS = 10_000  # of the discrete forms that are compared with each other
TOLERANCE = 1e-12  # of the continuous ones
FRAMES, FORMS = ("inertial", "relative"), ("lagrangian", "hamiltonian")


class Case(NamedTuple):
    """A system, its start, the step [s]; until when it is held to the continuous motion, and in how many steps."""

    system: ba.System
    state: ba.State
    step: float
    end: float
    steps: tuple[int, int, int]


@cache
def case(name: str) -> Case:
    """Return a case by its name."""
    if name == "dumbbells":
        return Case(*ba.catalogue.load("dumbbells"), 2e-4, 2.0, (1000, 2000, 4000))
    if name == "ellipsoids":
        return Case(*wobbling_pair(), 40.0, 6 * 3600.0, (270, 540, 1080))
    return Case(*four_bodies(), 20.0, 6 * 3600.0, (540, 1080, 2160))


CASES = ("dumbbells", "ellipsoids", "four bodies")


@cache
def stepped(name: str, frame: str, form: str, summed: bool) -> Snapshot:
    """Return where a discrete form is after `STEPS` steps."""
    system, state, step, _, _ = case(name)
    equations = ba.equations.discrete(system, step=step * u.s, frame=frame, form=form, summed=summed)
    return equations.snapshot(equations.advance(equations.from_state(state), STEPS))


@cache
def flowed(name: str, frame: str, form: str, tolerance: float = TOLERANCE) -> Snapshot:
    """Return where a continuous form is at the end, by SciPy's DOP853."""
    system, state, _, end, _ = case(name)
    equations = ba.equations.continuous(system, frame=frame, form=form)
    y = equations.from_state(state)
    scales = tolerance * equations.scales(y)
    solution = solve_ivp(equations.rhs, (0, end), y, method="DOP853", rtol=tolerance, atol=scales)
    return equations.snapshot(solution.y[:, -1])


def slopes(name: str, frame: str, form: str) -> Difference:
    """Return the order with which a discrete form converges to the continuous one of the same frame and form."""
    system, state, _, end, counts = case(name)
    flow = flowed(name, frame, form, 1e-13)
    errors = []
    for count in counts:
        equations = ba.equations.discrete(system, step=end / count * u.s, frame=frame, form=form)
        errors.append(difference(equations.snapshot(equations.advance(equations.from_state(state), count)), flow))
    return Difference(*np.log2(np.divide(errors[-2], errors[-1])))


def frames(name: str) -> tuple[str, ...]:
    """Return the frames of a case: the relative one is for pairs."""
    return FRAMES if len(case(name).system.bodies) == 2 else FRAMES[:1]


def edges(name: str) -> dict[str, Difference]:
    """Return the difference along each edge of a case, and the order where it leads from continuous to discrete."""
    result = {}
    for frame in frames(name):
        hamiltonian = stepped(name, frame, "hamiltonian", False)
        result[f"discrete, {frame}: Lagrangian as printed - Hamiltonian"] = difference(
            stepped(name, frame, "lagrangian", False), hamiltonian
        )
        result[f"discrete, {frame}: Lagrangian summed - Hamiltonian"] = difference(
            stepped(name, frame, "lagrangian", True), hamiltonian
        )
        result[f"continuous, {frame}: Lagrangian - Hamiltonian"] = difference(
            flowed(name, frame, "lagrangian"), flowed(name, frame, "hamiltonian")
        )
    if len(frames(name)) == 2:
        for form, summed, called in (
            ("hamiltonian", False, "Hamiltonian"),
            ("lagrangian", True, "Lagrangian summed"),
            ("lagrangian", False, "Lagrangian as printed"),
        ):
            result[f"discrete, {called}: relative - inertial"] = difference(
                stepped(name, "relative", form, summed), stepped(name, "inertial", form, summed)
            )
        for form in FORMS:
            result[f"continuous, {form.capitalize()}: relative - inertial"] = difference(
                flowed(name, "relative", form), flowed(name, "inertial", form)
            )
    for frame in frames(name):
        for form in FORMS:
            result[f"order, {frame}, {form.capitalize()}: discrete -> continuous"] = slopes(name, frame, form)
    return result


def main() -> None:
    """Print every edge of every case."""
    for name in CASES:
        print(f"{name}: {STEPS} steps of {case(name).step:g} s; continuous to {case(name).end:g} s at {TOLERANCE:g}")
        print(f"  {'':62} {'position':>9} {'velocity':>9} {'attitude':>9} {'spin':>9} {'largest':>9}")
        for edge, values in edges(name).items():
            form = "{:9.4f}" if edge.startswith("order") else "{:9.1e}"
            print(f"  {edge:62} {' '.join(form.format(value) for value in (*values, values.largest))}")


if __name__ == "__main__":
    main()
