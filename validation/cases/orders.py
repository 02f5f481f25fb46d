"""Every scheme of every family: the order of its error in position, velocity, attitude and spin of every body.

The truth is heyoka's, in quadruple precision, so that a slope can be followed down to a few hundred roundings.
"""

import warnings
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods, systems
from validation.case import Case, Check, Effort, Findings, Picture
from validation.differences import Difference, turns
from validation.methods import Method

HOUR = 3600.0
LEAST = 1e-13  # an error below this has too much round-off in it to say anything about a slope
LINES, FILL = ("-", "--", ":"), (None, "white", None)  # of the families
FAMILIES = {"LGVI": ba.LGVI, "Splitting": ba.Splitting, "KeplerSplitting": ba.KeplerSplitting}


class Window(NamedTuple):
    """Numbers of steps in which the error falls as its order says, and by how much the slope may differ."""

    counts: Sequence[int]
    tolerance: float


class Arc(NamedTuple):
    """A system from its start to a time [s], and the windows of the schemes of each family."""

    name: str
    system: ba.System
    state: ba.State
    end: float
    windows: Mapping[str, Mapping[str, Window]]


OF_PAIR = {
    "LGVI": {
        "leapfrog": Window((640, 1280, 2560), 5e-3),
        "suzuki4": Window((320, 640, 1280), 0.05),
        "yoshida4": Window((640, 1280, 2560), 0.05),
        "kl6": Window((160, 226, 320), 0.1),
        "kl8": Window((80, 96, 113, 136), 0.2),
        "ss10": Window((72, 80, 90, 100), 0.2),
    },
    "Splitting": {
        "leapfrog": Window((640, 1280, 2560), 5e-4),
        "rkn4": Window((113, 160, 226), 0.15),
        "rkn6a": Window((28, 34, 40, 48), 0.2),
    },
    "KeplerSplitting": {
        "aba104": Window((56, 80, 113, 160), 0.1),
        "aba864": Window((90, 113, 136, 160), 0.2),
        "aba1064": Window((90, 113, 136, 160), 0.2),
    },
}
OF_COUPLED_PAIR = {
    "LGVI": {"kl8": Window((136, 160, 190, 226), 0.2), "ss10": Window((60, 64, 68, 72, 76, 80), 0.2)},
    "Splitting": {"ss10": Window((52, 56, 60, 64, 68), 0.2)},
}
OF_BODIES = {
    "LGVI": {"suzuki4": Window((226, 320, 453), 0.03), "kl6": Window((113, 136, 160), 0.1)},
    "Splitting": {"leapfrog": Window((720, 1440, 2880), 1.5e-4), "rkn6a": Window((14, 17, 20, 24), 0.2)},
}


def arcs() -> list[Arc]:
    """Return what is looked at."""
    return [
        Arc("tumbling pair", *systems.tumbling_pair(), 10 * HOUR, OF_PAIR),
        Arc("coupled pair", *systems.coupled_pair(), 20 * HOUR, OF_COUPLED_PAIR),
        Arc("four bodies", *systems.four_bodies(), 6 * HOUR, OF_BODIES),
    ]


def truth(arc: Arc) -> Snapshot:
    """Return where the bodies are at the end by heyoka."""
    from validation.oracles import lagrangian, relative_equations, taylor

    pair = len(arc.system.bodies) == 2
    oracle = relative_equations.RelativeEquations if pair else lagrangian.LagrangianMotion
    return taylor.floats(oracle(arc.system, arc.state).at(arc.end))


def errors(one: Snapshot, two: Snapshot) -> Difference[np.ndarray]:
    """Return the errors of each body, against its own distance from the barycentre, its own speed and spin."""
    position, velocity, spin = (
        np.linalg.norm(a - b, axis=1) / np.maximum(np.linalg.norm(b, axis=1), np.finfo(float).tiny)
        for a, b in ((one.x, two.x), (one.v, two.v), (one.Omega, two.Omega))
    )
    return Difference(position, velocity, turns(one.R, two.R), spin)


def of_counts(arc: Arc, method: Method, exact: Snapshot, counts: Sequence[int]) -> np.ndarray:
    """Return the errors (numbers of steps, 4 quantities, bodies) of a method."""
    return np.array([errors(method.end(arc.system, arc.state, arc.end, count), exact) for count in counts])


def slopes(counts: Sequence[int], found: np.ndarray) -> np.ndarray:
    """Return the slopes of every quantity of every body that has three errors or more which are not round-off."""
    result = []
    for column in found.reshape(len(counts), -1).T:
        clear = column > LEAST
        if clear.sum() >= 3:
            result.append(-np.polyfit(np.log(counts)[clear], np.log(column[clear]), 1)[0])
    return np.array(result)


