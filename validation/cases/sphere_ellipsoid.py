"""A sphere and a homogeneous ellipsoid: the potential by Carlson's integrals, and what a cut series leaves out."""

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.gravity import Gravity
from validation import truncation
from validation.case import Case, Check, Effort, Findings
from validation.oracles import potentials
from validation.oracles.potentials import Attraction
from validation.truncation import MODELS, Pair

AXES = np.array([1.0, 0.7, 0.5])  # m
PLACE = np.array([2.1, 0.7, -0.9])  # m, in the ellipsoid's frame
VALUE = -0.42441825577631737  # there, by an independent implementation, for G M m = 1
ATTITUDE = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()
PAIR = Pair(
    "sphere-ellipsoid",
    np.zeros(3),
    AXES,
    ATTITUDE,
    ATTITUDE @ [0.6, 0.3, 0.9],
    np.array([1.5, 3.0, 6.0, 12.0, 24.0]),
    lambda x: potentials.sphere_and_ellipsoid(AXES, x, ATTITUDE),
)


def other_way(gravity: Gravity, x: np.ndarray) -> Attraction:
    """Return the same with the ellipsoid as the primary, from the force and the torque that the package names."""
    found = truncation.system(AXES, np.zeros(3), gravity).mutual_gravity(-ATTITUDE.T @ x * u.m)
    force, torque = ATTITUDE @ found.force_on_secondary.value, ATTITUDE @ found.torque_on_primary.value
    return Attraction(found.energy.value, force, -torque)


def run(effort: Effort) -> Findings:
    """Compare the models with the closed form."""
    place = ATTITUDE @ PLACE
    closed = PAIR.exact(place)
    checks = [
        Check(
            "the oracle itself: U at (2.1, 0.7, -0.9), a = (1, 0.7, 0.5), by Carlson's integrals, as it is known",
            closed.energy / VALUE - 1,
            1.5e-15,
            "rounding of the oracle",
            shown=f"{closed.energy:.17g}",
            roundoff=True,
        )
    ]
    checks += [
        Check(
            f"{model.name}: the ellipsoid as the primary: the same energy, force and torque",
            truncation.apart(other_way(model.gravity, place), PAIR.computed(model.gravity, place)).max(),
            4e-15,
            "rounding",
            roundoff=True,
        )
        for model in MODELS
    ]
    why = "rounding over what is lacking, which is 5e-8 of U, 3e-7 of dU/dX and 6e-4 of M at r = 24 m"
    checks += truncation.limit_checks(PAIR, (3e-8, 4e-9, 5e-9), why)
    checks += truncation.slope_checks(PAIR, 4e-2)
    caption = (
        "Sphere and ellipsoid of semi-axes 1, 0.7, 0.5 m: relative errors of the energy, its gradient and the moment "
        "against distance. What second degree leaves out falls as degree 4 does, and with the closed form of degree 4 "
        "added, as degree 6."
    )
    return Findings(checks, [truncation.picture(PAIR, caption)])


CASE = Case(
    "sphere-ellipsoid",
    "Do energy, force and moment of a sphere and an ellipsoid agree with the closed form, but for degrees left out?",
    "closed form: Carlson's integrals R_F and R_D",
    run,
    needs=("scipy",),
)
