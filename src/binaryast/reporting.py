"""A run that is over as a trajectory: its figures, what it must warn of, and what is needed to repeat it."""

import platform
import warnings
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from typing import Any

import numpy as np

from binaryast import constants
from binaryast.errors import EndWarning, GravityWarning, StepWarning
from binaryast.events import Contact, Event
from binaryast.gravity import LARGEST_DEGREE
from binaryast.integrators import Integrator, Taylor
from binaryast.kernels import loop
from binaryast.kernels.clearance import least_clearance
from binaryast.kernels.jit import source_hash
from binaryast.outcome import Outcome
from binaryast.rows import TrajectoryFloats
from binaryast.run_file import pieces_of
from binaryast.state import State
from binaryast.system import Pair, System
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, quantity
from binaryast.working.base import surfaces

DOUBTFUL_ENERGY_ERROR = 0.01
DOUBTFUL_TERM = 1e-3  # of gravity that is left out, over G m1 m2/r
TERM_ROWS = 1000  # how many of the saved rows are looked at for it


def trajectory_of(
    system: System,
    state: State,
    events: tuple[Event, ...],
    outcome: Outcome,
    integrator: Integrator,
    asked: dict[str, Any],
) -> Trajectory:
    """Return what has been computed of a run from a state, and warn where it ended early or badly."""
    if outcome.status in ("contact", "failed"):
        warnings.warn(f"the run ended after {outcome.time[-1]:g} s: {outcome.message}", EndWarning, stacklevel=4)
    figures = _figures(system, outcome)
    of_total, of_potential = figures["max_relative_energy_error"], figures["max_energy_error_over_potential"]
    error = min(of_total, of_potential)
    if of_potential > 10 * DOUBTFUL_ENERGY_ERROR and of_total > 1e-6:  # large spins hide the orbit in the total
        error = of_potential
    if error > DOUBTFUL_ENERGY_ERROR:
        cause = "its tolerances are too loose" if integrator.adaptive else f"a step of {outcome.step:g} s is too large"
        warnings.warn(
            f"the energy was wrong by {error:.2g} of its size at some step: {cause} for what happened, such as a "
            "close approach",
            StepWarning,
            stacklevel=4,
        )
    figures["max_next_degree_term"] = _next_degree_term(system, outcome)
    return Trajectory(
        system=system,
        integrator=integrator,
        si=TrajectoryFloats(*(_in_memory(part) for part in (outcome.time, *outcome.motion))),
        epoch=state.epoch,
        frame=state.frame,
        status=outcome.status,
        message=outcome.message,
        steps=outcome.steps,
        step=quantity(outcome.step, "s"),
        wall_time=quantity(outcome.wall_time, "s"),
        watched=_watched(system, events, outcome),
        occurrences=outcome.occurrences,
        provenance=provenance() | ({"heyoka": version("heyoka")} if isinstance(integrator, Taylor) else {}),
        **figures,
        **asked,
    )


def _watched(system: System, events: tuple[Event, ...], outcome: Outcome) -> tuple[Event, ...]:
    """Return what was looked for, and the contact that ended a run where it was none of that."""
    indices = outcome.occurrences.event
    if len(indices) and int(indices[-1]) >= len(events):
        position, attitude = outcome.occurrences.position[-1:], outcome.occurrences.attitude[-1:]
        pair = int(least_clearance(position[0], attitude[0], surfaces(system))[1])
        events = (*events, Contact(tuple(system.names[i] for i in system.pairs[pair][:2])))
    return events


def _in_memory(rows: Any) -> Floats:
    """Return rows, the last alone of those that are in a file."""
    return rows if isinstance(rows, np.ndarray) else np.asarray(rows[len(rows) - 1 :])


