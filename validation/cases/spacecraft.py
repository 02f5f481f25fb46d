"""A rigid spacecraft about Didymos and Dimorphos: three full bodies, of which one has a hundred-billionth of the mass.

It is a box of 1.6 x 1.6 x 1.7 m that wobbles, on a circle of 5 km high above the orbit of Dimorphos. That orbit is not
chaotic: a disturbance grows eightfold in ten days, which the oracle's digits and ours survive.
"""

from collections.abc import Sequence
from typing import Any

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import methods
from validation.case import Case, Check, Effort, Findings
from validation.cases.sun import SUN
from validation.differences import Difference, of_bodies, snapshot_of

DAY = 86400.0
STEP = 300 * u.s
SIZE = np.array([1.6, 1.6, 1.7])  # m
SPIN = [1e-4, -5e-5, 2e-3]  # rad/s
LIGHTEST = 5.2  # kg: 1e-11 of Didymos
AREA, COEFFICIENT, MIRRORED, SCATTERED = 14.0, 1.3, 0.2, 0.3
NORMAL, POINT = np.array([0.0, 0.0, 1.0]), np.array([0.002, 0.001, 0.5])
QUANTITIES = "place, velocity, attitude and spin of all three bodies"


def setting(
    mass: float, *, pulls: bool = True, perturbations: Sequence[Any] = (), to_sun: np.ndarray | None = None
) -> tuple[ba.System, ba.State]:
    """Return both bodies and a craft of a mass [kg]; ``to_sun`` is about where its long axis points."""
    given, start = ba.catalogue.load("didymos")
    moments = mass / 12 * ((SIZE**2).sum() - SIZE**2)
    box = ba.Ellipsoid(*(SIZE / 2 * u.m))
    craft = ba.RigidBody("craft", box, mass=mass * u.kg, inertia=moments * u.kg * u.m**2, pulls=pulls)
    place = 5000 * np.array([0.3, -0.5, np.sqrt(0.66)])
    across = np.cross([0.2, 1.0, 0.1], place)
    speed = np.sqrt(sum(body.si.gm for body in given.bodies) / 5000)
    attitude = np.eye(3)
    if to_sun is not None:
        z = to_sun / np.linalg.norm(to_sun) + 0.5 * place / 5000
        x = np.cross(z, [1.0, 2.0, 3.0])
        attitude = np.stack([a / np.linalg.norm(a) for a in (x, np.cross(z, x), z)], axis=1)
    state = ba.State(
        np.vstack([start.si.position, place]) * u.m,
        np.vstack([start.si.velocity, speed * across / np.linalg.norm(across)]) * u.m / u.s,
        [*start.si.attitude, attitude],
        np.vstack([start.si.spin, SPIN]) * u.rad / u.s,
    )
    system = ba.System([*given.bodies, craft], gravity=ba.SecondDegree(), perturbations=list(perturbations))
    return system, state


def end_of(system: ba.System, state: ba.State, time: float) -> ba.State:
    """Return the end of a run."""
    return ba.propagate(system, state, duration=time * u.s, integrator=ba.Splitting(STEP, scheme="ss10"))[-1]


def errors(system: ba.System, state: ba.State, time: float, forces: Sequence[Any] = ()) -> Difference[np.ndarray]:
    """Return the errors of all bodies after a time."""
    from validation.oracles import outside

    distant = [outside.distant_of(SUN, system)] if forces else []
    exact = outside.OutsideMotion(system, state, distant, forces).at(time)
    return of_bodies(snapshot_of(end_of(system, state, time)), exact)


def of_mass(mass: float, time: float, tolerance: float, *, pulls: bool = True, headline: bool = False) -> Check:
    """Compare all three bodies with the oracle's."""
    name = f"craft of {mass:g} kg{'' if pulls else ' that does not pull'}"
    return Check(
        f"{name}, {time / DAY:g} d: {QUANTITIES}",
        errors(*setting(mass, pulls=pulls), time).largest,
        tolerance,
        "rounding, most in the attitude of the craft",
        headline=headline,
        roundoff=True,
    )


