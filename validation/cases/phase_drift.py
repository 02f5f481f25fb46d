"""The phase of a Kepler orbit over 10^4 orbits: how far ahead a step of order 2 runs, and what round-off adds.

Two closed forms say how far. On a circle the map of two points is a circle too if it begins with the right speed:
x(+h) - 2 x + x(-h) = -h^2 n^2 x, so each step turns the line of centres by theta with 2 sin(theta/2) = h n, exactly.
On any orbit the map follows, but for higher powers of h, the modified Hamiltonian of a kick, a drift and a kick,
H + h^2 H2 with H2 = v.V''.v/12 - |grad V|^2/24. For V = -1/r, with r in semi-major axes a and h in 1/n,

    H2 = -3/8 r^-4 + 1/6 r^-3 + (1 - e^2)/4 r^-5,  mean over an orbit 1/16 L^-3 G^-5 - 1/48 L^-5 G^-3,

L = 1 and G = (1 - e^2)^(1/2) being Delaunay's actions. The derivatives of the mean turn mean anomaly and apsides; that
the run starts from given vectors sets the mean energy to H + h^2 (H2(start) - mean), which changes the mean motion.
"""

from typing import NamedTuple

import astropy.units as u
import numpy as np
from matplotlib.axes import Axes

import binaryast as ba
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import nbody

SEMI_MAJOR_AXIS = 1e4  # m
SYSTEM = ba.System(
    [ba.RigidBody(name, ba.Point(), mass=m * u.kg) for name, m in (("A", 7.6e11), ("B", 1.5e11))],
    gravity=ba.PointMass(),
)
GM = np.sum([body.si.gm for body in SYSTEM.bodies], dtype=np.longdouble)
MEAN_MOTION = float(np.sqrt(GM / SEMI_MAJOR_AXIS**3))  # rad/s
ORBITS = 10_000
STEPS = 200  # in an orbit
BETWEEN = 10.6180339887  # orbits between rows: they fall on all phases evenly
FRAMES = {"LGVI, relative frame": "relative", "LGVI, inertial frame": "inertial"}
OTHERS = {"REBOUND leapfrog, conjugate": "leapfrog", "REBOUND WHFast": "whfast"}
NAMES = {"longitude": "mean longitude", "anomaly": "mean anomaly", "apsides": "apsides"}
LAW_TOLERANCES = {"longitude": (2e-3, 1e-2), "anomaly": (4e-3, 3e-3), "apsides": (8e-3, 1e-2)}  # and of the order
ENERGY_GROWTH = 1.5e-9
TURN = 2 * np.arccos(np.longdouble(-1))


class Rows(NamedTuple):
    """A pair's relative motion in rows that are ``stride`` steps of h [s] apart."""

    h: float
    stride: int
    position: np.ndarray
    velocity: np.ndarray
    energy_error: float = np.nan

    @property
    def angle(self) -> np.ndarray:
        """Mean motion times time [rad]."""
        return MEAN_MOTION * self.h * self.stride * np.arange(len(self.position))


def step(per_orbit: int) -> float:
    """Return the step [s], a whole part of the time between rows."""
    return BETWEEN * 2 * np.pi / MEAN_MOTION / round(BETWEEN * per_orbit)


def follow(name: str, state: ba.State, per_orbit: int, orbits: float) -> Rows:
    """Follow a start by one of the methods, by its name."""
    h, stride = step(per_orbit), round(BETWEEN * per_orbit)
    count = round(orbits / BETWEEN)
    if name in OTHERS:
        position, velocity = nbody.rows(SYSTEM, state, OTHERS[name], h, stride, count)
        return Rows(h, stride, position[:, 1] - position[:, 0], velocity[:, 1] - velocity[:, 0])
    run = ba.propagate(
        SYSTEM,
        state,
        duration=count * stride * h * u.s,
        integrator=ba.LGVI(h * (1 + 1e-12) * u.s, frame=FRAMES[name]),
        save_every=stride * h * u.s,
    )
    position, velocity = run.si.position, run.si.velocity
    if run.steps != count * stride:
        raise RuntimeError(f"expected {count * stride} steps, got {run.steps}: {run.status} {run.message}")
    return Rows(
        run.step.value,
        stride,
        position[:, 1] - position[:, 0],
        velocity[:, 1] - velocity[:, 0],
        run.max_relative_energy_error,
    )


# --- circles: 2 sin(theta/2) = h n


