"""The case in F2BPtoolkit's documentation: two aligned ellipsoids at second degree for 10 days, G = 6.674e-11."""

from math import pi

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.fitting import to_zero

FINAL_SEPARATION = 1178.444910  # m, as an independent code's documentation prints it
OTHER_G = 6.674e-11  # reproduced through gm
STEPS = (80.0, 40.0, 20.0, 10.0, 5.0)


def system_and_start() -> tuple[ba.System, ba.State]:
    """Return the system and its start."""

    def body(name: str, a: float, b: float, c: float) -> ba.RigidBody:
        gm = OTHER_G * 2400 * 4 / 3 * pi * a * b * c
        return ba.RigidBody(name, ba.Ellipsoid(a * u.m, b * u.m, c * u.m), gm=gm * u.m**3 / u.s**2)

    system = ba.System([body("primary", 400, 395, 340), body("secondary", 85, 73, 63)], gravity=ba.SecondDegree())
    start = ba.RelativeState(
        X=[1195, 0, 0] * u.m,
        V=[0, 0.17430165586245883, 0] * u.m / u.s,
        R=np.eye(3),
        Omega=[0, 0, 1.4585912624473542e-4] * u.rad / u.s,
        Omega2=[0, 0, 2 * pi / (2.26 * 3600)] * u.rad / u.s,
    )
    return system, start.to_state(system)


def difference(step: float) -> float:
    """Return the final separation minus that of the other code [m]."""
    run = ba.propagate(*system_and_start(), duration=10 * u.day, integrator=ba.LGVI(step * u.s))
    return float(run.separation[-1].value - FINAL_SEPARATION)


def run(effort: Effort) -> Findings:
    """Compare the final separation over steps, and in their limit."""
    errors = np.array([difference(step) for step in STEPS])
    slope = methods.slope(STEPS, errors)
    limit = float(to_zero(errors))
    checks = [
        Check(
            "final separation in the limit of the step to zero [m]",
            limit,
            5e-7,
            "half of its last printed digit",
            shown=f"{FINAL_SEPARATION + limit:.7f} m, printed {FINAL_SEPARATION:.6f} m",
            headline=True,
            printed=True,
        ),
        Check("order of its error", abs(slope - 2), 0.02, "the next power of the step", shown=f"{slope:.4f}"),
    ]
    figure, (ax,) = drawing.axes(xlabel="step [s]", ylabel="final separation, ours - F2BPtoolkit's [m]")
    drawing.curve(ax, STEPS, errors, "LGVI", 0)
    drawing.slope_line(ax, STEPS, (STEPS[0], 2 * errors[0]), 2)
    drawing.ticks(ax, STEPS)
    drawing.legend(ax)
    caption = "The final separation after ten days converges to the one that the other code prints, with slope 2."
    return Findings(checks, [Picture("f2bptoolkit", figure, caption)])


CASE = Case(
    "f2bptoolkit",
    "Does the case in F2BPtoolkit's documentation end at the separation that it prints?",
    "F2BPtoolkit, as its documentation prints it: 1178.444910 m after 10 days",
    run,
)