def of_light_ones() -> list[Check]:
    """See what a craft does by its own mass: in proportion to it, down to that which does nothing."""
    masses = np.array([1e4, 1e3, 1e2, 10.0, LIGHTEST])
    system, state = setting(LIGHTEST, pulls=False)
    felt = end_of(system, state, DAY)
    ends = [end_of(*setting(mass), DAY) for mass in masses]
    moved = np.array([np.linalg.norm(end.si.position[2] - felt.si.position[2]) for end in ends]) / 5000
    # less the part in proportion, known from the heaviest
    change = (ends[0].si.position[2] - felt.si.position[2]) * LIGHTEST / masses[0]
    rest = np.linalg.norm(ends[-1].si.position[2] - felt.si.position[2] - change) / 5000
    return [
        Check(
            "place of crafts of 1e4 to 5.2 kg after a day minus that of one that does not pull: power of the mass, - 1",
            methods.slope(masses, moved) - 1,
            1e-3,
            "rounding of the lightest: 1e-15 beside 1e-12",
            shown=f"{moved[0]:.2g} to {moved[-1]:.2g} of the distance",
            headline=True,
            roundoff=True,
        ),
        Check(
            "the same of 5.2 kg, less what is in proportion: over the distance",
            float(rest),
            1e-14,
            "rounding: nothing is lost by the mass ratio of 1e-11",
            roundoff=True,
        ),
    ]


def of_sunlight(time: float, tolerance: float, *, headline: bool) -> Check:
    """Compare a craft that sunlight pushes as a ball, and turns by a plate off its mass centre, with the Sun's tide."""
    from validation.oracles import outside, sunlight

    to_sun = outside.distant_of(SUN, setting(500.0)[0]).x
    ball = ba.RadiationPressure("craft", SUN, area=AREA * u.m**2, coefficient=COEFFICIENT)
    plate = ba.RadiationPressure(
        "craft",
        SUN,
        area=AREA * u.m**2,
        normal=NORMAL,
        specular=MIRRORED,
        diffuse=SCATTERED,
        point=POINT * u.m,
    )
    system, state = setting(500.0, perturbations=[SUN, ball, plate], to_sun=to_sun)
    forces = [
        sunlight.ball(2, 0, AREA, COEFFICIENT),
        sunlight.plate(2, 0, AREA, NORMAL, MIRRORED, SCATTERED, POINT),
    ]
    alone = ba.System(system.bodies, gravity=system.gravity)
    difference = of_bodies(*(snapshot_of(end_of(one, state, time)) for one in (alone, system)))
    return Check(
        f"craft of 500 kg in sunlight, ball and plate, and the Sun, {time / DAY:g} d: {QUANTITIES}",
        errors(system, state, time, forces).largest,
        tolerance,
        "rounding, most in the attitude of the craft",
        shown=f"moved by {difference.position[2]:.2g} of the distance, turned by {difference.attitude[2]:.2g} rad",
        headline=headline,
        roundoff=True,
    )


def run(effort: Effort) -> Findings:
    """Compare crafts of all masses, with and without sunlight."""
    checks = [
        of_mass(LIGHTEST, DAY / 2, 1e-13, headline=True),
        of_mass(LIGHTEST, DAY / 2, 1e-13, pulls=False),
        *of_light_ones(),
        of_sunlight(DAY / 2, 1e-13, headline=True),
    ]
    if effort >= Effort.WHOLE:
        checks += [
            of_mass(LIGHTEST, 10 * DAY, 2e-12),
            of_sunlight(10 * DAY, 2e-12, headline=False),
        ]
    return Findings(checks)


CASE = Case(
    "spacecraft",
    "Does a rigid spacecraft move and turn in the field of Didymos and Dimorphos as it should, however light it is?",
    "heyoka in quadruple precision: three rigid bodies, the Sun, and light photon by photon",
    run,
    needs=("heyoka",),
)
