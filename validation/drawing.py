"""Figures of the report: one look, logarithmic axes, and the slope that theory gives beside the data."""

from collections.abc import Sequence

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

COLOURS = ("#1f4e79", "#c8553d", "#6a994e", "#7b2d8b", "#e0a030", "#2a9d8f", "#8d6b4f", "#888888")
MARKERS = "osD^vP*X"
mpl.rcParams["svg.hashsalt"] = "binaryast"  # the same figure gives the same file


def axes(columns: int = 1, **labels: str) -> tuple[Figure, list[Axes]]:
    """Return a figure with panels side by side; ``labels`` are those of every panel, such as ``xlabel``."""
    figure = Figure(figsize=(4.6 * columns + 0.6, 3.8), layout="constrained")
    panels = [figure.add_subplot(1, columns, k + 1) for k in range(columns)]
    for ax in panels:
        ax.set(**labels)
        ax.grid(alpha=0.25)
    return figure, panels


def curve(ax: Axes, x: Sequence[float], y: Sequence[float], label: str, index: int, *, log: bool = True) -> None:
    """Draw measured points, joined; on logarithmic axes by default."""
    if log:
        ax.set_xscale("log")
        ax.set_yscale("log")
    ax.plot(x, y, MARKERS[index % len(MARKERS)] + "-", color=COLOURS[index % len(COLOURS)], label=label, ms=4, lw=1)


def ticks(ax: Axes, values: Sequence[float]) -> None:
    """Put the ticks of the x axis where the points are, with their plain numbers."""
    ax.set_xticks(values, [f"{value:.4g}" for value in values])
    ax.set_xticks([], minor=True)


def slope_line(ax: Axes, x: Sequence[float], through: tuple[float, float], order: float, label: str = "") -> None:
    """Draw the line of an order through a point, dashed."""
    x0, y0 = through
    ends = np.array([min(x), max(x)])
    ax.plot(ends, y0 * (ends / x0) ** order, "--", color="#333333", lw=0.9, label=label or f"slope {order:g}")


def legend(ax: Axes, **options: object) -> None:
    """Draw the legend, small and without a frame."""
    ax.legend(frameon=False, fontsize=8, **options)
