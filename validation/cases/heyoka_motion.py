"""Short arcs against heyoka: the paper's continuous equations (55)-(62), and its Lagrangian (15) alone.

Both are integrated in quadruple precision, so that what is seen is the package's error and not the oracle's.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods, systems
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import Difference, difference, of_bodies, snapshot_of
from validation.methods import Method

QUANTITIES = Difference._fields
UNITS = {"position": "of the distance", "velocity": "of the speed", "attitude": "rad", "spin": "of the spin"}


class Tolerances(NamedTuple):
    """Of the oracles' agreement, heyoka's own rounding, our limit of the step to zero, the orders, Runge-Kutta."""

    oracles: float
    rounding: float
    limit: float
    order: float
    runge_kutta: float


class Longer(NamedTuple):
    """A longer arc, on which only the limit of the step is looked at: its end [s], coarsest steps, and tolerance."""

    end: float
    fewest: int
    limit: float


class Arc(NamedTuple):
    """A system from its start to a time [s]; numbers of steps of the variational maps, each twice the one before."""

    system: ba.System
    state: ba.State
    end: float
    counts: Sequence[int]
    tolerances: Tolerances
    longer: dict[Effort, Longer]
    fast_primary: bool = False  # which spins about a principal axis, so that the law of its lead applies

    @property
    def steps(self) -> np.ndarray:
        """The steps [s]."""
        return self.end / np.array(self.counts)

    @property
    def rigid(self) -> np.ndarray:
        """Which bodies have an attitude."""
        return np.array([not body.is_point for body in self.system.bodies])


def truth(arc: Arc) -> tuple[Snapshot, list[Check]]:
    """Return where the bodies are at the end by heyoka, and how well the oracles agree."""
    from validation.oracles import taylor
    from validation.oracles.lagrangian import LagrangianMotion

    motion = LagrangianMotion(arc.system, arc.state)
    exact = motion.at(arc.end)
    if len(arc.system.bodies) > 2:
        rounded = difference(motion.at(arc.end, precise=False), exact).largest
        return taylor.floats(exact), [own_rounding(arc, "(15)", rounded)]
    from validation.oracles.relative_equations import RelativeEquations

    equations = RelativeEquations(arc.system, arc.state)
    printed = equations.at(arc.end)
    rounded = difference(equations.at(arc.end, precise=False), printed).largest
    agreement = Check(
        "the oracles: (55)-(62) minus Lagrangian (15), all quantities",
        difference(printed, exact).largest,
        arc.tolerances.oracles,
        "quadruple precision, 1e-34, times the growth of a perturbation along the arc",
        roundoff=True,
    )
    right_hand_side = Check(
        "the right-hand side of (55)-(62) at the start, ours minus heyoka's, in units of order one",
        equations.right_hand_side_error(arc.system, arc.state),
        2e-15,
        "rounding",
        roundoff=True,
    )
    return taylor.floats(printed), [agreement, own_rounding(arc, "(55)-(62)", rounded), right_hand_side]


def own_rounding(arc: Arc, numbers: str, error: float) -> Check:
    """Return the check of heyoka in double precision against itself."""
    what = f"heyoka's {numbers} in double minus in quadruple precision, all quantities"
    why = "rounding of heyoka's own: the truth here is taken in quadruple precision"
    return Check(what, error, arc.tolerances.rounding, why, roundoff=True)


def convergence(arc: Arc, method: Method, exact: Snapshot) -> list[Difference[np.ndarray]]:
    """Return the errors of a method, body by body, for each number of steps."""
    return [of_bodies(method.end(arc.system, arc.state, arc.end, count), exact) for count in arc.counts]


def having(arc: Arc, quantity: str) -> np.ndarray:
    """Return which bodies have a quantity: a point has no attitude and no spin."""
    return arc.rigid if quantity in ("attitude", "spin") else np.full_like(arc.rigid, True)


def orders(arc: Arc, errors: Sequence[Difference[np.ndarray]], tested: Method, *, headline: bool) -> Check:
    """Return the check of the order in every quantity of every body."""
    slopes = [
        methods.slope(arc.steps, of_body)
        for quantity, values in zip(QUANTITIES, zip(*errors, strict=True), strict=True)
        for of_body in np.array(values).T[having(arc, quantity)]
    ]
    worst = max(slopes, key=lambda slope: abs(slope - tested.order))
    return Check(
        f"{tested.name}: order of the error in position, velocity, attitude, spin of every body",
        abs(worst - tested.order),
        arc.tolerances.order,
        "the next even power of the step",
        shown=f"{min(slopes):.4f} to {max(slopes):.4f}",
        headline=headline,
    )


def attitude_law(arc: Arc, exact: Snapshot) -> Check:
    """Return the check of the primary's attitude, ahead about its spin, against Omega t (h Omega)^2/6."""
    end = methods.INERTIAL.end(arc.system, arc.state, arc.end, arc.counts[-1])
    turned = Rotation.from_matrix(exact.R[0].T @ end.R[0]).as_rotvec()
    measured = turned @ exact.Omega[0] / np.linalg.norm(exact.Omega[0])
    law = lead(arc, arc.steps[-1])
    return Check(
        "attitude of the primary ahead over the law Omega t (h Omega)²/6, minus 1",
        abs(measured / law - 1),
        1e-4,
        "what gravity does to the spin; the law's own next term, (h Omega)²",
        shown=f"{measured:+.6g} rad",
    )


