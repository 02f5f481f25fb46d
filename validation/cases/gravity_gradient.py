"""A light body on a circular orbit about a heavy sphere: it librates in the plane of the orbit and out of it.

A dumbbell does so by sqrt(3) n and 2 n.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from validation import drawing, fitting, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import librations

GM, RADIUS = 3.98600435507e14, 6.378e6  # m3/s2, m: the Earth
SEPARATION = 6.678e6  # m
RATE = np.sqrt(GM / SEPARATION**3)  # rad/s
MASS = 1000.0  # kg
Z, Y = np.array([0.0, 0.0, 1.0]), np.array([0.0, 1.0, 0.0])  # turns in the plane, and out of it
AMPLITUDES = (1e-4, 5e-5)  # rad; extrapolated to zero
TURNS = 20
PER_TURN = (512, 1024, 2048, 4096)  # steps, extrapolated to a step of zero
SWINGS = np.radians([20.0, 50.0, 80.0])  # amplitudes in the plane
SWING_TURNS = 3
LENGTHS = (20.0, 10.0)  # m: of a dumbbell that swings, extrapolated to zero, for the orbit feels it by their square


class Craft(NamedTuple):
    """A spacecraft, with its moments of inertia [kg m2], or a dumbbell where there are none."""

    name: str
    length: float
    radius: float
    inertia: tuple[float, float, float] | None = None

    @property
    def body(self) -> ba.RigidBody:
        """The body; gravity of second degree asks for no more than its moments."""
        shape = ba.Dumbbell(self.length * u.m, self.radius * u.m)
        given = {} if self.inertia is None else {"inertia": self.inertia * u.kg * u.m**2}
        return ba.RigidBody("craft", shape, mass=MASS * u.kg, **given)

    @property
    def moments(self) -> np.ndarray:
        """A, B, C [kg m2]."""
        if self.inertia is not None:
            return np.array(self.inertia)
        along = 0.4 * self.radius**2
        return MASS * np.array([along, along + self.length**2 / 4, along + self.length**2 / 4])

    @property
    def size2(self) -> float:
        """(B + C - 2 A)/m [m2]: what the orbit feels."""
        A, B, C = self.moments
        return (B + C - 2 * A) / MASS


DUMBBELL = Craft("dumbbell", 10.0, 1e-4)
CRAFTS = (
    DUMBBELL,
    Craft("cylinder", 12.0, 0.5, (500.0, 12250.0, 12250.0)),
    Craft("box", 2.0, 0.5, (500.0, 900.0, 1100.0)),
)


def motion(craft: Craft, tilt: np.ndarray, per_turn: int, turns: int = TURNS, frame: str = "relative") -> ba.Trajectory:
    """Return a run begun in the equilibrium, but for a turn by a rotation vector, at rest in the orbit's frame.

    Its spin is about its own z axis, for a dumbbell does not feel one about its line.
    """
    earth = ba.RigidBody("earth", ba.Sphere(RADIUS * u.m), gm=GM * u.m**3 / u.s**2)
    system = ba.System([earth, craft.body], gravity=ba.SecondDegree())
    R = Rotation.from_rotvec(tilt).as_matrix()
    start = ba.RelativeState(
        X=[SEPARATION, 0, 0] * u.m,
        V=[0, RATE * SEPARATION, 0] * u.m / u.s,
        R=R,
        Omega=RATE * R[:, 2] * u.rad / u.s,
        Omega2=[0, 0, 0] * u.rad / u.s,
    )
    period = 2 * np.pi / RATE * u.s
    step = period / per_turn
    integrator = ba.LGVI(step * (1 + 1e-12), frame=frame)
    return ba.propagate(
        system, start.to_state(system), duration=turns * period, integrator=integrator, save_every=period / 32
    )


def face(run: ba.Trajectory) -> np.ndarray:
    """Return the angle [rad] in the plane from the line of centres to the long axis."""
    x, long = run.si.position[:, 1] - run.si.position[:, 0], run.si.attitude[:, 1, :, 0]
    return np.arctan2(np.cross(x, long)[:, 2], np.sum(x * long, axis=1))


def out_of_plane(run: ba.Trajectory) -> np.ndarray:
    """Return the tilt [rad] of the long axis out of the plane."""
    return run.si.attitude[:, 1, 2, 0]


class Mode(NamedTuple):
    """Oscillations in the plane or out of it: how they are begun and seen, and their frequencies over n by theory."""

    name: str
    axis: np.ndarray
    signal: Callable[[ba.Trajectory], np.ndarray]
    theory: tuple[float, ...]


def modes(craft: Craft) -> tuple[Mode, Mode]:
    """Return what a craft does; a body with two equal moments does not feel the slow one out of the plane."""
    out = tuple(w for w in librations.roll_and_yaw(craft.moments) if w > 0)
    return (
        Mode("in the plane", Z, face, (librations.pitch(craft.moments),)),
        Mode("out of it", Y, out_of_plane, out),
    )


def measured(craft: Craft, mode: Mode, amplitude: float, per_turn: int, frame: str = "relative") -> np.ndarray:
    """Return the frequencies of a run over n.

    Half the difference of a motion and its opposite is free of what is even in the amplitude.
    """
    one, other = (motion(craft, sign * amplitude * mode.axis, per_turn, frame=frame) for sign in (1, -1))
    return fitting.frequencies(RATE * one.si.time, (mode.signal(one) - mode.signal(other)) / 2, mode.theory)


def limit(craft: Craft, mode: Mode, frame: str = "relative") -> np.ndarray:
    """Return the frequencies over n in the limit of step and amplitude zero."""
    by_amplitude = [[measured(craft, mode, a, count, frame) for count in PER_TURN] for a in AMPLITUDES]
    return fitting.to_zero([fitting.to_zero(found) for found in by_amplitude])


def dumbbell_check(mode: Mode, found: float, name: str, value: float) -> Check:
    """Return the check of a frequency of the dumbbell, sqrt(3) n or 2 n."""
    return Check(
        f"dumbbell {mode.name}: frequency over {name} n",
        found / value - 1,
        3e-10,
        "the spheres' own moments, which take off 8e-11 in the plane and 6e-11 out of it",
        shown=f"{found:.10f} n",
        headline=True,
    )


def frequency_check(craft: Craft, mode: Mode, frame: str, found: np.ndarray) -> Check:
    """Return the check of a craft's frequencies against theory with its moments."""
    return Check(
        f"{craft.name} {mode.name}, {frame} frame: frequency over linear theory",
        np.abs(found / mode.theory - 1).max(),
        1e-12 + 9 * craft.size2 / SEPARATION**2,
        "the orbit feels the body, by three times (B + C - 2 A)/(m r^2), and rounding",
        shown=", ".join(f"{value:.10f} n" for value in mode.theory),
    )


