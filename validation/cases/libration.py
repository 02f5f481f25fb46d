"""A sphere and an ellipsoid on a circular orbit: their two small oscillations, of the distance and of the face."""

from functools import cache

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from validation import drawing, fitting, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles.librations import CoupledLibration

AXES = np.array([85.0, 73.0, 63.0])  # m
SPHERE, ELLIPSOID = 5.4e11, 3.93e9  # kg
SHARE = np.sqrt(SPHERE / (SPHERE + ELLIPSOID))
SEPARATION = 1195.0  # m
KNOWN = (1.00179277, 0.66660891)  # of n: the two frequencies
UNCOUPLED = 0.67311417  # of n: sqrt(3 (B - A)/C)
NAMES = ("distance", "face")
AMPLITUDES = (1e-4, 5e-5)  # of the face [rad], and of the radial velocity over n r; extrapolated to zero
TURNS = 20
PER_TURN = (128, 256, 512, 1024)  # steps, extrapolated to a step of zero
SEPARATIONS = (600.0, 1195.0, 2400.0, 4800.0, 9600.0)  # m


def closed_form(separation: float) -> CoupledLibration:
    """Return the linear theory."""
    moments = ELLIPSOID * (np.sum(AXES**2) - AXES**2) / 5
    return CoupledLibration(SPHERE, ELLIPSOID, moments, separation, ba.constants.G)


def system() -> ba.System:
    """Return the pair."""
    sphere = ba.RigidBody("sphere", ba.Sphere(400 * u.m), mass=SPHERE * u.kg)
    ellipsoid = ba.RigidBody("ellipsoid", ba.Ellipsoid(*(AXES * u.m)), mass=ELLIPSOID * u.kg)
    return ba.System([sphere, ellipsoid], gravity=ba.SecondDegree())


def face(theory: CoupledLibration, amplitude: float, per_turn: int, frame: str) -> tuple[np.ndarray, np.ndarray]:
    """Return n t, and the angle [rad] from the line of centres to the long axis.

    Begun with the long axis turned and with a radial velocity, neither of which changes the angular momentum.
    """
    n, r = theory.rate, theory.separation
    start = ba.RelativeState(
        X=[r, 0, 0] * u.m,
        V=[amplitude * n * r, n * r, 0] * u.m / u.s,
        R=Rotation.from_rotvec([0, 0, amplitude]).as_matrix(),
        Omega=[0, 0, n] * u.rad / u.s,
        Omega2=[0, 0, 0] * u.rad / u.s,
    )
    period = 2 * np.pi / n * u.s
    step = period / per_turn
    run = ba.propagate(
        system(),
        start.to_state(system()),
        duration=TURNS * period,
        integrator=ba.LGVI(step * (1 + 1e-12), frame=frame),
        save_every=period / 32,
    )
    x, long = run.si.position[:, 1] - run.si.position[:, 0], run.si.attitude[:, 1, :, 0]
    return n * run.si.time, np.arctan2(np.cross(x, long)[:, 2], np.sum(x * long, axis=1))


def measured(theory: CoupledLibration, amplitude: float, per_turn: int, frame: str = "relative") -> np.ndarray:
    """Return the two frequencies of a run over n.

    Half the difference of a motion and its opposite is free of what is even in the amplitude.
    """
    time, one = face(theory, amplitude, per_turn, frame)
    _, other = face(theory, -amplitude, per_turn, frame)
    return fitting.frequencies(time, (one - other) / 2, theory.frequencies())


@cache
def limit(separation: float, frame: str = "relative") -> np.ndarray:
    """Return the two frequencies in the limit of step and amplitude zero."""
    theory = closed_form(separation)
    by_amplitude = [fitting.to_zero([measured(theory, a, count, frame) for count in PER_TURN]) for a in AMPLITUDES]
    return fitting.to_zero(by_amplitude)


def digits() -> list[Check]:
    """Return the checks of the known digits."""
    found = (*limit(SEPARATION), closed_form(SEPARATION).uncoupled())
    names = (
        *(f"frequency of the {name} at 1195 m, measured" for name in NAMES),
        "the oracle itself: sqrt(3 (B - A)/C)",
    )
    return [
        Check(
            f"{name}, known as {known:.8f} n",
            value - known,
            5e-9,
            "half of the last known digit",
            shown=f"{value:.11f} n",
            headline="measured" in name,
            printed=True,
        )
        for name, value, known in zip(names, found, (*KNOWN, UNCOUPLED), strict=True)
    ]


def frequency_checks() -> list[Check]:
    """Return the checks of the measured frequencies against linear theory."""
    places = (("relative", SEPARATIONS), ("inertial", (SEPARATION,)))
    return [
        Check(
            f"both frequencies, {frame} frame, at {', '.join(f'{r:g}' for r in distances)} m: worst over linear theory",
            max(np.abs(limit(r, frame) / closed_form(r).frequencies() - 1).max() for r in distances),
            5e-13,
            "rounding of the face, 2e-16 of an amplitude of 1e-4 rad, and what the extrapolations leave",
            roundoff=True,
        )
        for frame, distances in places
    ]