def turn_of_a_step(h: float) -> np.longdouble:
    """Return theta [rad] of the map's circle."""
    return 2 * np.arcsin(h * np.sqrt(GM / np.longdouble(SEMI_MAJOR_AXIS) ** 3) / 2)


def circle(h: float) -> ba.State:
    """Return the start of the map's circle: its speed is r sin(theta)/h."""
    speed = float(SEMI_MAJOR_AXIS * np.sin(turn_of_a_step(h)) / h)
    masses = np.array([body.si.mass for body in SYSTEM.bodies])
    shares = np.array([[-masses[1]], [masses[0]]]) / masses.sum()
    at_rest = np.zeros((2, 3)) * u.rad / u.s
    place, motion = np.array([SEMI_MAJOR_AXIS, 0, 0]), np.array([0, speed, 0])
    return ba.State(shares * place * u.m, shares * motion * u.m / u.s, [np.eye(3)] * 2, at_rest)


def off_the_law(rows: Rows, per_step: np.longdouble) -> np.ndarray:
    """Return by how much [rad] the line of centres is ahead of so large a turn in each step."""
    x, y, _ = rows.position.T
    ahead = np.arctan2(y, x) - per_step * rows.stride * np.arange(len(x))
    return (ahead - TURN * np.round(ahead / TURN)).astype(float)


def of_circles() -> tuple[list[Check], dict[str, np.ndarray]]:
    """Compare 10^4 orbits on the map's circle with its law; return what each method is off by, too."""
    h = step(STEPS)
    theta = turn_of_a_step(h)
    runs = {name: follow(name, circle(h), STEPS, ORBITS) for name in (*FRAMES, "REBOUND leapfrog, conjugate")}
    off = {name: off_the_law(rows, theta) for name, rows in runs.items()}
    kepler = ba.State.from_elements(SYSTEM, semi_major_axis=SEMI_MAJOR_AXIS * u.m, spins=[None, None])
    rows = follow("REBOUND WHFast", kepler, STEPS, ORBITS)
    off["REBOUND WHFast"] = off_the_law(rows, h * np.sqrt(GM / np.longdouble(SEMI_MAJOR_AXIS) ** 3))
    ahead = float((theta / h / MEAN_MOTION - 1) * runs["LGVI, relative frame"].angle[-1])
    why = "rounding of each of 2e6 attractions, 1e-16: it adds up by chance in the speed, and that in the phase"
    return [
        Check(
            f"circle, 10^4 orbits of {STEPS} steps: largest difference of the phase, LGVI (both frames) from law [rad]",
            max(np.abs(off[name]).max() for name in FRAMES),
            1.5e-9,
            why,
            shown=f"ahead of Kepler by {ahead + off['LGVI, relative frame'][-1]:.6f} rad in the end",
            headline=True,
            roundoff=True,
        ),
        Check(
            f"circle, 10^4 orbits of {STEPS} steps: largest difference of the phase, REBOUND leapfrog minus law [rad]",
            np.abs(off["REBOUND leapfrog, conjugate"]).max(),
            1.5e-8,
            f"{why}; its sums are not compensated",
            roundoff=True,
        ),
        Check(
            f"circle, 10^4 orbits of {STEPS} steps: largest error of energy over |E0|, LGVI, both frames",
            max(runs[name].energy_error for name in FRAMES),
            4e-14,
            "rounding that adds up by chance: on the map's circle the energy is constant",
            roundoff=True,
        ),
    ], off


# --- ellipses: the modified Hamiltonian


class Drift(NamedTuple):
    """How fast mean anomaly and apsides turn, over the mean motion: ahead of what Kepler says."""

    anomaly: float
    apsides: float

    @property
    def longitude(self) -> float:
        """Of the mean longitude, the phase along the track."""
        return self.anomaly + self.apsides


def second_order(r: float, e: float) -> float:
    """Return H2 at a distance r, in units of n^2 a^2."""
    return -3 / 8 / r**4 + 1 / 6 / r**3 + (1 - e * e) / 4 / r**5


def law(e: float, h: float) -> Drift:
    """Return the drift of a start at periapsis, to second order."""
    G = np.sqrt(1 - e * e)
    square = (h * MEAN_MOTION) ** 2
    mean = 1 / 16 / G**5 - 1 / 48 / G**3
    anomaly = -3 / 16 / G**5 + 5 / 48 / G**3 - 3 * (second_order(1 - e, e) - mean)
    return Drift(square * anomaly, square * (-5 / 16 / G**6 + 1 / 16 / G**4))


