"""A flyby of the Earth, so near that its tide moves the bodies by their own distance and turns them.

The oracle is given the hyperbola at its closest point and follows the Earth back from there, with Newton's equation.
"""

import warnings
from collections.abc import Mapping
from dataclasses import replace

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import drawing, systems
from validation.case import Case, Check, Effort, Findings, Picture
from validation.cases import orders
from validation.cases.orders import Window
from validation.differences import difference, snapshot_of

EARTH = 398600.4355 * u.km**3 / u.s**2
ANGLES = (40 * u.deg, 110 * u.deg, 65 * u.deg)
NEAR = ba.Flyby(EARTH, 30000 * u.km, 8 * u.km / u.s, 5 * u.h, *ANGLES, radius=6378 * u.km)
WINDOWS: Mapping[str, Mapping[str, Window]] = {
    "LGVI": orders.OF_PAIR["LGVI"],
    "Splitting": {
        "leapfrog": Window((640, 1280, 2560), 3e-4),
        "rkn4": Window((160, 226, 320), 0.15),
        "rkn6a": Window((40, 48, 56, 68), 0.05),
    },
    "KeplerSplitting": {
        "aba104": Window((56, 80, 113, 160), 0.02),
        "aba864": Window((113, 160, 226), 0.3),
        "aba1064": Window((90, 113, 136, 160), 0.3),
    },
}


def arc() -> orders.Arc:
    """Return the tumbling pair, which the Earth comes near to in the middle of ten hours."""
    given, state = systems.tumbling_pair()
    system = ba.System(given.bodies, gravity=ba.SecondDegree(), perturbations=[NEAR])
    return orders.Arc("tumbling pair", system, state, 10 * orders.HOUR, WINDOWS)


def splitting(step: float) -> ba.Splitting:
    """Return the splitting of order 10."""
    return ba.Splitting(step * u.s, scheme="ss10")


def of_limit(arc: orders.Arc, exact: object) -> list[Check]:
    """Compare the end of the arc, and say what the flyby does."""
    run = ba.propagate(arc.system, arc.state, duration=arc.end * u.s, integrator=splitting(200))
    return [
        Check(
            "tumbling pair, 10 h: all quantities of both bodies",
            difference(snapshot_of(run[-1]), exact).largest,
            1e-14,
            "rounding",
            headline=True,
            roundoff=True,
        ),
        Check(
            "tumbling pair, 10 h: energy less the work done, over |E0|, the largest error",
            run.max_relative_energy_error,
            4e-15,
            "rounding; the error of the method is far below it",
            roundoff=True,
        ),
        Check(
            "tumbling pair, 10 h: angular momentum less what was given, the largest error",
            run.max_relative_angular_momentum_error,
            3e-15,
            "rounding",
            roundoff=True,
        ),
    ]


def far_away() -> Check:
    """Compare a pair that starts when the planet is still 6.5 million km away, and that it passes at 12 000 km."""
    from validation.oracles import outside

    system, state = systems.tumbling_pair()
    flyby = ba.Flyby(EARTH, 12000 * u.km, 15 * u.km / u.s, 5 * u.day, *ANGLES, radius=6378 * u.km)
    system = ba.System(system.bodies, gravity=ba.SecondDegree(), perturbations=[flyby])
    exact = outside.OutsideMotion(system, state, [outside.distant_of(flyby, system)]).at(5.1 * 86400)
    end = ba.propagate(system, state, duration=5.1 * u.day, integrator=splitting(100))[-1]
    return Check(
        "tumbling pair, from 6.5 million km to 2.4 h past 12 000 km: all quantities",
        difference(snapshot_of(end), exact).largest,
        1e-12,
        "rounding, times the growth of a perturbation",
        roundoff=True,
    )


def draw(arc: orders.Arc) -> Picture:
    """Draw separation and tilt of both bodies with and without the flyby."""
    figure, panels = drawing.axes(2, xlabel="time [h]")
    alone = ba.System(arc.system.bodies, gravity=ba.SecondDegree())
    for index, (name, system) in enumerate((("with the Earth", arc.system), ("alone", alone))):
        run = ba.propagate(system, arc.state, duration=2 * arc.end * u.s, integrator=splitting(100))
        hours = run.si.time / orders.HOUR
        apart = run.si.position[:, 1] - run.si.position[:, 0]
        panels[0].plot(hours, np.linalg.norm(apart, axis=1), color=drawing.COLOURS[index], label=name)
        panels[1].plot(hours, np.linalg.norm(run.si.spin[:, 1], axis=1), color=drawing.COLOURS[index], label=name)
    for ax, title in zip(panels, ("distance of the bodies [m]", "spin of the secondary [rad/s]"), strict=True):
        ax.axvline(NEAR.time.to_value("h"), color="k", lw=0.6, ls=":")
        ax.set_title(title)
        drawing.legend(ax)
    return Picture("flyby", figure, "The tumbling pair with the Earth, which is nearest at the dotted line, and alone.")


def run(effort: Effort) -> Findings:
    """Compare with the equations of rigid bodies, and measure every order."""
    from validation.oracles import outside

    near = arc()
    distant = outside.distant_of(NEAR, near.system)
    exact = outside.OutsideMotion(near.system, near.state, [distant]).at(near.end)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.GravityWarning)  # the oracle's gravity ends where ours does
        checks = of_limit(near, exact)
        checks += [replace(check, headline="kl8, relative" in check.what) for check in orders.of_arc(near, exact)]
        if effort >= Effort.WHOLE:
            checks.append(far_away())
        pictures = [draw(near)]
    return Findings(checks, pictures)


CASE = Case(
    "flyby",
    "Do two tumbling bodies move and turn as they should when the Earth passes at 30 000 km, and is every order kept?",
    "heyoka in quadruple precision: rigid bodies and the Earth by plain differences",
    run,
    needs=("heyoka",),
)
