"""Two homogeneous ellipsoids: the exact potential by quadrature of Carlson's, and what a cut series leaves out."""

import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from validation import truncation
from validation.case import Case, Check, Effort, Findings
from validation.oracles import potentials
from validation.truncation import SECOND, Pair

PRIMARY, SECONDARY = np.array([400.0, 395.0, 340.0]), np.array([85.0, 73.0, 63.0])  # m
APART = np.array([1195.0, 0.0, 0.0])  # m
VALUE = -8.39992172639902e-4  # 1/m: U/(G m1 m2), aligned, by an independent implementation
BY_DEGREE = {2: 4.2e-5, 4: 7.1e-7, 6: 1.5e-8, 8: 3.7e-10, 10: 1.0e-11, 12: 2.9e-13}  # relative errors there, known
ATTITUDE = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()
ALIGNED, TURNED = (
    Pair(
        "ellipsoid-pair",
        PRIMARY,
        SECONDARY,
        attitude,
        towards,
        np.array([500.0, 1000.0, 2000.0, 4000.0, 8000.0]),
        lambda x, r=attitude: potentials.two_ellipsoids(PRIMARY, SECONDARY, x, r),
    )
    for attitude, towards in ((np.eye(3), APART), (ATTITUDE, np.array([0.6, 0.3, 0.9])))
)


def value_checks() -> list[Check]:
    """Return the checks of the known value."""
    exact = ALIGNED.exact(APART).energy
    second = ALIGNED.computed(SECOND.gravity, APART).energy
    fourth = ALIGNED.fourth(APART).energy
    return [
        Check(
            "the oracle itself: U/(G m1 m2) [1/m], aligned at 1195 m, by quadrature, as it is known",
            exact / VALUE - 1,
            1e-15,
            "rounding of a sum over 4096 nodes, and of the 15 digits known",
            shown=f"{exact:.15g}",
            roundoff=True,
        ),
        Check(
            "second degree, aligned at 1195 m: relative error in U, less degree 4 in closed form",
            (second + fourth) / exact - 1,
            2.5e-6,
            "degree 6, which is 7e-7 of U",
            shown=f"error {second / exact - 1:.3e}, of it degree 4 {-fourth / exact:.3e}",
            headline=True,
        ),
    ]


def degrees_check() -> Check:
    """Return the check of the relative errors of U at each degree, beside the known ones."""
    exact = ALIGNED.exact(APART).energy
    found = [ALIGNED.computed(ba.Multipole(degree), APART).energy / exact - 1 for degree in BY_DEGREE]
    return Check(
        "relative error of U, aligned at 1195 m, at N = 2, 4, .. 12 over the known one, minus 1: the worst",
        max(abs(abs(error) / known - 1) for error, known in zip(found, BY_DEGREE.values(), strict=True)),
        0.06,
        "two known digits; at N = 12, 3e-13, rounding too",
        shown=", ".join(f"{abs(error):.1e}" for error in found),
        headline=True,
        printed=True,
    )


def run(effort: Effort) -> Findings:
    """Compare the models with the quadrature, aligned, and turned at one place after the other."""
    checks = [*value_checks(), degrees_check()]
    why = "rounding over what is lacking, which is 1e-8 of U, 9e-8 of dU/dX and 6e-4 of M at r = 8000 m"
    checks += truncation.limit_checks(TURNED, (1e-7, 1.2e-8, 1.2e-9), why)
    checks += truncation.slope_checks(TURNED, 1e-2)
    caption = (
        "Ellipsoids of 400, 395, 340 m and of 85, 73, 63 m, turned against each other: relative errors of the energy, "
        "its gradient and the moment against distance. What second degree leaves out falls as degree 4 does, and with "
        "the closed form of degree 4 added, as degree 6."
    )
    return Findings(checks, [truncation.picture(TURNED, caption)])


CASE = Case(
    "ellipsoid-pair",
    "Do energy, force and moment of two ellipsoids agree with the exact ones, but for degrees left out?",
    "Gauss quadrature over one ellipsoid of the other's closed potential, Carlson's integrals",
    run,
    needs=("scipy",),
)