def elements(rows: Rows) -> tuple[np.ndarray, np.ndarray]:
    """Return by how much [rad] mean anomaly and apsides are ahead of Kepler's, osculating, at each row."""
    x, v = rows.position / SEMI_MAJOR_AXIS, rows.velocity / (SEMI_MAJOR_AXIS * MEAN_MOTION)
    r = np.linalg.norm(x, axis=1)
    moment = x[:, 0] * v[:, 1] - x[:, 1] * v[:, 0]
    towards = np.array([v[:, 1] * moment, -v[:, 0] * moment]) - x[:, :2].T / r  # e, to the periapsis
    e, apsides = np.hypot(*towards), np.arctan2(towards[1], towards[0])
    true = np.arctan2(x[:, 1], x[:, 0]) - apsides
    eccentric = 2 * np.arctan2(np.sqrt(1 - e) * np.sin(true / 2), np.sqrt(1 + e) * np.cos(true / 2))
    return np.unwrap(eccentric - e * np.sin(eccentric) - rows.angle), np.unwrap(apsides)


def measured(rows: Rows) -> Drift:
    """Return the drift of a run: straight lines through all rows."""
    return Drift(*(float(np.polyfit(rows.angle, ahead, 1)[0]) for ahead in elements(rows)))


def longitude(rows: Rows) -> np.ndarray:
    """Return by how much [rad] the mean longitude is ahead."""
    ahead = np.sum(elements(rows), axis=0)
    return np.unwrap(ahead - 2 * np.pi * np.round(ahead[0] / (2 * np.pi)))


def ellipse(e: float) -> ba.State:
    """Return the start at periapsis."""
    return ba.State.from_elements(SYSTEM, semi_major_axis=SEMI_MAJOR_AXIS * u.m, eccentricity=e, spins=[None, None])


