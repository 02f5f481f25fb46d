"""Run the benchmark: ``python -m validation.benchmark [PROBLEM ...] [costs] [sizes] [--quick] [-o FOLDER]``.

What steps cost, how the cost grows with the size of a problem, and how much time each method needs for an accuracy.
"""

import argparse
import json
import os
import sys
import tempfile
import time
from pathlib import Path

import heyoka as hy

from validation import costs
from validation.benchmark import figures, ours, sizes, tables, taylor_runs
from validation.benchmark.measure import measure
from validation.benchmark.others import rebound_candidates, scipy_candidates
from validation.benchmark.problems import BY_NAME, POINTS, PROBLEMS, Problem

QUICK = ("costs", "degree-2", "pairs-64")
OTHERS = ("costs", "sizes")  # that are no problems


def run(problem: Problem, cache: str, *, quick: bool) -> tables.Result:
    """Measure one problem."""
    settings = taylor_runs.compiled(problem, cache, quick=quick)
    compiling = [compiled_line(setting) for setting in settings]
    if not quick:
        first, others = ours.compile_seconds(problem)
        compiling.append(f"ours: {first:.1f} s for the first method, {others:.1f} s for all others together, once")
    end, distance = taylor_runs.reference(problem)
    candidates = ours.candidates(problem, quick=quick) + taylor_runs.candidates(problem, settings)
    if problem.name == POINTS:
        candidates += rebound_candidates(problem)
    elif problem.name in ("degree-2", "dumbbells") and not quick:
        candidates += scipy_candidates(problem)
    one_core()
    points = measure(candidates, end, 2 if quick else 6)
    every_core()
    return tables.Result(problem, points, distance, compiling)


def compiled_line(setting: taylor_runs.Compiled) -> str:
    """Return what compiling a setting took."""
    taken = f"not within {taylor_runs.LIMIT:.0f} s" if setting.seconds is None else f"{setting.seconds:.1f} s"
    return f"heyoka, {setting.mode.method}, {setting.tolerance:g}: {taken} to compile"


def one_core() -> None:
    """Stay on one core, where the system can be asked to."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})


def every_core() -> None:
    """Use all cores again, to compile."""
    if hasattr(os, "sched_setaffinity"):
        os.sched_setaffinity(0, range(os.cpu_count() or 1))


def main() -> None:
    """Measure, print and write."""
    parser = argparse.ArgumentParser(prog="python -m validation.benchmark", description=__doc__.splitlines()[0])
    parser.add_argument(
        "problems", nargs="*", metavar="PROBLEM", help=f"of {', '.join([*BY_NAME, *OTHERS])}; all by default"
    )
    parser.add_argument("--readme", action="store_true", help="print one small table in the place of all")
    parser.add_argument("--quick", action="store_true", help="two problems with few settings, in two minutes")
    parser.add_argument(
        "-o", dest="folder", type=Path, default=Path("work-precision"), help="where figures and tables go"
    )
    options = parser.parse_args()
    unknown = set(options.problems) - set(BY_NAME) - set(OTHERS)
    if unknown:
        parser.error(f"no such problem: {', '.join(sorted(unknown))}; there are {', '.join([*BY_NAME, *OTHERS])}")
    names = options.problems or (QUICK if options.quick else ["costs", *BY_NAME, "sizes"])
    options.folder.mkdir(parents=True, exist_ok=True)
    results = []
    began = time.monotonic()
    if "costs" in names:
        costs.main()
    with tempfile.TemporaryDirectory() as cache:
        hy.llvm_state.set_diskcache_path(cache)  # none of what was compiled before, and all of what is compiled now
        for problem in PROBLEMS:
            if problem.name in names:
                results.append(run(problem, cache, quick=options.quick))
                figures.diagram(results[-1]).savefig(options.folder / f"{problem.name}.png", dpi=130)
                print(f"{problem.name}: {time.monotonic() - began:.0f} s", file=sys.stderr)
    text = tables.report(results) if results else ""
    if "sizes" in names:
        found = sizes.measured()
        figures_of_sizes = sizes.figure(found)
        figures_of_sizes.savefig(options.folder / "sizes.png", dpi=130)
        text += sizes.report(found)
    (options.folder / "work-precision.md").write_text(text, encoding="utf-8")
    (options.folder / "points.json").write_text(
        json.dumps({r.problem.name: r.points for r in results}), encoding="utf-8"
    )
    print("\n".join(tables.readme(results)) if options.readme else text)
    print(f"{time.monotonic() - began:.0f} s; figures are in {options.folder}", file=sys.stderr)


if __name__ == "__main__":
    main()
