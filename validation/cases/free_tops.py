"""Free tops: two bodies so far apart that each turns by itself, symmetric ones and triaxial ones."""

from collections.abc import Sequence
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import difference
from validation.methods import Method
from validation.oracles.tops import SymmetricTop, TriaxialTop

FAR = 1e12  # m: two bodies of a gram attract each other by less than round-off
DRIFT = 1.0  # m/s
MASS = 1e-3  # kg
TIME = 4 * 3600.0  # s
COUNTS = (512, 1024, 2048, 4096, 8192)
RATE = 2 * np.pi / 3600  # rad/s, about that of all spins
ATTITUDE = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()
Top = SymmetricTop | TriaxialTop


class Pair(NamedTuple):
    """Two tops with their semi-axes [m], and tolerances: of the order, and of the limit of each method."""

    name: str
    axes: Sequence[Sequence[float]]
    tops: Sequence[Top]
    order: float
    limits: Sequence[float]

    @property
    def fastest(self) -> float:
        """The faster spin of the two at the start [rad/s]."""
        return max(float(np.linalg.norm(top.spin(0.0))) for top in self.tops)

    def system(self) -> ba.System:
        """Return the two bodies, each alone."""
        bodies = [
            ba.RigidBody(name, ba.Ellipsoid(*(axes * u.m)), mass=MASS * u.kg)
            for name, axes in zip(("one", "two"), self.axes, strict=True)
        ]
        return ba.System(bodies, gravity=ba.PointMass())

    def exact(self, time: float) -> Snapshot:
        """Return where they are after a time, in closed form."""
        v = DRIFT / 2 * np.array([[0, -1, 0], [0, 1, 0]])
        x = FAR / 2 * np.array([[-1, 0, 0], [1, 0, 0]]) + v * time
        spins, attitudes = ([getattr(top, what)(time) for top in self.tops] for what in ("spin", "attitude"))
        return Snapshot(v=v, Omega=np.array(spins), x=x, R=np.array(attitudes))

    def start(self) -> ba.State:
        """Return the start."""
        at = self.exact(0.0)
        return ba.State(at.x * u.m, at.v * u.m / u.s, at.R, at.Omega * u.rad / u.s)


def moments(axes: Sequence[float]) -> np.ndarray:
    """Return the moments of an ellipsoid [kg m2]."""
    squares = np.square(axes)
    return MASS * (squares.sum() - squares) / 5


def symmetric(axes: Sequence[float]) -> SymmetricTop:
    """Return a symmetric top that wobbles widely."""
    return SymmetricTop(moments(axes), RATE * np.array([0.5, -0.3, 0.8]), ATTITUDE)


def triaxial(axes: Sequence[float], place: float) -> TriaxialTop:
    """Return a triaxial top with L^2/(2 E) at a place: -1 the smallest moment, 0 the separatrix, 1 the largest."""
    a, b, c = moments(axes)
    ratio = b + place * ((c - b) if place > 0 else (b - a))
    return TriaxialTop(moments(axes), b * RATE * np.array([0.5, -0.6, 0.6]), ratio, phase=0.7)


OBLATE, PROLATE, LONG, FLAT = (1.0, 1.0, 0.6), (0.7, 0.7, 1.0), (1.0, 0.6, 0.5), (1.0, 0.9, 0.5)
PAIRS = (
    Pair(
        "oblate and prolate top",
        (OBLATE, PROLATE),
        (symmetric(OBLATE), symmetric(PROLATE)),
        2e-4,
        (8e-14, 8e-14, 2e-11, 8e-13),
    ),
    Pair(
        "triaxial tops, about the long and the short axis",
        (LONG, FLAT),
        (triaxial(LONG, -0.4), triaxial(FLAT, 0.4)),
        4e-4,
        (3e-14, 3e-14, 2e-12, 4e-13),
    ),
)
ROUNDING = {
    methods.RELATIVE: "rounding of an angle of about 30 rad",
    methods.INERTIAL: "rounding of an angle of about 30 rad",
    methods.PRINTED_RELATIVE: "rounding of products of matrices takes R off SO(3) by 1e-12, and with it J_R = R J R^T, "
    "on which the secondary's spin depends",
    methods.PRINTED_INERTIAL: "rounding of products of matrices, which takes the attitudes off SO(3)",
}


