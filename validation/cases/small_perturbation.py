"""Kepler splittings of nearly round bodies: the orders that their names promise for what is small."""

from collections.abc import Sequence

import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation import drawing, methods, systems
from validation.case import Case, Check, Effort, Findings, Picture
from validation.cases.orders import errors

TIME = 10 * 3600.0
SHARES = (1.0, 1e-2, 1e-3, 1e-4)  # of the differences of the moments
SMALL = SHARES[1:]
METHODS = methods.of_family(ba.KeplerSplitting)
POSITION, ATTITUDE = (0, 1), (2, 1)  # of the secondary, in the errors of `errors_of`
COUNTS = (7, 10, 14, 20, 28, 40, 57, 80)


def truth(share: float) -> Snapshot:
    """Return where the bodies are at the end by heyoka."""
    from validation.oracles import taylor
    from validation.oracles.relative_equations import RelativeEquations

    return taylor.floats(RelativeEquations(*systems.nearly_round(share)).at(TIME))


def errors_of(name: str, share: float, exact: Snapshot, counts: Sequence[int]) -> np.ndarray:
    """Return the errors (numbers of steps, 4 quantities, bodies) of a scheme."""
    system, state = systems.nearly_round(share)
    return np.array([errors(METHODS[name].end(system, state, TIME, count), exact) for count in counts])


Found = dict[str, dict[float, np.ndarray]]  # errors by scheme and share


def by_share(found: Found, name: str, place: tuple[int, int], count: int, shares: Sequence[float]) -> float:
    """Return the power of the share with which an error grows, at a number of steps."""
    of_shares = [found[name][share][COUNTS.index(count)][place] for share in shares]
    return float(np.polyfit(np.log(shares), np.log(of_shares), 1)[0])


def by_step(found: Found, name: str, place: tuple[int, int], share: float, counts: Sequence[int]) -> float:
    """Return the power of the step with which an error falls, at a share."""
    of_counts = [found[name][share][COUNTS.index(count)][place] for count in counts]
    return -float(np.polyfit(np.log(counts), np.log(of_counts), 1)[0])


def checks_of(found: Found) -> list[Check]:
    """Return the checks of the powers of the share and of the step."""
    first, longest = "terms of the second order in the share", "long steps: the next powers of them"
    powers = [
        ("aba104", by_share(found, "aba104", ATTITUDE, 10, SMALL), "share, attitude, 10 steps", 2, 0.03, longest),
        ("aba864", by_share(found, "aba864", POSITION, 14, SMALL), "share, position, 14 steps", 1, 5e-3, first),
        ("aba1064", by_share(found, "aba1064", POSITION, 7, SMALL), "share, position, 7 steps", 1, 0.1, first),
        ("aba104", by_step(found, "aba104", POSITION, 1e-4, (7, 10, 14)), "step, position, share 1e-4", 10, 2, longest),
        ("aba864", by_step(found, "aba864", POSITION, 1e-2, (20, 28, 40)), "step, position, share 1e-2", 8, 1, longest),
        ("aba1064", by_step(found, "aba1064", POSITION, 1e-4, (7, 10)), "step, position, share 1e-4", 10, 2, longest),
    ]
    last = COUNTS[-4:]
    powers += [
        (name, by_step(found, name, ATTITUDE, 1.0, last), "step, attitude, all of the differences", 4, 0.05, longest)
        for name in METHODS
    ]
    return [
        Check(
            f"{name}: power of the {what}, minus {expected}",
            power - expected,
            tolerance,
            why,
            headline=expected != 4,
            roundoff=True,
        )
        for name, power, what, expected, tolerance, why in powers
    ]


def draw(found: Found) -> Picture:
    """Draw the errors of position and attitude, over the share, against the steps."""
    figure, panels = drawing.axes(3, xlabel="steps in 10 h, about one orbit", ylabel="error after 10 h over the share")
    for ax, (name, of_shares) in zip(panels, found.items(), strict=True):
        for k, (share, values) in enumerate(of_shares.items()):
            for place, line in ((POSITION, "-"), (ATTITUDE, ":")):
                column = values[:, *place]
                clear = column > 2e-14  # above round-off
                label = f"share {share:g}" if place == POSITION else "_"
                x, y = np.array(COUNTS)[clear], column[clear] / share
                ax.loglog(x, y, drawing.MARKERS[k] + line, color=drawing.COLOURS[k], ms=4, lw=1, label=label)
        orders = (8 if name == "aba864" else 10, 4)
        for order, through in zip(orders, ((14, 1.5e-7 if name == "aba864" else 1e-9), (40, 3e-7)), strict=True):
            drawing.slope_line(ax, (through[0] / 1.6, through[0] * 1.6), through, -order, f"slope {order}")
        drawing.ticks(ax, COUNTS)
        ax.set(title=name, ylim=(1e-12, 1e-3))
        drawing.legend(ax)
    caption = (
        "Errors of Kepler splittings over the share of the moments' differences that is left: position of the "
        "secondary, solid, and its attitude, dotted. Where the share is small, curves of position that lie on each "
        "other are of the first power of it, and fall with order 8 or 10; those of attitude by aba104 lie one power of "
        "the share below each other and fall with order 4. With all of the differences, blue, order 4 is what is left."
    )
    return Picture("small-perturbation", figure, caption)


def run(effort: Effort) -> Findings:
    """Measure the powers of the share and of the step."""
    exact = {share: truth(share) for share in SHARES}
    found = {name: {share: errors_of(name, share, exact[share], COUNTS) for share in SHARES} for name in METHODS}
    note = (
        "The tumbling pair with a share of the differences of its moments about their means. The kicks are then in "
        "proportion to the share, torques too, while Kepler motion with exact rotation is solved: errors are "
        "share h^10 + share^2 h^4 for ABA(10, 4), share h^8 + share^2 h^6 + share^3 h^4 for ABA(8, 6, 4). The whole "
        "differences of a real body are not small in this sense, and the last terms rule. They are small in another: "
        "at 20 steps an orbit the secondary's attitude is good to 4e-7 rad."
    )
    return Findings(checks_of(found), [draw(found)], [note])


CASE = Case(
    "small-perturbation",
    "Do Kepler splittings of nearly round bodies have the orders that their names promise?",
    "heyoka in quadruple precision: (55)-(62)",
    run,
    needs=("heyoka",),
)