def _figures(system: System, outcome: Outcome) -> dict[str, Any]:
    """Return the largest errors in the ways in which they are reported."""
    watch = outcome.watch.array
    energy_error = float(watch[loop.ENERGY_ERROR])
    angular = float(np.linalg.norm(watch[loop.ANGULAR_MOMENTUM : loop.ANGULAR_MOMENTUM + 3]))
    masses = np.array([body.si.mass * body.pulls for body in system.bodies])
    velocity = outcome.motion.velocity
    impulse = outcome.motion.impulse
    first = np.einsum("i,nij->nj", masses, velocity[:1]) - impulse[:1]
    of_rows = 0.0
    for begin, end in pieces_of(len(velocity)):
        linear = np.einsum("i,nij->nj", masses, velocity[begin:end]) - impulse[begin:end]
        of_rows = max(of_rows, float(np.linalg.norm(linear - first, axis=1).max()))
    speeds = masses @ np.linalg.norm(velocity[:1][0], axis=1)
    return {
        "max_relative_energy_error": _over(energy_error, abs(watch[loop.ENERGY])),
        "max_energy_error": quantity(energy_error, "J"),
        "max_energy_error_over_potential": _over(energy_error, abs(outcome.watch.potential_energy)),
        "max_relative_angular_momentum_error": _over(float(watch[loop.ANGULAR_ERROR]), angular),
        "max_relative_linear_momentum_error": _over(max(of_rows, float(watch[loop.LINEAR_ERROR])), speeds),
        "max_rotation_error": float(watch[loop.ROTATION_ERROR]),
        "closest_approach": quantity(float(watch[loop.CLOSEST]), "m"),
        "closest_approach_time": quantity(outcome.closest_time, "s"),
    }


def _next_degree_term(system: System, outcome: Outcome) -> float | None:
    """Return the largest size of the terms that gravity leaves out, and warn of a doubtful one; None without a cut."""
    sizes: list[tuple[float, Pair]] = []
    for pair in system.pairs:
        primary, secondary = system.bodies[pair.primary], system.bodies[pair.secondary]
        terms = pair.gravity.next_terms(secondary, primary, *_configurations(outcome, pair))
        if terms is not None:
            sizes.append((float(terms.max(initial=0.0)), pair))
    if not sizes:
        return None
    size, pair = max(sizes, key=lambda item: item[0])
    if size > DOUBTFUL_TERM:
        warnings.warn(
            f"{pair.gravity!r} between {system.names[pair.primary]} and {system.names[pair.secondary]} leaves out "
            f"terms up to {size:.2g} of G m1 m2/r, and more of the torques: {_remedy(system, outcome, pair)}",
            GravityWarning,
            stacklevel=5,
        )
    return size


def _remedy(system: System, outcome: Outcome, pair: Pair) -> str:
    """Return what helps where gravity leaves out too much."""
    closest = float(np.linalg.norm(_configurations(outcome, pair)[0], axis=1).min(initial=np.inf))
    points = "take ba.PointPairs() of bodies filled with points, ba.mascons"
    if closest < system.bodies[pair.primary].bounding_radius + system.bodies[pair.secondary].bounding_radius:
        return f"at {closest:.4g} m spheres that hold the bodies meet, a higher degree need not be better: {points}"
    if pair.gravity.cut_at == LARGEST_DEGREE:
        return f"there is no higher degree: {points}"
    return "take a higher degree of ba.Multipole"


def _configurations(outcome: Outcome, pair: Pair) -> tuple[Floats, Floats]:
    """Return X (N, 3) and R (N, 3, 3) of a pair, (34) and (35), at saved rows, that of its closest among them."""
    one, two = pair.secondary, pair.primary
    position, attitude = outcome.motion.position, outcome.motion.attitude
    count, closest, row = len(position), np.inf, 0
    for begin, end in pieces_of(count):
        piece = position[begin:end]
        distances = np.linalg.norm(piece[:, one] - piece[:, two], axis=1)
        if distances.min() < closest:
            closest, row = distances.min(), begin + int(np.argmin(distances))
    rows = np.append(np.unique(np.linspace(0, count - 1, min(count, TERM_ROWS)).astype(int)), row)
    places, turns = position[rows], attitude[rows]
    apart = places[:, one] - places[:, two]
    distinct = np.any(apart, axis=1)
    to_primary = np.swapaxes(turns[distinct, two], -1, -2)
    return np.einsum("nij,nj->ni", to_primary, apart[distinct]), to_primary @ turns[distinct, one]


def _over(error: float, size: float) -> float:
    """Return a relative error; the absolute one where there is nothing to compare it with."""
    return float(error / size) if size > 0 else error


def provenance() -> dict[str, str]:
    """Return what is needed to repeat a run: versions, sources, machine, date, and G."""
    return _origin() | {"date": datetime.now(UTC).isoformat(timespec="seconds")}


@cache
def _origin() -> dict[str, str]:
    """Return what does not change in a process: looking it up takes longer than a short run."""
    return {
        "binaryast": constants.VERSION,
        "kernels": source_hash(),
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "numba", "astropy", "h5py")},
        "machine": f"{platform.machine()} {platform.system()}",
        "host": platform.node(),
        "G": repr(constants.G),
    }