def errors(pair: Pair, method: Method) -> np.ndarray:
    """Return the errors after TIME for each number of steps: position, velocity, attitude, spin."""
    system, start, exact = pair.system(), pair.start(), pair.exact(TIME)
    return np.array([difference(method.end(system, start, TIME, count), exact) for count in COUNTS])


def checks_of(pair: Pair, method: Method, tolerance: float) -> list[Check]:
    """Return the checks of a method on a pair."""
    order = methods.slope(TIME / np.array(COUNTS), errors(pair, method).max(axis=1))
    limit = methods.limit(method, pair.system(), pair.start(), TIME, COUNTS)
    return [
        Check(
            f"{pair.name}, {method.name}: order in the step",
            order - 2,
            pair.order,
            "the next power of h^2, at h Omega of 0.01 to 0.003",
            shown=f"{order:.5f}",
        ),
        Check(
            f"{pair.name}, {method.name}: attitude [rad] and spin after 4 h, step -> 0",
            difference(limit, pair.exact(TIME)).largest,
            tolerance,
            ROUNDING[method],
            headline=method is methods.RELATIVE,
            roundoff=True,
        ),
    ]


def run(effort: Effort) -> Findings:
    """Turn both pairs by every method."""
    checks = []
    for pair in PAIRS:
        for method, tolerance in zip(methods.OF_PAIRS, pair.limits, strict=True):
            checks += checks_of(pair, method, tolerance)
    return Findings(checks, [momenta(), convergence()])


def momenta() -> Picture:
    """Draw the spins of the triaxial tops: closed form, and a run."""
    pair = PAIRS[1]
    step = TIME / COUNTS[1] * u.s
    run = ba.propagate(
        pair.system(), pair.start(), duration=TIME * u.s, integrator=ba.LGVI(step), save_every=TIME / 64 * u.s
    )
    figure, panels = drawing.axes(2, xlabel="time [h]", ylabel="spin in the body's frame [mrad/s]")
    time = np.linspace(0, TIME, 1000)
    for k, (ax, top) in enumerate(zip(panels, pair.tops, strict=True)):
        ax.set_title(("L² < 2 E B: about the long axis", "L² > 2 E B: about the short axis")[k])
        for axis, name in enumerate("xyz"):
            colour = drawing.COLOURS[axis]
            ax.plot(time / 3600, top.spin(time)[:, axis] * 1e3, "-", color=colour, lw=1, label=name)
            ax.plot(run.si.time / 3600, run.si.spin[:, k, axis] * 1e3, drawing.MARKERS[axis], color=colour, ms=3)
        ax.margins(y=0.18)
        drawing.legend(ax, ncols=3, loc="upper center")
    caption = (
        "Spins of two triaxial tops on either side of the separatrix: Jacobi's elliptic functions, lines, and a run in "
        f"steps of {step.value:.3g} s, points."
    )
    return Picture("free-tops-spins", figure, caption)


def convergence() -> Picture:
    """Draw the errors against the step."""
    figure, panels = drawing.axes(2, xlabel="h Omega at the start [rad]", ylabel="error after 4 h")
    for ax, pair in zip(panels, PAIRS, strict=True):
        ax.set_title(pair.name)
        turns = TIME / np.array(COUNTS) * pair.fastest
        found = errors(pair, methods.RELATIVE)
        drawing.curve(ax, turns, found[:, 2], "attitude [rad]", 0)
        drawing.curve(ax, turns, found[:, 3], "spin, relative", 1)
        for k in (2, 3):
            drawing.slope_line(ax, turns, (turns[-1], found[-1, k]), 2, "slope 2" if k == 2 else "_")
        drawing.ticks(ax, turns)
        drawing.legend(ax)
    caption = (
        "Errors of the production steps against the closed forms after 4 h: second order, in attitude and spin. The "
        "checks extrapolate them to the step zero, where round-off is left."
    )
    return Picture("free-tops", figure, caption)


CASE = Case(
    "free-tops",
    "Do free symmetric and triaxial tops turn as their closed forms say, in attitude and spin?",
    "closed forms: precession; Jacobi's sn, cn, dn, with the angle about the momentum by quadrature",
    run,
    needs=("scipy",),
)
