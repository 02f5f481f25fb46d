"""The Sun: a pair of Didymos's kind on its way round it, as points and as bodies that turn.

The points are beside heyoka's own n-body model of three masses, where nothing says that the Sun is far away; the bodies
beside equations with every derivative taken by heyoka. Both are in quadruple precision.
"""

from dataclasses import replace
from typing import NamedTuple

import astropy.units as u
import numpy as np

import binaryast as ba
from binaryast.integrators import Stepping
from validation import drawing, systems
from validation.case import Case, Check, Effort, Findings, Picture
from validation.cases import orders
from validation.differences import difference, snapshot_of

DAY = 86400.0
ORBIT = ba.Orbit(1.6442 * u.au, 0.38385, 3 * u.deg, 70 * u.deg, 40 * u.deg, true_anomaly=10 * u.deg)
SUN = ba.Sun(ORBIT)
PERIOD = 770.0703333 * DAY  # of that orbit
METHODS = {
    "Splitting ss10": ba.Splitting(750 * u.s, scheme="ss10"),
    "KeplerSplitting aba864": ba.KeplerSplitting(1800 * u.s),
}
ROUNDING = "rounding: it changes from method to method and hardly with the step"


class Tolerances(NamedTuple):
    """Of both methods of `METHODS`, against three bodies in quadruple precision."""

    splitting: float
    kepler_splitting: float


def points(perturbation: ba.Sun | ba.ThirdBody = SUN) -> tuple[ba.System, ba.State]:
    """Return points with the masses of Didymos and Dimorphos, on a retrograde orbit that is not round."""
    given, _ = ba.catalogue.load("didymos")
    bodies = [ba.RigidBody(body.name, ba.Point(), gm=body.gm) for body in given.bodies]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=[perturbation])
    state = ba.State.from_elements(
        system, semi_major_axis=1190 * u.m, eccentricity=0.03, inclination=165 * u.deg, spins=[None, None]
    )
    return system, state


def end_of(system: ba.System, state: ba.State, time: float, integrator: Stepping) -> np.ndarray:
    """Return the secondary's place from the primary at the end of a run [m]."""
    position = ba.propagate(system, state, duration=time * u.s, integrator=integrator).si.position[-1]
    return np.asarray(position[1] - position[0])


def relative(one: np.ndarray, two: np.ndarray) -> float:
    """Return a difference over the size of the second."""
    return float(np.linalg.norm(one - two) / np.linalg.norm(two))


def of_points(time: float, name: str, tolerances: Tolerances, *, headline: bool) -> list[Check]:
    """Compare the pair after a time with that of three bodies in quadruple precision."""
    from validation.oracles import outside, three_bodies

    system, state = points()
    exact = three_bodies.by_heyoka(system, state, outside.distant_of(SUN, system), time)
    return [
        Check(
            f"points, {name}, {method}: place of the secondary from the primary, over their distance",
            relative(end_of(system, state, time, integrator), exact),
            tolerance,
            ROUNDING,
            headline=headline,
            roundoff=True,
        )
        for (method, integrator), tolerance in zip(METHODS.items(), tolerances, strict=True)
    ]


def size_of_the_tide(time: float) -> str:
    """Say what the Sun does to the points in a time."""
    system, state = points()
    alone = ba.System(system.bodies, gravity=system.gravity)
    integrator = METHODS["Splitting ss10"]
    moved = relative(end_of(system, state, time, integrator), end_of(alone, state, time, integrator))
    return f"Within one orbit about it, {time / DAY:.0f} d, the Sun moves the secondary by {moved:.2g} of the distance."


def of_rebound() -> Check:
    """Compare the pair after 10 days with IAS15, which is given three bodies in SI."""
    from validation.oracles import outside, three_bodies

    system, state = points()
    end = three_bodies.by_ias15(system, state, outside.distant_of(SUN, system), 10 * DAY)
    return Check(
        "points, 10 d: place of the secondary from the primary minus that of REBOUND's IAS15, over their distance",
        relative(end_of(system, state, 10 * DAY, METHODS["Splitting ss10"]), end),
        1e-5,
        "IAS15's: in double precision places far from the Sun are known to 3e-5 m, and it moves them at each step",
        headline=True,
        roundoff=True,
    )


