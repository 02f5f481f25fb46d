"""The cases, a file each, in the order of the report."""

from validation.case import Case
from validation.cases import (
    discrete_law,
    f2bptoolkit,
    gubas,
    heyoka_motion,
    kepler,
    paper,
    phase_drift,
    pluto_charon,
    triple,
)

ALL: tuple[Case, ...] = (
    paper.CASE,
    *heyoka_motion.CASES,
    kepler.CASE,
    phase_drift.CASE,
    pluto_charon.CASE,
    triple.CASE,
    gubas.CASE,
    f2bptoolkit.CASE,
    discrete_law.CASE,
)
