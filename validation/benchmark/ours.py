"""Our methods as candidates: `binaryast.propagate` as a user calls it, one row at the end."""

import os
import subprocess
import sys
import tempfile
import time
import warnings

import astropy.units as u
import numpy as np

import binaryast as ba
from validation.benchmark.measure import Candidate, Run
from validation.benchmark.problems import BY_NAME, Problem
from validation.differences import snapshot_of

COMPILING = """
import time, warnings
from validation.benchmark import ours
from validation.benchmark.problems import BY_NAME
warnings.simplefilter("ignore")
candidates = ours.candidates(BY_NAME[{name!r}], quick=True)
first = candidates[0]
began = time.perf_counter()
first.go()
between = time.perf_counter()
first.go()
end = time.perf_counter()
for other in candidates[1:]:
    other.go()
print(between - began - (end - between), time.perf_counter() - end)
"""


def candidates(problem: Problem, *, quick: bool = False) -> list[Candidate]:
    """Return our methods at all their steps; a quick one tries every third."""
    result = []
    system, state = problem.make()
    for sweep in problem.sweeps:
        for step in sweep.steps[:: 3 if quick else 1]:
            integrator = sweep.make(step * u.s)
            result.append(Candidate("ours", sweep.method, f"{step:.4g} s", run_of(system, state, problem, integrator)))
    return result


def run_of(system: ba.System, state: ba.State, problem: Problem, integrator: ba.LGVI) -> "Run":
    """Return a function that runs a method once."""

    def go() -> Run:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the longest steps are doubtful, which is the point
            began = time.thread_time()
            run = ba.propagate(
                system, state, duration=problem.duration * u.s, integrator=integrator, save_every=problem.duration * u.s
            )
            call = time.thread_time() - began
        end = snapshot_of(run[-1])
        if run.status != "completed":
            end = end._replace(x=np.full_like(end.x, np.nan))
        return Run(run.wall_time.value, call, end)

    return go


def compile_seconds(problem: Problem) -> tuple[float, float]:
    """Return what the first run of all compiles, and what the other methods then add, in a process without a cache."""
    with tempfile.TemporaryDirectory() as cache:
        environment = os.environ | {"BINARYAST_CACHE_DIR": cache}
        done = subprocess.run(
            [sys.executable, "-c", COMPILING.format(name=problem.name)],
            env=environment, capture_output=True, text=True, check=True,
        )  # fmt: skip
    first, others = map(float, done.stdout.split()[-2:])
    return first, others


__all__ = ["BY_NAME", "candidates", "compile_seconds", "run_of"]
