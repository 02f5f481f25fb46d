"""The cases, a file each, in the order of the report."""

from validation.case import Case
from validation.cases import (
    discrete_law,
    ellipsoid_pair,
    f2bptoolkit,
    free_tops,
    gravity_gradient,
    gubas,
    heyoka_motion,
    kepler,
    libration,
    oblateness,
    paper,
    phase_drift,
    pluto_charon,
    sphere_ellipsoid,
    synchronous,
    triple,
    two_rods,
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
    free_tops.CASE,
    sphere_ellipsoid.CASE,
    two_rods.CASE,
    ellipsoid_pair.CASE,
    synchronous.CASE,
    libration.CASE,
    gravity_gradient.CASE,
    oblateness.CASE,
)