def step_checks() -> list[Check]:
    """Return the checks of the order in the step."""
    theory = closed_form(SEPARATION)
    errors = np.array([measured(theory, 1e-6, count) / theory.frequencies() - 1 for count in PER_TURN])
    orders = [methods.slope(1 / np.array(PER_TURN), np.abs(column)) for column in errors.T]
    return [
        Check(
            f"frequency of the {name}: order in the step",
            order - 2,
            tolerance,
            "the next power of h^2",
            shown=f"{order:.5f}",
        )
        for name, order, tolerance in zip(NAMES, orders, (2e-3, 1.2e-2), strict=True)
    ]


def excess(separation: float) -> float:
    """Return by how much sqrt(3 (B - A)/C M/(M + m)) is above the frequency of the face that is measured, relative.

    The sphere's mass M turns the ellipsoid, the sum of the masses the orbit.
    """
    return float(SHARE * closed_form(separation).uncoupled() / limit(separation)[1] - 1)


def run(effort: Effort) -> Findings:
    """Measure the frequencies."""
    found = [excess(r) for r in SEPARATIONS]
    order = -methods.slope(SEPARATIONS, found)
    checks = [
        *digits(),
        *frequency_checks(),
        *step_checks(),
        Check(
            "by which power of 1/r the uncoupled formula, with the sphere's share of the mass, is too high",
            order - 2,
            1.5e-3,
            "the next power of (size/r)^2",
            shown=f"{order:.4f}",
        ),
    ]
    return Findings(checks, [picture(found)], [budget()])


def budget() -> str:
    """Return what the uncoupled formula leaves out, by its parts."""
    theory = closed_form(SEPARATION)
    A, B, C = theory.moments
    m, r, n = theory.reduced_mass, theory.separation, theory.rate
    coupled = theory.frequencies()[1]
    pendulum = np.sqrt(3 * theory.G * SPHERE * (B - A) / r**3 / C) / n  # the face's own, at the true rate
    parts = (
        SHARE - 1,
        pendulum / (SHARE * theory.uncoupled()) - 1,
        np.sqrt(1 + C / (m * r**2)) - 1,
        coupled / (pendulum * np.sqrt(1 + C / (m * r**2))) - 1,
    )
    return (
        f"At 1195 m the uncoupled formula is {theory.uncoupled() / coupled - 1:.2%} too high. The torque is of the "
        f"sphere's mass, the orbit's rate of both ({parts[0]:+.2%}); that rate is above Kepler's ({parts[1]:+.2%}); "
        f"the orbit turns against the face ({parts[2]:+.2%}); and the torque that the orbit feels changes the "
        f"distance, and with it the orbit's rate, nearly in step with the face ({parts[3]:+.2%})."
    )


def picture(found: list[float]) -> Picture:
    """Draw how far off the uncoupled formula is against the distance, and the error of the frequencies by the step."""
    figure, (left, right) = drawing.axes(2)
    distances, r = np.array(SEPARATIONS) / 1e3, np.geomspace(SEPARATIONS[0], SEPARATIONS[-1], 100)
    left.set(xlabel="separation [km]", ylabel="formula over the frequency of the face, - 1")
    theory = np.array([closed_form(one).uncoupled() / closed_form(one).frequencies()[1] for one in r])
    measured_ = np.array([closed_form(one).uncoupled() / limit(one)[1] - 1 for one in SEPARATIONS])
    for k, (points, line, name) in enumerate(
        ((measured_, theory - 1, "√(3(B-A)/C)"), (found, SHARE * theory - 1, "√(3(B-A)/C M/(M+m))"))
    ):
        drawing.curve(left, distances, points, f"{name}, measured", k)
        left.lines[-1].set_linestyle("none")
        left.plot(r / 1e3, line, color=drawing.COLOURS[k], lw=1, label=f"{name}, linear theory")
    drawing.slope_line(left, distances, (distances[-1], found[-1]), -2)
    drawing.ticks(left, distances)
    left.set_ylim(top=1)
    drawing.legend(left)
    right.set(xlabel="n h [rad]", ylabel="error of the frequency, relative, at 1195 m")
    angles = 2 * np.pi / np.array(PER_TURN)
    exact = closed_form(SEPARATION)
    errors = np.array([1 - measured(exact, 1e-6, count) / exact.frequencies() for count in PER_TURN])
    for k, name in enumerate(NAMES):
        drawing.curve(right, angles, errors[:, k], name, k)
        drawing.slope_line(right, angles, (angles[-1], errors[-1, k]), 2, "_" if k else "slope 2")
    drawing.ticks(right, angles)
    drawing.legend(right)
    caption = (
        "Left: by how much the uncoupled formula is above the frequency of the face, in runs and by the coupled linear "
        "theory. With the sphere's share M/(M+m) of the mass in it, what is left falls as (size/r)². Right: the "
        "frequencies of runs are too low by the square of the step."
    )
    return Picture("libration", figure, caption)


CASE = Case(
    "libration",
    "Do a sphere and an ellipsoid on a circular orbit oscillate with the coupled frequencies of linear theory?",
    "closed form: the characteristic polynomial of the planar problem at second degree",
    run,
    needs=("scipy",),
)