def frequency_checks(frames: Sequence[str]) -> list[Check]:
    """Return the checks of the frequencies of all craft."""
    checks = []
    for craft in CRAFTS:
        for mode, name, value in zip(modes(craft), ("sqrt(3)", "2"), (np.sqrt(3), 2.0), strict=True):
            for frame in frames:
                found = limit(craft, mode, frame)
                if craft is DUMBBELL and frame == "relative":
                    checks.append(dumbbell_check(mode, float(found[0]), name, value))
                checks.append(frequency_check(craft, mode, frame, found))
    return checks


@cache
def swing(length: float, amplitude: float, per_turn: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the turns of a dumbbell's orbit and its angle [rad] in the plane, begun at an amplitude."""
    run = motion(Craft("dumbbell", length, 1e-5 * length), amplitude * Z, per_turn, SWING_TURNS)
    return RATE * run.si.time / (2 * np.pi), face(run)


def pendulum(amplitude: float, turns: np.ndarray) -> np.ndarray:
    """Return the same by Jacobi's functions."""
    return librations.pendulum(amplitude, librations.pitch(DUMBBELL.moments), 2 * np.pi * turns)


def swing_checks() -> list[Check]:
    """Return the checks of wide swings in the plane against the pendulum."""
    return [
        Check(
            f"dumbbell swinging by {np.degrees(amplitude):.0f} deg for {SWING_TURNS} turns: angle by Jacobi's sn [rad]",
            np.abs(fitting.to_zero([swing_error(length, amplitude) for length in LENGTHS])).max(),
            tolerance,
            "rounding, and what the extrapolations of step and length to zero leave",
            roundoff=True,
        )
        for amplitude, tolerance in zip(SWINGS, (4e-14, 1e-13, 7e-12), strict=True)
    ]


def swing_error(length: float, amplitude: float) -> np.ndarray:
    """Return the angles of a dumbbell in the limit of step zero, less those of the pendulum [rad]."""
    turns, _ = swing(length, amplitude, PER_TURN[0])
    found = fitting.to_zero([swing(length, amplitude, count)[1] for count in PER_TURN])
    return found - pendulum(amplitude, turns)


def order_check() -> Check:
    """Return the check of the order in the step."""
    box = CRAFTS[-1]
    mode = modes(box)[1]
    errors = [np.abs(measured(box, mode, 1e-6, count) / mode.theory - 1).max() for count in PER_TURN]
    order = methods.slope(1 / np.array(PER_TURN), errors)
    return Check(
        "box out of it: order of the frequencies in the step",
        order - 2,
        1.2e-2,
        "the next power of h^2",
        shown=f"{order:.5f}",
    )


def run(effort: Effort) -> Findings:
    """Measure the frequencies."""
    frames = ("relative",) if effort is Effort.QUICK else ("relative", "inertial")
    checks = [*frequency_checks(frames), *swing_checks(), order_check()]
    period = 2 * np.pi / RATE
    note = (
        f"At 300 km a dumbbell swings in {period / np.sqrt(3):.1f} s in the plane and in {period / 2:.1f} s out of it."
    )
    return Findings(checks, [picture()], [note])


def picture() -> Picture:
    """Draw wide swings in time, and the errors of small oscillations' frequencies against the step."""
    figure, (left, right) = drawing.axes(2)
    left.set(xlabel="turns of the orbit", ylabel="angle from the line of centres [deg]", ylim=(-90, 125))
    fine = np.linspace(0, SWING_TURNS, 600)
    for k, amplitude in enumerate(SWINGS):
        turns, angle = swing(LENGTHS[1], amplitude, PER_TURN[0])
        colour = drawing.COLOURS[k]
        left.plot(fine, np.degrees(pendulum(amplitude, fine)), color=colour, lw=1)
        label = f"{np.degrees(amplitude):.0f} deg"
        left.plot(turns, np.degrees(angle), drawing.MARKERS[k], color=colour, ms=3, label=label)
    drawing.legend(left, ncols=3, loc="upper center")
    right.set(xlabel="n h [rad]", ylabel="error of the frequency, relative")
    angles = 2 * np.pi / np.array(PER_TURN)
    pairs = [(craft, mode) for craft in CRAFTS for mode in modes(craft)]
    for k, (craft, mode) in enumerate(pairs):
        errors = [np.abs(measured(craft, mode, 1e-5, count) / mode.theory - 1).max() for count in PER_TURN]
        drawing.curve(right, angles, errors, f"{craft.name} {mode.name}", k)
        drawing.slope_line(right, angles, (angles[0], errors[0]), 2, "_" if k else "slope 2")
    drawing.ticks(right, angles)
    right.set_ylim(top=0.1)
    drawing.legend(right, ncols=2, loc="upper left")
    caption = (
        "Left: a dumbbell swinging in the plane of its orbit, by Jacobi's functions, lines, and in a run, points. "
        "Right: errors of the frequencies of small librations against the step, second order; in the plane those of "
        "orbit and swing nearly cancel where the frequency is sqrt(3) n."
    )
    return Picture("gravity-gradient", figure, caption)


CASE = Case(
    "gravity-gradient",
    "Does a spacecraft on a circular orbit librate by sqrt(3) n and 2 n, and as its moments say?",
    "closed forms: linear theory (DeBra and Delp), the pendulum by Jacobi's functions",
    run,
    needs=("scipy",),
)
