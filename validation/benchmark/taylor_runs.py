"""heyoka as a candidate: compiled in a process of its own, within five minutes, and kept on disk for the timing."""

import json
import subprocess
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import heyoka as hy
import numpy as np

from binaryast.equations.legendre import Snapshot
from validation.benchmark.heyoka_points import HeyokaPoints
from validation.benchmark.heyoka_problem import HeyokaProblem
from validation.benchmark.measure import Candidate, Run
from validation.benchmark.problems import BY_NAME, Problem
from validation.oracles import taylor

LIMIT = 300.0  # seconds to compile


class Mode(NamedTuple):
    """How heyoka is used: which variables, which form, and whether it unrolls its series."""

    method: str
    compact: bool
    axes: str = "inertial"
    expanded: bool = True


DEFAULT, COMPACT = Mode("default mode", compact=False), Mode("compact mode", compact=True)
TURNING = Mode("default mode, primary's axes", compact=False, axes="primary")
UNEXPANDED = Mode("compact mode, pairs one by one", compact=True, expanded=False)
MODES = {mode.method: mode for mode in (DEFAULT, COMPACT, TURNING, UNEXPANDED)}


class Compiled(NamedTuple):
    """A setting that compiles in time, and how long it takes [CPU s]; None for one that does not."""

    mode: Mode
    tolerance: float
    seconds: float | None


def equations(problem: Problem, mode: Mode, kind: type = float) -> Any:
    """Return the equations of a problem."""
    system, state = problem.make()
    if not problem.has_attitudes:
        return HeyokaPoints(system, state, kind=kind)
    return HeyokaProblem(system, state, axes=mode.axes, kind=kind, expanded=mode.expanded)


def settings(problem: Problem, *, quick: bool) -> list[tuple[Mode, float]]:
    """Return the modes and tolerances to try; quick ones are few, and compile quickly."""
    result = [(mode, t) for mode in (DEFAULT, COMPACT) for t in problem.tolerances[mode.method.split()[0]]]
    if quick:
        slow = problem.name in ("degree-8", "pairs-64", "pairs-256")
        return [(mode, t) for mode, t in result if mode.compact == slow][::2]
    if problem.name == "degree-2":
        result += [(TURNING, t) for t in problem.tolerances["default"][::2]]
    if problem.name.startswith("pairs"):
        result += [(UNEXPANDED, t) for t in problem.tolerances["compact"][::2]]
    return result


def compile_one(name: str, method: str, tolerance: float, cache: str) -> float:
    """Compile a setting into a cache on disk; return the CPU seconds."""
    hy.llvm_state.set_diskcache_path(cache)
    problem = equations(BY_NAME[name], MODES[method])
    began = time.process_time()
    integrator_of(problem, MODES[method], tolerance)
    return time.process_time() - began


def integrator_of(problem: Any, mode: Mode, tolerance: float) -> Any:
    """Return heyoka's integrator, its arithmetic reassociated, which makes it a tenth faster."""
    return hy.taylor_adaptive(problem.equations, problem.y, tol=tolerance, compact_mode=mode.compact, fast_math=True)


def compiled(problem: Problem, cache: str, *, quick: bool) -> list[Compiled]:
    """Compile all settings, two at a time, each within the limit."""
    waiting, running, result = settings(problem, quick=quick), [], []
    failed: set[Mode] = set()
    while waiting or running:
        while waiting and len(running) < 2:
            mode, tolerance = waiting.pop(0)
            if mode in failed:  # a tighter tolerance takes longer
                result.append(Compiled(mode, tolerance, None))
                continue
            command = [sys.executable, "-m", __name__, problem.name, mode.method, repr(tolerance), cache]
            running.append(
                (mode, tolerance, time.monotonic(), subprocess.Popen(command, stdout=subprocess.PIPE, text=True))
            )
        time.sleep(0.05)
        for entry in list(running):
            mode, tolerance, began, process = entry
            if process.poll() is None and time.monotonic() - began < LIMIT:
                continue
            running.remove(entry)
            if process.poll() is None:
                process.kill()
                process.wait()
                failed.add(mode)
                result.append(Compiled(mode, tolerance, None))
                continue
            if process.returncode:
                raise RuntimeError(f"heyoka, {problem.name}, {mode.method}: exit status {process.returncode}")
            result.append(Compiled(mode, tolerance, json.loads(process.stdout.read())))
    return result


def candidates(problem: Problem, settings: list[Compiled]) -> list[Candidate]:
    """Return what was compiled in time."""
    by_mode = {mode: equations(problem, mode) for mode in {setting.mode for setting in settings}}
    result = []
    for mode, tolerance, seconds in settings:
        if seconds is not None:
            integrator = integrator_of(by_mode[mode], mode, tolerance)
            go = run_of(by_mode[mode], integrator, problem.duration)
            result.append(Candidate("heyoka", mode.method, f"{tolerance:g}", go))
    return result


def run_of(problem: Any, integrator: Any, duration: float) -> Callable[[], Run]:
    """Return a function that runs an integrator once from the start."""
    end = problem.kind(duration / problem.units.time)

    def go() -> Run:
        integrator.time = problem.kind(0.0)
        integrator.state[:] = problem.y
        began = time.thread_time()
        outcome = integrator.propagate_until(end)[0]
        seconds = time.thread_time() - began
        if outcome != hy.taylor_outcome.time_limit:
            raise RuntimeError(f"heyoka: expected to reach t = {end}, got {outcome}")
        return Run(seconds, seconds, problem.snapshot(integrator.state))

    return go


def reference(problem: Problem) -> tuple[Snapshot, float]:
    """Return where the bodies end by a Taylor series of 80 bits at 1e-19, and how far that is from one at 1e-17."""
    from validation.benchmark.measure import errors

    ends = []
    for tolerance in (1e-17, 1e-19):
        at = equations(problem, COMPACT, np.longdouble)
        integrator = hy.taylor_adaptive(
            at.equations, at.y, tol=np.longdouble(tolerance), compact_mode=True, fp_type=np.longdouble
        )
        ends.append(run_of(at, integrator, problem.duration)().end)
    one, two = (taylor.floats(end) for end in ends)
    return two, errors(one, two)[1]


if __name__ == "__main__":
    print(json.dumps(compile_one(sys.argv[1], sys.argv[2], float(sys.argv[3]), sys.argv[4])))
