"""Work-precision diagrams: CPU time against error, position and everything beside each other."""

from collections.abc import Sequence

from matplotlib.figure import Figure

from validation.benchmark.measure import Point, front
from validation.benchmark.tables import Result, kinds_of
from validation.drawing import COLOURS, MARKERS

FAMILIES = {"ours": 0, "heyoka": 1, "REBOUND": 2, "SciPy": 3}


def panel(ax: object, points: Sequence[Point], kind: str) -> None:
    """Draw the front of each method of each family."""
    counts: dict[str, int] = {}
    for family, method in dict.fromkeys((point.family, point.method) for point in points):
        line = front((getattr(p, kind), p.seconds) for p in points if (p.family, p.method) == (family, method))
        line = [point for point in line if 1e-14 < point[0] < 10]
        number = counts[family] = counts.get(family, -1) + 1
        colour, marker = COLOURS[FAMILIES[family]], MARKERS[number % len(MARKERS)]
        style = "-" if number < len(MARKERS) else "--"
        x, y = [error for error, _ in line], [1e3 * seconds for _, seconds in line]
        label = f"{family}: {method}"
        ax.loglog(x, y, marker + style, color=colour, label=label, ms=4, lw=0.9, alpha=0.9)  # type: ignore[attr-defined]


def diagram(result: Result) -> Figure:
    """Return the figure of one problem."""
    kinds = kinds_of(result.problem)
    figure = Figure(figsize=(4.4 * len(kinds) + 2.8, 4.2), layout="constrained")
    panels = figure.subplots(1, len(kinds), sharey=True, squeeze=False)[0]
    for ax, kind in zip(panels, kinds, strict=True):
        panel(ax, result.points, kind)
        ax.set(xlabel=f"error of {kind} at the end", xlim=(3, 1e-13))
        ax.grid(alpha=0.25)
    panels[0].set_ylabel("CPU time [ms]")
    figure.suptitle(result.problem.title, fontsize=10)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", frameon=False, fontsize=7)
    return figure
