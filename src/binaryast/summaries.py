"""What is said of a run in a few lines: how it ended, its cost, its errors, what happened in it."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from binaryast.units import span

MOST_NAMES = 8


def summary(run: Any) -> str:
    """Return a few lines: how the run ended, its cost, and how well it conserved what it should."""
    reach = span(run.si.time[-1])
    if run.si.time[0] > 0:
        reach = f"rows from {span(run.si.time[0])} to {reach} of a run"
    speed = f", {run.wall_time.value / run.steps * 1e6:.2f} us each" if run.steps else ""
    average = " on average" if run.integrator.adaptive else ""
    lines = [
        f"{joined(run.system.names)}: {run.status}" + (f": {run.message}" if run.message else ""),
        f"  {reach} in {run.steps} steps of {run.step.value:g} s{average}, {len(run)} rows kept; "
        f"{run.wall_time.value:.2g} s{speed}",
        *_distances(run),
        *(f"  {line}" for line in kicks(run)),
        *(f"  {line}" for line in from_outside(run)),
        *(f"  {line}" for line in happenings(run)),
        f"  largest errors: energy {run.max_relative_energy_error:.4e} of |E0| "
        f"({run.max_energy_error_over_potential:.2e} of |U0|), "
        f"momentum angular {run.max_relative_angular_momentum_error:.1e}, "
        f"linear {run.max_relative_linear_momentum_error:.1e}, "
        f"rotation {run.max_rotation_error:.1e}",
    ]
    if run.accuracy is not None:
        error = "not known" if run.estimated_error is None else f"{run.estimated_error:.1e}"
        lines.append(f"  accuracy {run.accuracy:g} asked, error at the end {error} as estimated")
        lines.append(f"  {run.choice}")
    if any(pair.gravity.cut_at is not None for pair in run.system.pairs):
        size = run.max_next_degree_term
        known = "not known" if size is None else f"at most {size:.1e} of G m1 m2/r"
        lines.append(f"  next degrees of gravity: {known}")
    return "\n".join(lines)


def kicks(run: Any) -> list[str]:
    """Return a line for each impulse: when, on which body, and by how much its velocity changed."""
    lines = []
    for impulse in run.impulses:
        name = run.system.names[run.system.index(impulse.body)]
        speed = float(np.linalg.norm(impulse.velocity_change(run.system).value))
        after = span(impulse.time.value) + (", not reached" if impulse.time.value > run.si.time[-1] else "")
        lines.append(f"{type(impulse).__name__} on {name} after {after}: its velocity changes by {speed:.5g} m/s")
    return lines


def from_outside(run: Any) -> list[str]:
    """Return what acted from outside, and the work that it did."""
    if not run.system.perturbations:
        return []
    names = ", ".join(dict.fromkeys(type(one).__name__ for one in run.system.perturbations))
    return [f"from outside: {names}; work {run.si.work[-1] - run.si.work[0]:.4g} J"]


def happenings(run: Any) -> list[str]:
    """Return a line for each event that was looked for: how often it happened, and when first and last."""
    lines = []
    for i, event in enumerate(run.watched):
        times = run.occurrences.time[run.occurrences.event == i]
        often = {0: "never", 1: "once"}.get(len(times), f"{len(times)} times")
        when = f", after {span(times[0])}" if len(times) else ""
        last = f", last after {span(times[-1])}" if len(times) > 1 else ""
        lines.append(
            f"{event.title(run.system)}: {often}{when.replace('after', 'first after') if last else when}{last}"
        )
    return lines


def _distances(run: Any) -> list[str]:
    """Return what the summary says of distances: of a pair, or of each other body from the primary."""
    closest = f"closest {run.closest_approach.value:.6g} m after {span(run.closest_approach_time.value)}"
    names = run.system.names
    lines = []
    for i in range(1, len(names)):
        d = run.distance(0, i).value
        of = "" if len(names) == 2 else f" of {names[i]} from {names[0]}"
        lines.append(f"  separation{of} {d[0]:.6g} m at the start, {d[-1]:.6g} m at the end")
    return [f"{lines[0]}, {closest}"] if len(names) == 2 else [*lines, f"  any two: {closest}"]


def joined(names: Sequence[str]) -> str:
    """Return names as one would say them; of very many the first, and how many others there are."""
    if len(names) > MOST_NAMES:
        return f"{', '.join(names[: MOST_NAMES - 1])} and {len(names) - MOST_NAMES + 1} others"
    return f"{', '.join(names[:-1])} and {names[-1]}"