def lead(arc: Arc, step: float) -> float:
    """Return by how much [rad] the discrete law says that the primary's attitude is ahead."""
    rate = float(np.linalg.norm(arc.state.si.spin[0]))
    return rate * arc.end * (step * rate) ** 2 / 6


def draw(name: str, arc: Arc, errors: Sequence[Difference[np.ndarray]]) -> Picture:
    """Return the errors of the production map against the step: position, attitude, spin of each body."""
    figure, panels = drawing.axes(3, xlabel="step [s]")
    for ax, quantity in zip(panels, ("position", "attitude", "spin"), strict=True):
        values = np.array([getattr(error, quantity) for error in errors])
        for i in np.flatnonzero(having(arc, quantity)):
            drawing.curve(ax, arc.steps, values[:, i], arc.system.names[i], i)
        drawing.slope_line(ax, arc.steps, (arc.steps[0], values[0].max() * 2), 2)
        if quantity == "attitude" and arc.fast_primary:
            of_law = [lead(arc, step) for step in arc.steps]
            ax.plot(arc.steps, of_law, ":", color="k", label="Omega t (h Omega)²/6")
        ax.set(title=f"{quantity} [{UNITS[quantity]}]", ylabel="error" if quantity == "position" else "")
        drawing.ticks(ax, arc.steps[:: 1 if len(arc.steps) < 6 else 2])
        drawing.legend(ax)
    caption = (
        f"Error of the variational map after {arc.end:g} s against the step, for each body: all fall with the square "
        "of the step, along the dashed line"
        + (
            "; the attitude of the fast primary lies on the law of the discrete spin, dotted."
            if arc.fast_primary
            else "."
        )
    )
    return Picture(name, figure, caption)


def run(name: str, arc: Callable[[], Arc], effort: Effort) -> Findings:
    """Run all methods of a system over its arc."""
    arc = arc()
    exact, checks = truth(arc)
    pair = len(arc.system.bodies) == 2
    tested = methods.OF_PAIRS if pair else methods.OF_BODIES
    of_production: list[Difference[np.ndarray]] = []
    for method in tested:
        errors = convergence(arc, method, exact)
        checks.append(orders(arc, errors, method, headline=name == "heyoka-tumbling" and method is methods.RELATIVE))
        of_production = errors if method is methods.INERTIAL else of_production
    for method in tested[:2] if pair else tested[:1]:
        end = methods.limit(method, arc.system, arc.state, arc.end, arc.counts)
        why = "rounding of the production steps, times the growth of a perturbation"
        what = f"{method.name}: limit of the step to zero, all quantities"
        error = difference(end, exact).largest
        checks.append(Check(what, error, arc.tolerances.limit, why, headline=method is methods.INERTIAL, roundoff=True))
    if arc.fast_primary:
        checks.append(attitude_law(arc, exact))
    if effort >= Effort.WHOLE:
        checks += [runge_kutta(arc, exact), taylor_series(arc, exact)]
    for needed, longer in arc.longer.items():
        if effort >= needed:
            checks += of_longer(arc, longer)
    return Findings(checks, [draw(name, arc, of_production)])


def runge_kutta(arc: Arc, exact: Snapshot) -> Check:
    """Return the check of SciPy's solver on the continuous equations (63)-(70), or (29)-(32)."""
    solver = ba.RungeKutta(rtol=2.3e-14, atol=2.3e-14)
    end = ba.propagate(arc.system, arc.state, duration=arc.end * u.s, integrator=solver)[-1]
    error = difference(snapshot_of(end), exact).largest
    why = "the solver's smallest tolerance, 2.3e-14 a step"
    return Check("RungeKutta at its tightest, all quantities", error, arc.tolerances.runge_kutta, why, roundoff=True)


def taylor_series(arc: Arc, exact: Snapshot) -> Check:
    """Return the check of the package's own use of heyoka, whose equations share nothing with the oracles'."""
    end = ba.propagate(arc.system, arc.state, duration=arc.end * u.s, integrator=ba.Taylor())[-1]
    error = difference(snapshot_of(end), exact).largest
    why = "rounding, times the growth of a perturbation"
    return Check("Taylor at 1e-16, all quantities", error, arc.tolerances.rounding, why, roundoff=True)


