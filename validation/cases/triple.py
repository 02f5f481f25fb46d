"""Several bodies as spheres and points: 2001 SN263, with a spacecraft too, and Pluto's system, beside REBOUND.

2001 SN263 is that of the catalogue, its bodies as spheres of 1250, 215 and 385 m. Pluto's system is four points: GM
from JPL's ephemeris PLU060 (plu060.cmt), periods and the eccentricity of Hydra from M. W. Buie et al., AJ 132 (2006)
290; places on the orbits and small inclinations are free choices.
"""

from collections.abc import Callable, Sequence
from typing import NamedTuple

import astropy.units as u
import numpy as np
from matplotlib.axes import Axes

import binaryast as ba
from validation import drawing, methods
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import Difference, difference
from validation.methods import Method
from validation.oracles import nbody

DAY = 86400.0
HALVINGS = 5
RADII = {"Alpha": 1250.0, "Gamma": 215.0, "Beta": 385.0}  # m
PLUTO = {  # GM [km3/s2], period [d]
    "Pluto": (869.3261226311508, None),
    "Charon": (106.1011388236118, 6.3872304),
    "Nix": (1.496176095836919e-3, 24.8562),
    "Hydra": (2.007962473606101e-3, 38.2065),
}


def sn263_spheres() -> tuple[ba.System, ba.State]:
    """Return 2001 SN263 with spheres, which turn as in the catalogue."""
    given, start = ba.catalogue.load("sn263")
    bodies = [ba.RigidBody(body.name, ba.Sphere(RADII[body.name] * u.m), mass=body.mass) for body in given.bodies]
    return ba.System(bodies), start


def sn263_and_craft() -> tuple[ba.System, ba.State]:
    """Return 2001 SN263 with points and a spacecraft of 12 kg on a circle of 8 km about Alpha, out of all planes."""
    given, start = ba.catalogue.load("sn263")
    bodies = [ba.RigidBody(body.name, ba.Point(), mass=body.mass) for body in given.bodies]
    craft = ba.RigidBody("craft", ba.Point(), mass=12 * u.kg)
    speed = np.sqrt(bodies[0].si.gm / 8000)
    x, v = start.si.position[0] + [0, 4800, 6400], start.si.velocity[0] + [speed, 0, 0]
    state = ba.State(
        np.vstack([start.si.position, x]) * u.m,
        np.vstack([start.si.velocity, v]) * u.m / u.s,
        [np.eye(3)] * 4,
        np.zeros((4, 3)) * u.rad / u.s,
    )
    return ba.System([*bodies, craft], gravity=ba.PointMass()), state


def pluto() -> tuple[ba.System, ba.State]:
    """Return Pluto, Charon, Nix and Hydra as points."""
    bodies = [ba.RigidBody(name, ba.Point(), gm=gm * u.km**3 / u.s**2) for name, (gm, _) in PLUTO.items()]
    within = np.cumsum([body.si.gm for body in bodies])
    axes = [
        np.cbrt(gm * (period * DAY / (2 * np.pi)) ** 2) * u.m
        for gm, (_, period) in zip(within, PLUTO.values(), strict=True)
        if period
    ]
    orbits = [
        ba.Orbit(axes[0]),
        ba.Orbit(axes[1], inclination=0.1 * u.deg, mean_anomaly=100 * u.deg, about="inner"),
        ba.Orbit(axes[2], 0.0052, inclination=0.2 * u.deg, mean_anomaly=220 * u.deg, about="inner"),
    ]
    system = ba.System(bodies, gravity=ba.PointMass())
    return system, ba.State.from_orbits(system, orbits, spins=[None] * 4)


class Setting(NamedTuple):
    """A system, how long it is followed [s], the coarsest steps of its limit, and tolerances."""

    name: str
    start: Callable[[], tuple[ba.System, ba.State]]
    time: float
    steps: int
    to_ias15: float
    to_whfast: float
    to_leapfrog: float
    to_extended: float
    order: float


SETTINGS = (
    Setting("2001 SN263, spheres, 10 d", sn263_spheres, 10 * DAY, 16000, 9e-13, 6e-12, 1.8e-12, 4e-13, 5e-4),
    Setting("2001 SN263 with a craft, points, 10 d", sn263_and_craft, 10 * DAY, 4000, 2e-13, 2e-12, 3e-12, 9e-14, 1e-3),
    Setting("Pluto, Charon, Nix, Hydra, points, 50 d", pluto, 50 * DAY, 4000, 9e-14, 1.3e-12, 3e-12, 4e-14, 2e-4),
)
SAME_STEPS = 4000


def errors(method: Method, setting: Setting, counts: Sequence[int]) -> list[Difference]:
    """Return the errors of a method in so many steps, against IAS15."""
    system, state = setting.start()
    end = nbody.ias15(system, state, setting.time)
    return [difference(method.end(system, state, setting.time, count), end) for count in counts]


