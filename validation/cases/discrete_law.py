"""The discrete law of a free spin, sin(theta) = h Omega, and how far its attitude runs ahead in a year.

For a spin about a principal axis (128) says that a step turns a body by theta with sin(theta) = h Omega exactly: the
attitude is ahead by t (asin(h Omega)/h - Omega), which is about Omega t (h Omega)^2/6.
"""

from math import sin

import astropy.units as u
import numpy as np

import binaryast as ba
from binaryast.kernels import implicit
from validation import drawing
from validation.case import Case, Check, Effort, Findings, Picture

YEAR = 365.25 * 86400
RATE = 2 * np.pi / (2.26 * 3600)  # rad/s: the spin of Didymos
STEPS = (60.0, 30.0, 15.0)
MOMENTS = np.array([1.0, 1.4, 1.9])


def year_ahead(step: float) -> tuple[float, float]:
    """Return by how much [rad] a 2.26 h spin is ahead after a year, modulo a turn: in a run, and by the law."""
    bodies = [ba.RigidBody(name, ba.Sphere(1 * u.m), mass=1e-3 * u.kg) for name in ("far", "turning")]
    zero = np.zeros((2, 3))
    start = ba.State(
        [[0, 0, 0], [1e12, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, [[0, 0, 0], [0, 0, RATE]] * u.rad / u.s
    )
    system = ba.System(bodies, gravity=ba.PointMass())
    run = ba.propagate(system, start, duration=YEAR * u.s, integrator=ba.LGVI(step * u.s))
    h = run.step.value
    turned = np.arctan2(run.attitude[-1, 1, 1, 0], run.attitude[-1, 1, 0, 0])
    ahead = YEAR * (np.arcsin(h * RATE) / h - RATE)
    return float((turned - RATE * YEAR + np.pi - ahead) % (2 * np.pi) - np.pi + ahead), float(ahead)


def sine_error(size: float, *, cayley: bool) -> float:
    """Return the largest error of sin(theta) from h Omega over the three principal axes, by either solver."""
    error = 0.0
    for axis in range(3):
        g = np.zeros(3)
        g[axis] = MOMENTS[axis] * size  # h Pi
        if cayley:
            ratios = (np.roll(MOMENTS, -1) - np.roll(MOMENTS, -2)) / MOMENTS
            c, _ = implicit.solve_cayley(tuple(1 / MOMENTS), tuple(ratios), tuple(g))
            theta = 2 * np.arctan(np.linalg.norm(c))
        else:
            f, _ = implicit.solve(np.diag(MOMENTS), g)
            theta = float(np.linalg.norm(f))
        error = max(error, abs(sin(theta) - size))
    return error


def run(effort: Effort) -> Findings:
    """Measure both."""
    sizes = np.concatenate([np.geomspace(1e-8, 0.5, 40), 1 - np.geomspace(0.5, 1e-4, 20)])
    checks = [
        Check(
            f"turn of one step, {name}: sin(theta) minus h Omega, for h Omega up to 0.9999",
            max(sine_error(size, cayley=cayley) for size in sizes),
            1e-15,
            "rounding",
            headline=cayley,
            roundoff=True,
        )
        for name, cayley in (("production", True), ("as printed", False))
    ]
    ahead = {step: year_ahead(step) for step in STEPS}
    checks += [
        Check(
            f"a year of a 2.26 h spin in steps of {step:g} s: run minus law [rad], modulo a turn",
            found - law,
            3e-11,
            "rounding of an angle of 2.4e4 rad, 4e-12",
            shown=f"ahead by {found:.7f} rad",
            headline=step == 30,
            roundoff=True,
        )
        for step, (found, law) in ahead.items()
    ]
    figure, (ax,) = drawing.axes(xlabel="h Omega [rad]", ylabel="ahead after a year [rad]")
    turns = np.array(STEPS) * RATE
    drawing.curve(ax, turns, [found for found, _ in ahead.values()], "run", 0)
    drawing.slope_line(ax, turns, (turns[0], RATE * YEAR * turns[0] ** 2 / 6), 2, "Omega t (h Omega)²/6")
    drawing.legend(ax)
    caption = (
        "How far the attitude of a 2.26 h spin has run ahead after a year, against the turn in one step. The points "
        "lie on the law; no energy error shows this."
    )
    return Findings(checks, [Picture("discrete-law", figure, caption)])


CASE = Case(
    "discrete-law",
    "Does a step turn a free spin by the angle of equation (128), and does a year add up to the law of its lead?",
    "closed form: sin(theta) = h Omega, lead t (asin(h Omega)/h - Omega)",
    run,
)