def check_order(arc: Arc, method: Method, window: Window, exact: Snapshot, *, headline: bool) -> Check:
    """Return the check of a method's order in all quantities of all bodies."""
    found = of_counts(arc, method, exact, window.counts)
    each = slopes(window.counts, found)
    quantities = sum(2 if body.is_point else 4 for body in arc.system.bodies)
    return Check(
        f"{arc.name}, {method.name}: slope minus {method.order}, the largest of every quantity and body",
        float(np.abs(each - method.order).max()) if each.size else np.nan,
        window.tolerance,
        "the next power of the step, and round-off in the smallest errors",
        shown="" if headline else f"{each.min():.3f} to {each.max():.3f} in {each.size} of {quantities} quantities",
        headline=headline,
        roundoff=True,
    )


def of_frame(family: str, frame: str) -> Mapping[str, Method]:
    """Return the methods of a family by their schemes; Kepler splittings have one frame only."""
    choices = {} if family == "KeplerSplitting" else {"frame": frame}
    return methods.of_family(FAMILIES[family], **choices)


def of_arc(arc: Arc, exact: Snapshot) -> list[Check]:
    """Return the checks of all methods of an arc, of a pair in both frames where a family has them."""
    frames = ("relative", "inertial") if len(arc.system.bodies) == 2 else ("inertial",)
    return [
        check_order(arc, of_frame(family, frame)[name], window, exact, headline=frame == frames[0])
        for family, windows in arc.windows.items()
        for frame in (frames[:1] if family == "KeplerSplitting" else frames)
        for name, window in windows.items()
    ]


def work(arc: Arc, exact: Snapshot) -> Picture:
    """Draw the errors of every scheme against its evaluations of gravity."""
    figure, panels = drawing.axes(3, xlabel="evaluations of gravity in 10 h")
    places = {"position of both": (0, 0), "attitude of the fast primary": (2, 0), "attitude of the secondary": (2, 1)}
    drawn = {**OF_PAIR, "Splitting": {**OF_PAIR["Splitting"], "ss10": Window((20, 22, 24), 1)}}
    for k, (family, windows) in enumerate(drawn.items()):
        for j, (name, window) in enumerate(windows.items()):
            method = of_frame(family, "relative")[name]
            first, last = window.counts[0] / 4, window.counts[-1] * 1.5
            counts = np.unique(np.geomspace(first, last, 10).astype(int))
            found = of_counts(arc, method, exact, counts)
            for ax, place in zip(panels, places.values(), strict=True):
                clear = found[:, *place] > 1e-15
                line = LINES[k] + drawing.MARKERS[j]
                label = f"{family} {name}"
                x, y = counts[clear] * method.stages, found[:, *place][clear]
                ax.loglog(x, y, line, color=drawing.COLOURS[k], ms=4, lw=1, label=label, mfc=FILL[k])
                if family == "LGVI" and ax is panels[1]:
                    half = len(x) // 2
                    drawing.slope_line(ax, (x[half] / 1.5, x[half] * 4), (x[half], y[half] / 2), -method.order, "_")
    for ax, title in zip(panels, places, strict=True):
        ax.set(title=f"{title} [rad]" if "attitude" in title else f"{title}, relative", ylim=(1e-15, 1))
    panels[0].set_ylabel("error after 10 h")
    panels[2].legend(frameon=False, fontsize=8, loc="center left", bbox_to_anchor=(1.02, 0.5))
    figure.set_size_inches(16, 4.6)
    caption = (
        "Error of every scheme on the tumbling pair against what it costs. Compositions of the variational step, blue, "
        "pay for the primary's spin in its attitude; the splittings, red and green, turn a free body exactly: what is "
        "left is due to gravity. Dashed: slopes 2, 4, 6, 8 and 10."
    )
    return Picture("orders", figure, caption)


def run(effort: Effort) -> Findings:
    """Measure all slopes."""
    checks, pictures = [], []
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.GravityWarning)  # the oracle's gravity ends where ours does
        for arc in arcs():
            exact = truth(arc)
            checks += of_arc(arc, exact)
            if not pictures:
                pictures.append(work(arc, exact))
    notes = [
        "A slope is fitted through the errors above 1e-13, those with few roundings in them, of each quantity that has "
        "three or more such errors. The exact rotor leaves so little error in the fast primary's attitude that "
        "round-off takes over early. The splitting of order 10 comes down to round-off while its steps on the tumbling "
        "pair are still too long for a law, so it is measured on the coupled pair, of longer bodies that are nearer to "
        "each other.",
        "Kepler splittings are of order 4 as the step goes to zero, whatever their names promise: those orders are for "
        "a perturbation that is small in all that it does. The torque on a body is as small as the differences of its "
        "moments, but it has nothing to be small beside: a body that librates does so because of it. The case "
        "small-perturbation shows the promised orders where the bodies are nearly round.",
    ]
    return Findings(checks, pictures, notes)


CASE = Case(
    "orders",
    "Does the error of every scheme of every family fall with the power of the step that it declares?",
    "heyoka in quadruple precision: (55)-(62) for pairs, the Lagrangian (15) for four bodies",
    run,
    needs=("heyoka",),
)