def of_laws() -> list[Check]:
    """Compare the drift over 10^4 orbits with the law, and how their difference goes with the step."""
    checks = []
    for e, orbits, parts in ((0.0, ORBITS // 10, ["longitude"]), (0.3, ORBITS, ["anomaly", "apsides"])):
        runs = [follow("LGVI, relative frame", ellipse(e), n, orbits) for n in (STEPS // 2, STEPS, 2 * STEPS)]
        drifts = [(measured(rows), law(e, rows.h)) for rows in runs]
        for part in parts:
            off = [getattr(found, part) / getattr(due, part) - 1 for found, due in drifts]
            rate = getattr(drifts[1][0], part)
            tolerance, of_order = LAW_TOLERANCES[part]
            checks += [
                Check(
                    f"e = {e:g}, {STEPS} steps an orbit: drift of the {NAMES[part]} over the law, minus 1",
                    off[1],
                    tolerance,
                    "the next power of the step, (h n)^2 = 9.9e-4 times a number: the next row",
                    shown=f"{rate * 2 * np.pi * orbits:.4f} rad in {orbits} orbits",
                    headline=part == "anomaly",
                ),
                Check(
                    f"e = {e:g}: order in the step of that difference, {NAMES[part]}",
                    methods.slope([rows.h for rows in runs], np.abs(off)) - 2,
                    of_order,
                    "the power of the step after the next",
                    shown=f"{methods.slope([rows.h for rows in runs], np.abs(off)):.4f}",
                ),
            ]
        if e:
            checks += of_energies(e, runs[1])
    return checks


def of_energies(e: float, rows: Rows) -> list[Check]:
    """Compare the largest error of energy with the law, and with that of the first orbits."""
    due = (rows.h * MEAN_MOTION) ** 2 * abs(second_order(1 - e, e) - second_order(1 + e, e)) / 0.5
    first = follow("LGVI, relative frame", ellipse(e), STEPS, 100).energy_error
    return [
        Check(
            f"e = {e:g}, {STEPS} steps an orbit: largest error of energy in 10^4 orbits over the law, minus 1",
            rows.energy_error / due - 1,
            5e-3,
            "the next power of the step, (h n)^2 = 9.9e-4; the law: h^2 (H2(periapsis) - H2(apoapsis))",
            shown=f"{rows.energy_error:.5e}",
        ),
        Check(
            f"e = {e:g}, {STEPS} steps an orbit: growth of that error from 10^2 to 10^4 orbits, relative",
            rows.energy_error / first - 1,
            ENERGY_GROWTH,
            "it does not grow; in more orbits a step falls nearer to the apoapsis",
        ),
    ]


def of_maps(e: float) -> tuple[list[Check], dict[str, np.ndarray]]:
    """Compare the longitudes over 10^4 orbits of the two frames and of the leapfrog; return those of all methods."""
    ahead = {name: longitude(follow(name, ellipse(e), STEPS, ORBITS)) for name in (*FRAMES, *OTHERS)}
    ours = ahead["LGVI, relative frame"]
    return [
        Check(
            f"e = {e:g}, 10^4 orbits of {STEPS} steps: largest difference of the longitude, {what} [rad]",
            np.abs(apart).max(),
            tolerance,
            why,
            roundoff=True,
        )
        for what, apart, tolerance, why in (
            (
                "LGVI, inertial minus relative frame",
                ahead["LGVI, inertial frame"] - ours,
                4e-9,
                "rounding: the same map",
            ),
            (
                "LGVI minus REBOUND leapfrog, conjugate",
                ours - ahead["REBOUND leapfrog, conjugate"],
                6e-8,
                "rounding of the leapfrog: the same map",
            ),
            ("REBOUND WHFast minus Kepler", ahead["REBOUND WHFast"], 2e-8, "rounding: its map is exact for two bodies"),
        )
    ], ahead


def draw_drift(ax: Axes, ahead: dict[str, np.ndarray], e: float) -> None:
    """Draw how far behind the methods are, and the law."""
    rows = np.unique(np.geomspace(1, len(ahead["REBOUND WHFast"]) - 1, 13).astype(int))
    orbits = rows * BETWEEN
    drawing.curve(ax, orbits, -ahead["LGVI, relative frame"][rows], "LGVI", 0)
    drawing.curve(ax, orbits, -ahead["REBOUND leapfrog, conjugate"][rows], "REBOUND leapfrog, conjugate", 2)
    ax.lines[-1].set(markerfacecolor="none", markersize=8)  # around those of LGVI
    drawing.curve(ax, orbits, np.abs(ahead["REBOUND WHFast"][rows]), "REBOUND WHFast", 3)
    h = step(STEPS)
    drawing.slope_line(ax, orbits, (1.0, -2 * np.pi * law(e, h).longitude), 1, "law of the modified Hamiltonian")
    ax.set(title=f"e = {e:g}", ylabel="behind Kepler's longitude [rad]")
    drawing.legend(ax, loc=(0.02, 0.5))


def draw_rounding(ax: Axes, off: dict[str, np.ndarray]) -> None:
    """Draw what round-off adds on a circle: the largest so far."""
    for index, (name, values) in zip((0, 1, 2, 3), off.items(), strict=True):
        rows = np.unique(np.geomspace(1, len(values) - 1, 13).astype(int))
        drawing.curve(ax, rows * BETWEEN, np.maximum.accumulate(np.abs(values))[rows], name, index)
    drawing.slope_line(ax, (10, ORBITS), (10, 2e-15), 1.5, "slope 3/2: by chance")
    ax.set(title="circle", ylabel="off the exact law [rad]")
    drawing.legend(ax)


def run(effort: Effort) -> Findings:
    """Follow all orbits."""
    circles, off = of_circles()
    ellipses, ahead = of_maps(0.3)
    figure, (left, right) = drawing.axes(2, xlabel="orbits")
    draw_drift(left, ahead, 0.3)
    draw_rounding(right, off)
    caption = (
        f"Phase over 10^4 orbits of {STEPS} steps. Left: LGVI and REBOUND's leapfrog, from the conjugate start, fall "
        "behind alike, as the modified Hamiltonian says; WHFast is exact for two bodies. Right: what each is off the "
        "exact law 2 sin(theta/2) = h n of a circle, WHFast off Kepler's. That is round-off, which compensated sums "
        "make smaller."
    )
    return Findings([*circles, *of_laws(), *ellipses], [Picture("phase-drift", figure, caption)])


CASE = Case(
    "phase-drift",
    "Does the phase of a Kepler orbit run off over 10^4 orbits as theory says of a step of order 2, and no further?",
    "closed forms: 2 sin(theta/2) = h n, the modified Hamiltonian; REBOUND: leapfrog and WHFast, given our G",
    run,
    needs=("rebound",),
)
