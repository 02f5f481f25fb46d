"""Runs that are killed and go on, however long they are in flat memory, and scenario files at random."""

import subprocess
import sys
import tempfile
from pathlib import Path
from random import Random

from validation import killing, random_scenarios
from validation.case import Case, Check, Effort, Findings

DAYS = {Effort.QUICK: 600, Effort.WHOLE: 4000, Effort.LONG: 8000}  # of steps of 40 s
KILLS = {Effort.QUICK: 1, Effort.WHOLE: 3, Effort.LONG: 20}
FILES = {Effort.QUICK: 20, Effort.WHOLE: 200, Effort.LONG: 10_000}
STEPS = {Effort.QUICK: 10**6, Effort.WHOLE: 10**7, Effort.LONG: 10**8}
ROWS = 1000
MOST_MEMORY = 400.0  # MB
RUNS = (  # entry, days over those above, and how
    (
        "didymos",
        1.0,
        "duration={days} * u.day, save_every={days} / 900 * u.day, integrator=ba.LGVI(40 * u.s), "
        "impulses=[ba.Impulse({days} / 3.1 * u.day, [0, 0, -2] * u.mm / u.s, 1)]",
    ),
    (  # three bodies, the Sun and its light
        "cubesat",
        0.02,
        "duration={days} * u.day, save_every={days} / 900 * u.day, integrator=ba.Splitting(5 * u.min), "
        'events=[ba.events.Crossing("radial_velocity", bodies=("Didymos", "Dimorphos"))]',
    ),
)
MEMORY = """
import sys
import astropy.units as u
import binaryast as ba
system, state = ba.catalogue.load("didymos")
steps, rows = int(sys.argv[2]), int(sys.argv[3])
how = {"duration": 40.0 * steps * u.s, "save_every": 40.0 * steps // rows * u.s, "integrator": ba.LGVI(40 * u.s)}
run = ba.propagate(system, state, file=sys.argv[1], **how)
assert (run.steps, len(run)) == (steps, rows + 1)
try:  # that of this process alone: what resource says begins with its parent's
    print(next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmHWM")) / 1024)
except OSError:
    import resource
    print(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


def differing(folder: Path, effort: Effort) -> int:
    """Return of how many killed runs the final file differs in any bit from that of one without a stop."""
    random, bad = Random(1), 0
    for k, (name, part, text) in enumerate(RUNS):
        how = text.format(days=part * DAYS[effort])
        expected, path = folder / f"whole{k}.h5", folder / "killed.h5"
        lasts = killing.whole(expected, name, how)
        kills = (KILLS[effort] + 1 - k) // len(RUNS)
        while kills:
            if killing.killed(path, name, how, random.uniform(0.02, 0.98) * lasts):
                killing.resumed(path)
                bad += bool(killing.differences(expected, path))
                path.unlink()
                kills -= 1
    return bad


def peak(folder: Path, steps: int) -> float:
    """Return how much memory a process with so many steps took at most [MB]."""
    command = [sys.executable, "-W", "ignore", "-c", MEMORY, str(folder / "long.h5"), str(steps), str(ROWS)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stdout)


def run(effort: Effort) -> Findings:
    """Kill runs at random moments and go on, follow a long one, try files."""
    with tempfile.TemporaryDirectory() as name:
        bad = differing(Path(name), effort)
        memory = peak(Path(name), STEPS[effort])
    good = random_scenarios.tried(FILES[effort])
    return Findings(
        [
            Check(
                "kill -9 at random moments, gone on from there: files that differ in any bit",
                bad,
                0.5,
                "none: a checkpoint is all that the rest depends on",
                headline=True,
                printed=True,
            ),
            Check(
                f"peak memory of {STEPS[effort]:.0e} steps with {ROWS} rows [MB]",
                memory,
                MOST_MEMORY,
                "the interpreter and its libraries; rows leave for the file",
                f"{memory:.0f} MB",
            ),
            Check(
                "scenario files at random that end in neither a run nor one line",
                FILES[effort] - good,
                0.5,
                "none: all that is said is looked at before it is used",
                f"{FILES[effort] - good} of {FILES[effort]}",
                printed=True,
            ),
        ],
        notes=[f"{KILLS[effort]} kills, {good} scenario files, {STEPS[effort]:.0e} steps in {memory:.0f} MB."],
    )


CASE = Case(
    "survival",
    "Do runs go on bit for bit after kill -9, in flat memory, and does every scenario file end in a run or one line?",
    "runs without a stop, file by file, bit by bit",
    run,
    needs=("hypothesis",),
)