def of_limits(setting: Setting) -> list[Check]:
    """Compare the limit of the step to zero with IAS15, and with that of WHFast."""
    system, state = setting.start()
    limit, of_whfast = (
        methods.limit(method, system, state, setting.time, [first * 2**k for k in range(HALVINGS)])
        for method, first in ((methods.INERTIAL, setting.steps), (nbody.WHFAST, setting.steps // 4))
    )
    return [
        Check(
            f"{setting.name}: limit of the step to zero minus IAS15",
            difference(limit, nbody.ias15(system, state, setting.time)).largest,
            setting.to_ias15,
            "rounding of IAS15: limits from other steps agree to 4e-14",
            headline=setting is SETTINGS[0],
            roundoff=True,
        ),
        Check(
            f"{setting.name}: limit of the step to zero minus that of REBOUND WHFast",
            difference(limit, of_whfast).largest,
            setting.to_whfast,
            "rounding of WHFast: it changes with its steps",
            roundoff=True,
        ),
    ]


def of_maps(setting: Setting) -> list[Check]:
    """Compare with REBOUND's leapfrog at the same step, taken from its nodes to ours: the same map."""
    system, state = setting.start()
    end = methods.INERTIAL.end(system, state, setting.time, SAME_STEPS)
    leapfrog = nbody.kick_drift_kick(system, state, setting.time, SAME_STEPS)
    extended = nbody.kick_drift_kick_extended(system, state, setting.time, SAME_STEPS)
    return [
        Check(
            f"{setting.name}, {SAME_STEPS} steps: LGVI minus REBOUND leapfrog, conjugate by half a step",
            difference(end, leapfrog).largest,
            setting.to_leapfrog,
            "rounding of the leapfrog, whose sums are not compensated: see the next row",
            headline=setting is SETTINGS[0],
            roundoff=True,
        ),
        Check(
            f"{setting.name}, {SAME_STEPS} steps: LGVI minus the same map {nbody.IN_EXTENDED}",
            difference(end, extended).largest,
            setting.to_extended,
            "rounding of LGVI" + (", most in the attitude of Alpha, 440 rad" if "spheres" in setting.name else ""),
            roundoff=True,
        ),
    ]


def of_orders(setting: Setting) -> Check:
    """Check the order of position, velocity and attitude."""
    counts = [setting.steps * 2**k for k in range(3)]
    found = errors(methods.INERTIAL, setting, counts)
    parts = ["position", "velocity", *(["attitude"] if "spheres" in setting.name else [])]
    slopes = [methods.slope([1 / n for n in counts], [getattr(error, part) for error in found]) for part in parts]
    furthest = max(slopes, key=lambda slope: abs(slope - 2))
    return Check(
        f"{setting.name}: order in the step of {', '.join(parts)}",
        furthest - 2,
        setting.order,
        "the next power of the step, h^4",
        shown=f"{furthest:.5f}",
    )


def draw(ax: Axes, setting: Setting) -> None:
    """Draw the errors of the methods, and the difference of LGVI from the conjugate leapfrog, against the step."""
    system, state = setting.start()
    counts = [1000 * 4**k for k in range(5)]
    h = [setting.time / count / 60 for count in counts]
    for index, method in ((0, methods.INERTIAL), (2, nbody.LEAPFROG), (3, nbody.WHFAST)):
        label = "LGVI" if index == 0 else method.name
        found = errors(method, setting, counts)
        drawing.curve(ax, h, [error.position for error in found], label, index)
        if index == 0:
            drawing.slope_line(ax, h, (h[-1], 0.1 * found[-1].position), 2)
    ax.lines[2].set(markerfacecolor="none", markersize=8)  # the leapfrog's, around those of LGVI
    apart = [
        difference(
            methods.INERTIAL.end(system, state, setting.time, n), nbody.kick_drift_kick(system, state, setting.time, n)
        ).position
        for n in counts
    ]
    drawing.curve(ax, h, apart, "LGVI minus conjugate leapfrog", 4)
    ax.set(title=setting.name, ylim=(1e-19, 10))
    ax.title.set_fontsize(9)


def run(effort: Effort) -> Findings:
    """Follow all systems."""
    checks: list[Check] = []
    figure, panels = drawing.axes(3, xlabel="step [min]", ylabel="error in position / distance of the first two")
    for ax, setting in zip(panels, SETTINGS, strict=True):
        checks += [*of_limits(setting), *of_maps(setting), of_orders(setting)]
        draw(ax, setting)
    drawing.legend(panels[0], loc="lower right")
    caption = (
        "Errors against IAS15 at the end. LGVI and REBOUND's leapfrog have slope 2 and nearly the same constant; taken "
        "from its own nodes to those of LGVI, the leapfrog is the same map, and what is left is its round-off. WHFast "
        "has the same order and a much smaller constant: it follows the orbits themselves exactly, and takes steps "
        "only for what disturbs them."
    )
    return Findings(nbody.possible(checks), [Picture("triple", figure, caption)])


CASE = Case(
    "triple",
    "Are the bodies of a triple, a spacecraft in it, and Pluto's moons where REBOUND's IAS15 has them as the step goes "
    "to zero, and is each step the same map as one of its leapfrog?",
    "REBOUND: IAS15, WHFast and leapfrog, given our G",
    run,
    needs=("rebound",),
)
