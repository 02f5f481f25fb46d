"""What pictures of a run share: colours, units that read well, and the Axes that are drawn into."""

import numpy as np
from matplotlib.axes import Axes

from binaryast.errors import InputError
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief

PRIMARY, SECONDARY, DARK = "#1f4e79", "#c8553d", "#333333"
COLOURS = (PRIMARY, SECONDARY, "#6a994e", "#7b2d8b", "#e0a030", "#2a9d8f", "#8d6b4f", "#888888")


def time_of(run: Trajectory) -> tuple[Floats, str]:
    """Return the time in the unit that reads best, and its name."""
    end = run.si.time[-1]
    for unit, size in (("days", 86400.0), ("hours", 3600.0)):
        if end >= 2 * size:
            return run.si.time / size, unit
    return run.si.time, "s"


def colour(i: int) -> str:
    """Return the colour of a body."""
    return COLOURS[i % len(COLOURS)]


def plain(text: str) -> str:
    """Return a text that matplotlib does not take for a formula."""
    return text.replace("$", r"\$")


def length_unit(largest: float) -> tuple[float, str]:
    """Return the size and the name of the length unit that reads best."""
    return (1000.0, "km") if largest >= 10000 else (1.0, "m")


def axes_of(run: Trajectory, ax: Axes | None) -> Axes:
    """Look at what is to be drawn; return the Axes given, or one in a new figure, which ``plt.show()`` will show."""
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    if ax is not None:
        return ax
    import matplotlib.pyplot as plt  # half a second, not needed where a figure goes straight to a file

    return plt.subplots(layout="constrained")[1]


def over_time(ax: Axes, run: Trajectory, label: str, title: str) -> Axes:
    """Say what is drawn against time, with a line at each impulse."""
    ax.set(xlabel=f"time [{time_of(run)[1]}]", ylabel=label, title=title)
    time, _ = time_of(run)
    for when in time[1:][np.diff(time) == 0]:  # an impulse
        ax.axvline(when, color=DARK, lw=0.6, ls=":")
    ax.margins(x=0)
    ax.grid(alpha=0.25)
    return ax
