"""The cases, a file each, in the order of the report."""

from validation.case import Case
from validation.cases import discrete_law, f2bptoolkit, gubas, heyoka_motion, paper

ALL: tuple[Case, ...] = (
    paper.CASE,
    *heyoka_motion.CASES,
    gubas.CASE,
    f2bptoolkit.CASE,
    discrete_law.CASE,
)
