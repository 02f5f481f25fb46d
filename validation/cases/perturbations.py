"""All that GUBAS has beside gravity, at once, with the variational integrator: Sun, flyby, Hill's tide, tidal torque.

Didymos and Dimorphos at second degree, the former's pole tilted: Earth flies by, the Sun pulls, and Didymos, with a
Love number far too large, is raised by Dimorphos.
"""

from typing import Any

import astropy.units as u

import binaryast as ba
from validation import methods, systems
from validation.case import Case, Check, Effort, Findings
from validation.cases.flyby import ANGLES, EARTH
from validation.cases.sun import ORBIT
from validation.differences import difference, snapshot_of

DAY = 86400.0
LOVE, LAG, RADIUS = 0.05, 60.0, 400.0  # 1, s, m
FLYBY = ba.Flyby(EARTH, 60000 * u.km, 9 * u.km / u.s, 12 * u.h, *ANGLES)
TIDE = ba.TidalTorque("Didymos", "Dimorphos", LOVE, time_lag=LAG * u.s, radius=RADIUS * u.m)
STEPS = (80.0, 40.0, 20.0)


def setting(*, hill: bool) -> tuple[ba.System, ba.State]:
    """Return the pair with the Sun, by all of its tide or by its first term, the Earth, and the tidal torque."""
    given, state = systems.wobbling_pair()
    acting = [ba.Sun(ORBIT, first_term_only=hill), FLYBY, TIDE]
    return ba.System(given.bodies, gravity=ba.SecondDegree(), perturbations=acting), state


def exact_end(system: ba.System, state: ba.State) -> Any:
    """Return where the bodies are after a day by heyoka."""
    from validation.oracles import outside, tides

    distant = [outside.distant_of(one, system) for one in system.perturbations[:2]]
    force = tides.time_lag(0, 1, LOVE, LAG, RADIUS, system.bodies[1].si.mass)
    return outside.OutsideMotion(system, state, distant, [force]).at(DAY)


def of_set(*, hill: bool) -> list[Check]:
    """Compare a day with heyoka's, in the limit of the step to zero, and look at what is balanced."""
    system, state = setting(hill=hill)
    exact = exact_end(system, state)
    name = "Sun by Hill's tide" if hill else "Sun"
    runs = [ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(h * u.s)) for h in STEPS]
    errors = [difference(snapshot_of(run[-1]), exact).largest for run in runs]
    limit = methods.limit(methods.RELATIVE, system, state, DAY, [1080 * 2**k for k in range(5)])
    balances = [run.max_relative_energy_error for run in runs]
    kept = max(run.max_relative_angular_momentum_error for run in runs)
    what = f"{name}, flyby, tidal torque"
    return [
        Check(
            f"{what}, a day: limit of the step of LGVI to zero, all quantities",
            difference(limit, exact).largest,
            5e-14,
            "rounding",
            headline=True,
            roundoff=True,
        ),
        Check(
            f"{what}: order of the largest error, minus 2",
            methods.slope(STEPS, errors) - 2,
            1e-2,
            "the next power of the step",
            shown=f"{errors[-1]:.2g} in steps of {STEPS[-1]:g} s",
        ),
        Check(
            f"{what}: energy less the work done, power of the step, minus 2",
            methods.slope(STEPS, balances) - 2,
            1e-2,
            "the next power of the step",
            shown=f"{balances[-1]:.2g} of |E0| in steps of {STEPS[-1]:g} s",
        ),
        Check(
            f"{what}: angular momentum less what was given",
            kept,
            1e-14,
            "rounding",
            roundoff=True,
        ),
    ]


def run(effort: Effort) -> Findings:
    """Run both sets."""
    return Findings([check for hill in (False, True) for check in of_set(hill=hill)])


CASE = Case(
    "perturbations",
    "Does the variational integrator run with all of GUBAS's perturbations at once, and is what they give balanced?",
    "heyoka in quadruple precision: plain differences, the potential of a lagging bulge",
    run,
    needs=("heyoka",),
)
