"""What a stage costs against the size of a problem: the degree of gravity, the pairs of points, the bodies.

A stage is one drift with its evaluation of gravity: of ABA(10,4) for pairs, of RKN6a for several bodies.
"""

import time
from collections.abc import Callable, Sequence
from typing import NamedTuple

import astropy.units as u
import numpy as np
from matplotlib.figure import Figure

import binaryast as ba
from binaryast import working
from binaryast.integrators import Stepping
from validation import drawing
from validation.benchmark.problems import as_clouds, clouds
from validation.benchmark.tables import rows
from validation.costs import swarm
from validation.steps import take_steps
from validation.systems import wobbling_pair

ROUNDS = 5
SECONDS = 0.04  # of one timing
OF_PAIRS, OF_BODIES = ba.KeplerSplitting(1 * u.h, scheme="aba104"), ba.Splitting(1 * u.h, frame="inertial")
DEGREES = (2, 4, 6, 8, 10, 12)
POINTS = (2, 4, 8, 16, 32, 64, 128, 256, 512, 1000)  # of each body
BODIES = (2, 3, 5, 10, 20)


class Series(NamedTuple):
    """The cost of a stage [us] against a size."""

    title: str
    size: str
    sizes: tuple[int, ...]
    microseconds: tuple[float, ...]

    @property
    def exponent(self) -> float:
        """The slope in logarithms over the largest three sizes."""
        return float(np.polyfit(np.log(self.sizes[-3:]), np.log(self.microseconds[-3:]), 1)[0])


def stage_timer(system: ba.System, state: ba.State, integrator: Stepping, step: float) -> Callable[[], float]:
    """Return a function that measures a stage [us of CPU time], compiled and warm."""
    w = working.of(system, state, inertial=integrator.is_inertial(system))
    start = w.state.copy()

    def take(count: int) -> float:
        w.state[:] = start
        began = time.thread_time()
        take_steps(w, step, count, integrator=integrator, touching=True)
        return time.thread_time() - began

    take(1)
    count = max(1, int(SECONDS / max(take(1), 1e-5)))
    count = max(1, min(4000, int(count * SECONDS / max(take(count), 1e-5))))
    stages = len(integrator.shares.drifts)
    return lambda: take(count) / (count * stages) * 1e6


def of_degrees(*, even: bool) -> dict[int, Callable[[], float]]:
    """Return timers of the multipole gravity of ellipsoids, or of bodies with all moments."""
    pair, state = wobbling_pair()
    bodies = list(pair.bodies) if even else as_clouds(pair, 31)  # points in a spiral are not symmetric
    systems = {degree: ba.System(bodies, gravity=ba.Multipole(degree)) for degree in DEGREES}
    return {degree: stage_timer(system, state, OF_PAIRS, 3600.0) for degree, system in systems.items()}


def of_points() -> dict[int, Callable[[], float]]:
    """Return timers of pairs of points, by how many pairs there are."""
    return {count**2: stage_timer(*clouds(count)(), OF_PAIRS, 3600.0) for count in POINTS}


def of_bodies() -> dict[int, Callable[[], float]]:
    """Return timers of so many ellipsoids, every pair of them at second degree."""
    return {count: stage_timer(*swarm(count), OF_BODIES, 100.0) for count in BODIES}


def measured() -> list[Series]:
    """Measure all series, in turn, and keep the best of the rounds."""
    timers = {
        ("ellipsoids", "degree"): of_degrees(even=True),
        ("bodies with all moments", "degree"): of_degrees(even=False),
        ("pairs of points", "pairs of points"): of_points(),
        ("bodies, each pair at second degree", "bodies"): of_bodies(),
    }
    best: dict[tuple[tuple[str, str], int], float] = {}
    for _ in range(ROUNDS):
        for key, of_size in timers.items():
            for size, timer in of_size.items():
                best[key, size] = min(best.get((key, size), np.inf), timer())
    return [Series(*key, tuple(of_size), tuple(best[key, size] for size in of_size)) for key, of_size in timers.items()]


def report(found: Sequence[Series]) -> str:
    """Return the tables in Markdown."""
    text = ["", "## What a stage costs against the size", ""]
    for series in found:
        pairs = zip(series.sizes, series.microseconds, strict=True)
        text += rows([[series.size, "us per stage"], *([f"{size}", f"{cost:.3g}"] for size, cost in pairs)])
        text += ["", f"{series.title}: as {series.size} to the power {series.exponent:.2f} over the largest three.", ""]
    return "\n".join(text)


def figure(found: Sequence[Series]) -> Figure:
    """Return the figure: a panel for each kind of size."""
    kinds = list(dict.fromkeys(series.size for series in found))
    result, panels = drawing.axes(len(kinds), ylabel="us per stage")
    for k, series in enumerate(found):
        ax = panels[kinds.index(series.size)]
        label = f"{series.title}, exponent {series.exponent:.2f}"
        drawing.curve(ax, series.sizes, series.microseconds, label, k)
        ax.set_xlabel(series.size)
        if len(series.sizes) < 8:
            drawing.ticks(ax, series.sizes)
        drawing.legend(ax)
    return result
