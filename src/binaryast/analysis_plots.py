"""Pictures of what is read off a run: roll, pitch and yaw, elements, spectra, Poincare sections."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from astropy.units import Quantity
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from binaryast import analysis
from binaryast.analysis import Spectrum
from binaryast.analysis.pairs import Bodies, pair_of
from binaryast.canvas import COLOURS, DARK, PRIMARY, SECONDARY, axes_of, length_unit, over_time, plain, time_of
from binaryast.errors import InputError
from binaryast.trajectory import Trajectory

LINES = 8


def roll_pitch_yaw(run: Trajectory, ax: Axes | None = None, bodies: Bodies = None) -> Axes:
    """Draw roll, pitch and yaw of the secondary against the orbit frame; see `binaryast.analysis.roll_pitch_yaw`."""
    ax = axes_of(run, ax)
    angles = analysis.roll_pitch_yaw(run, bodies)
    time, _ = time_of(run)
    for name, ink in (("yaw", SECONDARY), ("roll", PRIMARY), ("pitch", COLOURS[2])):
        values = getattr(angles, name).value.copy()
        values[1:][np.abs(np.diff(values)) > 180] = np.nan  # no line across, where it passes 180 deg
        ax.plot(time, values, color=ink, lw=0.8, label=name)
    ax.legend(loc="upper right", fontsize="small", ncols=3)
    over_time(ax, run, "angle [deg]", f"Roll, pitch and yaw of {plain(run.system.names[pair_of(run, bodies)[1]])}")
    return ax


def elements(run: Trajectory, figure: Figure | None = None, bodies: Bodies = None, *, pole: Any = None) -> Figure:
    """Draw osculating elements, and where there are three turns their running means, against time.

    Parameters
    ----------
    run : Trajectory
    figure : Figure, optional
        An empty one to draw into; a new one of pyplot's by default.
    bodies, pole
        As for `binaryast.analysis.osculating_elements`.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("patroclus")
    >>> run = ba.propagate(system, state, duration=30 * u.day, accuracy=1e-7)
    >>> figure = ba.plotting.elements(run)
    """
    osculating = analysis.osculating_elements(run, bodies, pole=pole)
    try:
        means = analysis.mean_elements(run, bodies, pole=pole)
    except InputError:  # too short, or with impulses
        means = None
    if figure is None:
        import matplotlib.pyplot as plt

        figure = plt.figure(layout="constrained")
    figure.set_size_inches(11, 6.5)
    time, _ = time_of(run)
    per_second = time[-1] / run.si.time[-1]
    size, unit = length_unit(float(np.abs(osculating.semi_major_axis.value).max()))
    panels = (
        ("semi_major_axis", f"semi-major axis [{unit}]", size),
        ("eccentricity", "eccentricity", 1.0),
        ("inclination", "inclination [deg]", 1.0),
        ("longitude_of_ascending_node", "ascending node [deg]", 1.0),
        ("argument_of_periapsis", "argument of periapsis [deg]", 1.0),
    )
    for (name, label, scale), ax in zip(panels, figure.subplots(2, 3).flat, strict=False):
        for found, ink, width, text in ((osculating, PRIMARY, 0.6, "osculating"), (means, SECONDARY, 1.2, "mean")):
            if found is not None:
                values = np.asarray(getattr(found, name)) / scale
                ax.plot(per_second * found.time.value, values, color=ink, lw=width, label=text)
        over_time(ax, run, label, "")
    figure.axes[0].legend(loc="best", fontsize="small")
    figure.axes[-1].axis("off")
    names = [plain(run.system.names[i]) for i in pair_of(run, bodies)]
    figure.suptitle(f"Elements of {names[1]} about {names[0]}")
    return figure


def spectrum(
    found: Trajectory | Spectrum,
    ax: Axes | None = None,
    *,
    bodies: Bodies = None,
    proper: Mapping[str, Quantity] | None = None,
) -> Axes:
    """Draw the lines of a spectrum, with their names; of a run, those of the libration.

    Parameters
    ----------
    found : Spectrum or Trajectory
    ax : Axes, optional
        Where to draw; a new figure by default.
    bodies : tuple of two, optional
        Of a run of several bodies, primary and secondary.
    proper : mapping, optional
        Frequencies by which lines are named; those of `binaryast.analysis.proper_frequencies` where a run has them.

    Returns
    -------
    Axes
    """
    title = "Lines of a spectrum"
    if not isinstance(found, Spectrum):
        run, ax = found, axes_of(found, ax)
        found = analysis.libration_spectrum(run, bodies, lines=LINES)
        title = f"Libration of {plain(run.system.names[pair_of(run, bodies)[1]])}"
        proper = _proper(run, bodies) if proper is None else proper
    elif ax is None:
        import matplotlib.pyplot as plt

        ax = plt.subplots(layout="constrained")[1]
    per_day = found.frequency.value * 86400 / (2 * np.pi)
    amplitude = found.amplitude.value
    floor = 0.3 * float(amplitude.min(initial=np.inf, where=amplitude > 0))
    ax.vlines(per_day, floor, amplitude, color=PRIMARY, lw=1.5)
    ax.plot(per_day, amplitude, "o", color=PRIMARY, ms=4)
    for x, y, name in zip(per_day, amplitude, found.names(proper) if proper else [""] * len(per_day), strict=True):
        ax.annotate(plain(name), (x, y), (3, 3), textcoords="offset points", fontsize="small", color=DARK, rotation=30)
    ax.set(yscale="log", xlabel="frequency [turns a day]", ylabel=f"amplitude [{found.amplitude.unit}]", title=title)
    ax.set_ylim(floor, 6 * float(amplitude.max(initial=floor)))
    ax.margins(x=0.15)
    ax.grid(alpha=0.25)
    return ax


def _proper(run: Trajectory, bodies: Bodies) -> dict[str, Quantity]:
    """Return the proper frequencies of a run, none where it is too short for them."""
    try:
        return analysis.proper_frequencies(run, bodies)
    except InputError:
        return {}


def poincare_section(
    run: Trajectory, ax: Axes | None = None, bodies: Bodies = None, *, crossing: Any = "periapsis"
) -> Axes:
    """Draw libration and its rate at each passage; see `binaryast.analysis.poincare_section`."""
    ax = axes_of(run, ax)
    found = analysis.poincare_section(run, crossing, bodies)
    time, unit = time_of(run)
    shown = ax.scatter(
        found.angle.value, found.rate.value, c=found.time.value * time[-1] / run.si.time[-1], s=8, cmap="viridis"
    )
    if ax.figure is not None:
        ax.figure.colorbar(shown, ax=ax, label=f"time [{unit}]")
    where = f"at each {crossing}" if isinstance(crossing, str) else "at each passage"
    ax.set(
        xlabel="libration angle [deg]",
        ylabel="its rate / mean motion",
        title=f"{plain(run.system.names[pair_of(run, bodies)[1]])} {where}",
    )
    ax.grid(alpha=0.25)
    return ax