def of_table() -> Check:
    """Compare the Sun on its ellipse with the same places in a table."""
    from validation.oracles import outside
    from validation.oracles.taylor import REAL

    system, _ = points()
    distant = outside.distant_of(SUN, system)
    times = np.linspace(0.0, 20 * DAY, 401)
    places = outside.path(distant, times.astype(REAL)).astype(float)
    table = ba.ThirdBody(SUN.gm_si * u.m**3 / u.s**2, times * u.s, places * u.m)
    ends = [end_of(*points(mass), 20 * DAY, METHODS["Splitting ss10"]) for mass in (SUN, table)]
    return Check(
        "points, 20 d: the Sun on its ellipse minus that of a table with 401 rows by heyoka",
        relative(*ends),
        1e-12,
        "rounding of the table's places, 3e-5 m, and the spline",
        roundoff=True,
    )


def tumbling(*, first_term_only: bool = False) -> tuple[ba.System, ba.State]:
    """Return two bodies in full tumble, attracted by the Sun too."""
    given, state = systems.tumbling_pair()
    sun = ba.Sun(ORBIT, first_term_only=first_term_only)
    return ba.System(given.bodies, gravity=ba.SecondDegree(), perturbations=[sun]), state


def of_bodies() -> list[Check]:
    """Compare bodies that tumble, for ten hours, with the equations of rigid bodies, and measure every order."""
    from validation.oracles import outside

    checks = []
    for first_term_only, name in ((False, "whole tide"), (True, "first term of the tide alone")):
        system, state = tumbling(first_term_only=first_term_only)
        arc = orders.Arc("tumbling pair with the Sun", system, state, 10 * orders.HOUR, orders.OF_PAIR)
        (sun,) = system.perturbations
        motion = outside.OutsideMotion(system, state, [outside.distant_of(sun, system)])
        exact = motion.at(arc.end)
        end = ba.propagate(system, state, duration=arc.end * u.s, integrator=ba.Splitting(200 * u.s, scheme="ss10"))[-1]
        error = difference(snapshot_of(end), exact).largest
        what = f"tumbling pair, 10 h, {name}: all quantities"
        checks.append(Check(what, error, 1e-14, "rounding", headline=not first_term_only, roundoff=True))
        if not first_term_only:
            checks += [replace(check, headline="kl8, relative" in check.what) for check in orders.of_arc(arc, exact)]
    return checks


def draw() -> Picture:
    """Draw what the Sun does to the points, and the error of both methods, against time."""
    from validation.oracles import outside, three_bodies

    system, state = points()
    alone = ba.System(system.bodies, gravity=system.gravity)
    distant = outside.distant_of(SUN, system)
    days = np.array([2.0, 5.0, 10.0, 20.0, 50.0, 100.0])
    exact = [three_bodies.by_heyoka(system, state, distant, day * DAY) for day in days]
    figure, (ax,) = drawing.axes(1, xlabel="time [d]", ylabel="over the distance")
    for index, (name, integrator) in enumerate(METHODS.items()):
        errors = [
            relative(end_of(system, state, day * DAY, integrator), place)
            for day, place in zip(days, exact, strict=True)
        ]
        drawing.curve(ax, days, errors, name, index)
    without = [
        relative(end_of(alone, state, day * DAY, METHODS["Splitting ss10"]), place)
        for day, place in zip(days, exact, strict=True)
    ]
    drawing.curve(ax, days, without, "without the Sun", 2)
    drawing.legend(ax)
    caption = (
        "Error of the secondary's place beside three bodies in quadruple precision, and what it is without the Sun."
    )
    return Picture("sun", figure, caption)


def run(effort: Effort) -> Findings:
    """Compare points and bodies with both oracles."""
    checks = [
        *of_points(20 * DAY, "20 d", Tolerances(1e-12, 2e-12), headline=True),
        of_rebound(),
        of_table(),
        *of_bodies(),
    ]
    notes, pictures = [], []
    if effort >= Effort.WHOLE:
        checks += of_points(PERIOD, "one orbit about the Sun", Tolerances(3e-10, 4e-10), headline=False)
        notes.append(size_of_the_tide(PERIOD))
        pictures.append(draw())
    return Findings(checks, pictures, notes)


CASE = Case(
    "sun",
    "Does a pair move as three bodies do, do its bodies turn as the Sun has them turn, and is every order kept?",
    "heyoka in quadruple precision, three masses and rigid bodies by plain differences; REBOUND's IAS15",
    run,
    needs=("heyoka", "rebound"),
)