def of_longer(arc: Arc, longer: Longer) -> list[Check]:
    """Return the checks of the limit of the step to zero on a longer arc."""
    from validation.oracles import lagrangian, relative_equations, taylor

    pair = len(arc.system.bodies) == 2
    oracle = relative_equations.RelativeEquations if pair else lagrangian.LagrangianMotion
    exact = taylor.floats(oracle(arc.system, arc.state).at(longer.end))
    counts = [longer.fewest * 2**k for k in range(5)]
    return [
        Check(
            f"{method.name}: limit of the step to zero after {longer.end:.7g} s, all quantities",
            difference(methods.limit(method, arc.system, arc.state, longer.end, counts), exact).largest,
            longer.limit,
            "rounding of the production steps, times the growth of a perturbation",
            roundoff=True,
        )
        for method in (methods.OF_PAIRS[:2] if pair else methods.OF_BODIES[:1])
    ]


def dumbbells() -> Arc:
    """Return the paper's dumbbells (section 5), to t = 5, before their encounter; the thin axis magnifies round-off."""
    counts = (1000, 2000, 4000, 8000, 16000, 32000)
    longer = {Effort.WHOLE: Longer(15.0, 30_000, 2e-11)}  # through the encounter at t = 9
    return Arc(*ba.catalogue.load("dumbbells"), 5.0, counts, Tolerances(3e-29, 3e-13, 2e-14, 1e-3, 2e-9), longer)


def ellipsoids() -> Arc:
    """Return Didymos and Dimorphos at second degree, planar, for one orbit."""
    system = ba.System(ba.catalogue.load("didymos")[0].bodies, gravity=ba.SecondDegree())
    state = ba.State.circular_orbit(system, period=11.921473 * u.h, spins=[2.26 * u.h, "synchronous"])
    longer = {
        Effort.WHOLE: Longer(30 * 86400.0, 120_000, 8e-13),
        Effort.LONG: Longer(365.25 * 86400.0, 3_000_000, 4e-10),
    }
    return Arc(
        system, state, 12 * 3600.0, COUNTS, Tolerances(3e-31, 6e-14, 2e-14, 1e-2, 3e-12), longer, fast_primary=True
    )


def tumbling() -> Arc:
    """Return two triaxial bodies in full tumble, for ten hours."""
    longer = {Effort.WHOLE: Longer(100 * 3600.0, 36_000, 2e-13)}
    return Arc(*systems.tumbling_pair(), 10 * 3600.0, COUNTS, Tolerances(8e-32, 6e-14, 1.5e-14, 1e-3, 3e-12), longer)


def fourth_degree() -> Arc:
    """Return the tumbling pair with all moments to degree 4."""
    system, state = systems.tumbling_pair()
    system = ba.System(system.bodies, gravity=ba.Multipole(4))
    return Arc(system, state, 10 * 3600.0, COUNTS, Tolerances(8e-32, 6e-14, 1.5e-14, 1e-3, 3e-12), {})


def several() -> Arc:
    """Return two ellipsoids, a dumbbell and a point, for six hours."""
    longer = {Effort.WHOLE: Longer(60 * 3600.0, 7_200, 3e-13)}
    return Arc(*systems.four_bodies(), 6 * 3600.0, COUNTS, Tolerances(np.nan, 4e-14, 1e-14, 7e-4, 3e-12), longer)


COUNTS = (360, 720, 1440, 2880, 5760)
EQUATIONS = "heyoka: Taylor integration of (55)-(62) as printed, and of the Lagrangian (15), in quadruple precision"
QUESTIONS = {
    "heyoka-dumbbells": (
        dumbbells,
        "Do the paper's dumbbells move as its continuous equations and its Lagrangian say?",
    ),
    "heyoka-ellipsoids": (
        ellipsoids,
        "Do Didymos and Dimorphos, ellipsoids at second degree, move as the equations and the Lagrangian say?",
    ),
    "heyoka-tumbling": (
        tumbling,
        "Does a pair in full, non-planar tumble move as the continuous equations and the Lagrangian say?",
    ),
    "heyoka-fourth-degree": (
        fourth_degree,
        "Does it with all moments of both ellipsoids to degree 4?",
    ),
    "heyoka-four-bodies": (several, "Do four bodies of three kinds move as the Lagrangian (15) says?"),
}
CASES = tuple(
    Case(
        name,
        question,
        EQUATIONS if arc is not several else "heyoka: Taylor integration of the Lagrangian (15) in quadruple precision",
        partial(run, name, arc),
        ("heyoka",),
    )
    for name, (arc, question) in QUESTIONS.items()
)
