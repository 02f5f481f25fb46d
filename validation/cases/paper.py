"""Section 5 of Lee, Leok and McClamroch (2007): the two dumbbells, with the figures that the paper prints.

Where the paper prints too little, an independent implementation of it fills in: largest energy deviations for other
steps, and states to 12 digits by DOP853 at a tolerance of 3e-14.
"""

from decimal import Decimal
from typing import NamedTuple

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture

UNIT_OF_ENERGY = 2 / 9 / ba.constants.G  # J: the paper's unit of mass, the reduced mass, at 1 m2/s2
INITIAL_ENERGY = 0.44066240192821
PAPER_STEP, PAPER_DEVIATION = 2e-4, 2.6966e-7
DEVIATIONS = {  # by the step, with all digits that are known
    1e-2: "6.146e-4",
    5e-3: "1.655e-4",
    2e-3: "2.689e-5",
    1e-3: "6.7365e-6",
    5e-4: "1.685e-6",
    2e-4: "2.69634e-7",
}
CLOSEST, CLOSEST_TIME = 0.33030, 9.0022


class Known(NamedTuple):
    """A state to 12 digits: |X| and the primary's place."""

    separation: float
    x2: tuple[float, float, float]


STATES = {
    5.0: Known(0.997571611796, (-0.294973547348, 0.134272422190, -0.074388490523)),
    9.0: Known(0.330305022287, (-0.081878775542, 0.073594701585, -0.001436890053)),
}


def to_fifteen(step: float) -> ba.Trajectory:
    """Return the run of section 5 at a step, to t = 15: its largest deviations are over every step."""
    system, state = ba.catalogue.load("dumbbells")
    return ba.propagate(system, state, duration=15 * u.s, integrator=ba.LGVI(step * u.s))


def deviation(run: ba.Trajectory) -> float:
    """Return the largest |E - E0| in the paper's units."""
    return float(run.max_energy_error.value / UNIT_OF_ENERGY)


def half_digit(text: str) -> float:
    """Return half of the last digit of a number that is written down."""
    return 0.5 * 10.0 ** int(Decimal(text).as_tuple().exponent)


def state_check(time: float, known: Known) -> Check:
    """Return the check of a state in the limit of the step to zero."""
    system, state = ba.catalogue.load("dumbbells")
    counts = [int(time * 1000) * 2**k for k in range(5)]
    end = methods.limit(methods.RELATIVE, system, state, time, counts)
    separation = np.linalg.norm(end.x[1] - end.x[0])
    error = max(abs(separation - known.separation), np.abs(end.x[0] - known.x2).max())
    what = f"|X| and x2 at t = {time:g}, limit of the step to zero"
    return Check(what, float(error), 5e-13, "half of the last known digit", headline=time > 5, printed=True)


def run(effort: Effort) -> Findings:
    """Compare energies, the closest approach and states."""
    runs = {step: to_fifteen(step) for step in DEVIATIONS}
    of_paper = runs[PAPER_STEP]
    energy = of_paper.energy[0].value / UNIT_OF_ENERGY
    checks = [
        Check(
            "E at the start", abs(energy - INITIAL_ENERGY), 6e-15, "half of its last digit, and rounding", printed=True
        ),
        Check(
            "largest |E - E0| at h = 0.0002, relative to the paper's 2.6966e-7",
            abs(deviation(of_paper) / PAPER_DEVIATION - 1),
            3e-4,
            "the moments of inertia that the paper prints are rounded to four decimals",
            shown=f"{deviation(of_paper):.5e}",
            headline=True,
        ),
        Check(
            "the same for steps of 0.01 to 0.0002, in half last digits of an independent implementation's",
            max(
                abs(deviation(one) - float(DEVIATIONS[step])) / half_digit(DEVIATIONS[step])
                for step, one in runs.items()
            ),
            1.0,
            "its last known digits",
            printed=True,
        ),
        Check(
            "closest approach, about 0.3303",
            abs(of_paper.closest_approach.value - CLOSEST),
            5e-6,
            "half of the last known digit",
            shown=f"{of_paper.closest_approach.value:.6f}",
            printed=True,
        ),
        Check(
            "its time, about 9.0022",
            abs(of_paper.closest_approach_time.value - CLOSEST_TIME),
            1e-4,
            "half a step",
            shown=f"{of_paper.closest_approach_time.value:.4f}",
            printed=True,
        ),
        *(state_check(time, known) for time, known in STATES.items()),
    ]
    steps = sorted(runs)
    figure, (ax,) = drawing.axes(xlabel="step h, in the paper's unit of time", ylabel="largest |E - E0|, paper's unit")
    drawing.curve(ax, steps, [deviation(runs[step]) for step in steps], "LGVI to t = 15", 0)
    ax.plot(PAPER_STEP, PAPER_DEVIATION, "k*", ms=11, zorder=0, label="the paper's 2.6966e-7")
    drawing.slope_line(ax, steps, (1e-3, 2 * float(DEVIATIONS[1e-3])), 2)
    drawing.legend(ax)
    caption = (
        "The largest deviation of the energy of the paper's dumbbells falls with the square of the step, through the "
        "paper's own."
    )
    return Findings(checks, [Picture("paper", figure, caption)])


CASE = Case(
    "paper",
    "Do energy, closest approach and states of the paper's example (section 5) come out as they are known?",
    "Lee, Leok and McClamroch (2007), section 5; states by DOP853 of an independent implementation",
    run,
)
