"""Figures of a trajectory: each takes an Axes or makes one, and returns it."""

import io
import textwrap
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Polygon

from binaryast.analysis import libration_angle, mean_orbit_axes
from binaryast.analysis_plots import elements as elements  # public functions of this module
from binaryast.analysis_plots import poincare_section, roll_pitch_yaw, spectrum
from binaryast.bodies import RigidBody
from binaryast.canvas import DARK, PRIMARY, SECONDARY, axes_of, colour, length_unit, over_time, plain, time_of
from binaryast.errors import InputError
from binaryast.storage import as_path, refuse, replace_whole
from binaryast.summaries import joined
from binaryast.surface_plots import surface as surface  # a public function of this module
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief

FORMATS = ("png", "pdf", "svg")


def orbit(run: Trajectory, ax: Axes | None = None, *, frame: str = "inertial") -> Axes:
    """Draw the paths of the mass centres in the mean orbit plane, and the bodies at the end.

    Parameters
    ----------
    run : Trajectory
    ax : Axes, optional
        Where to draw; a new figure by default.
    frame : {"inertial", "primary"}
        Inertial, about the barycentre; or as seen from the primary, turning with it: x and y of its body frame.

    Returns
    -------
    Axes

    Raises
    ------
    InputError
        For another frame.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> ax = ba.plotting.orbit(run)
    """
    ax = axes_of(run, ax)
    if frame == "inertial":
        plane = _mean_plane(run)
        paths, attitudes = run.si.position, run.si.attitude[-1]
        place, subject = "in the mean orbit plane, inertial", "Orbit"
    elif frame == "primary":
        plane = np.eye(3)[:2]
        to_primary = np.swapaxes(run.si.attitude[:, 0], -1, -2)
        paths = np.einsum("nij,nbj->nbi", to_primary, run.si.position - run.si.position[:, :1])
        attitudes = to_primary[-1] @ run.si.attitude[-1]
        place, subject = "in the primary's axes", f"Seen from {plain(run.system.names[0])}, turning with it"
    else:
        raise InputError(f"orbit: frame={frame!r}: expected 'inertial' or 'primary'")
    size, unit = length_unit(float(np.abs(paths).max()))
    for i, body in enumerate(run.system.bodies):
        path = paths[:, i] @ plane.T / size
        ax.plot(*path.T, _style(path), color=colour(i), lw=0.7, ms=1.5, alpha=0.7, label=plain(body.name))
        outlines = _outlines(body, plane @ attitudes[i])
        for corners in outlines:
            ax.add_patch(Polygon(path[-1] + corners / size, fc=colour(i), ec=DARK, lw=0.5, alpha=0.9, zorder=3))
        if not outlines:
            ax.plot(*path[-1], "o", color=colour(i))
    ax.set(xlabel=f"x [{unit}]  ({place})", ylabel=f"y [{unit}]", title=subject, aspect="equal")
    ax.grid(alpha=0.25)
    ax.legend(loc="upper right", fontsize="small", markerscale=4)
    return ax


def _mean_plane(run: Trajectory) -> Floats:
    """Return two inertial axes (2, 3) in the mean orbit plane; of several bodies, across their orbits' momentum."""
    if len(run.system.bodies) == 2:
        return mean_orbit_axes(run)[:2]
    masses = np.array([body.si.mass for body in run.system.bodies])
    shares = masses / masses.sum()
    x, v = (array - np.einsum("i,nij->nj", shares, array)[:, None] for array in (run.si.position, run.si.velocity))
    pole = np.einsum("i,nij->j", masses, np.cross(x, v))
    size = np.einsum("i,ni->", masses, np.linalg.norm(x, axis=-1) * np.linalg.norm(v, axis=-1))
    if not np.linalg.norm(pole) > 1e-9 * size:
        raise InputError("the bodies do not go round each other: there is no orbit plane")
    pole = pole / np.linalg.norm(pole)
    first = np.eye(3)[np.argmin(np.abs(pole))]  # an axis that is not along the pole
    start = x[0, 1] - x[0, 0]
    if np.linalg.norm(np.cross(pole, start)) > 1e-6 * np.linalg.norm(start):
        first = start
    first = first - (first @ pole) * pole
    first = first / np.linalg.norm(first)
    return np.array([first, np.cross(pole, first)])


def orbit_from_primary(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw `orbit` as seen from the primary."""
    return orbit(run, ax, frame="primary")


def _style(path: Floats) -> str:
    """Return a line, or dots where rows lie so far apart that the chords between them would mislead."""
    legs = np.diff(path, axis=0)
    size = np.linalg.norm(legs, axis=1)
    cosine = np.sum(legs[1:] * legs[:-1], axis=1) / np.maximum(size[1:] * size[:-1], 1e-300)
    return "." if len(cosine) and np.median(cosine) < np.cos(0.15) and size.max() > 0 else "-"


def _outlines(body: RigidBody, view: Floats) -> list[Floats]:
    """Return the outlines (k, 2) [m] of a body about its mass centre; ``view`` (2, 3) is from its frame onto a plane.

    That of a surface of faces is the convex hull of its vertices, which is what is seen of it but for its hollows.
    """
    if body.corners is None:
        return [view @ centre + _ellipse(view @ matrix @ view.T) for centre, matrix in body.surface if np.any(matrix)]
    from scipy.spatial import ConvexHull

    seen = body.corners @ view.T
    return [seen[ConvexHull(seen).vertices]]


def _ellipse(matrix: Floats) -> Floats:
    """Return the outline (k, 2) of an ellipsoid whose matrix, projected onto a plane, is ``matrix`` (2, 2)."""
    angle = np.linspace(0, 2 * np.pi, 90)
    return np.asarray((np.linalg.cholesky(matrix) @ np.array([np.cos(angle), np.sin(angle)])).T)


def separation(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw the distance of the mass centres against time; of several bodies, of each from the primary."""
    ax = axes_of(run, ax)
    names = run.system.names
    distances = [run.distance(0, i).value for i in range(1, len(names))]
    size, unit = length_unit(float(np.max(distances)))
    for i, values in enumerate(distances, start=1):
        ink = DARK if len(names) == 2 else colour(i)
        ax.plot(time_of(run)[0], values / size, color=ink, lw=0.8, label=plain(names[i]))
    if len(names) == 2:
        return over_time(ax, run, f"separation [{unit}]", "Separation of the mass centres")
    ax.legend(loc="best", fontsize="small")
    return over_time(ax, run, f"distance [{unit}]", f"Distance from {plain(names[0])}")


def spins(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw each body's spin rate against time: its relative change, or itself where one starts at rest."""
    ax = axes_of(run, ax)
    rates = np.linalg.norm(run.si.spin, axis=-1)
    turning = [i for i, body in enumerate(run.system.bodies) if not body.is_point]
    if not turning:
        raise InputError("points do not turn: there are no spins to draw")
    relative = bool(np.all(rates[0, turning] > 0))
    for i in turning:
        values = rates[:, i] / rates[0, i] - 1 if relative else rates[:, i]
        name = plain(run.system.names[i])
        label = name + (f": {2 * np.pi / rates[0, i] / 3600:.4g} h at the start" if relative else "")
        ax.plot(time_of(run)[0], values, color=colour(i), lw=0.8, label=label)
    ax.legend(loc="best", fontsize="small")
    return over_time(ax, run, "spin rate / that at the start - 1" if relative else "spin rate [rad/s]", "Spins")


def libration(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw the angle from the line of centres to a body's x axis; of several, of those that keep it below 90 deg."""
    ax = axes_of(run, ax)
    names = run.system.names
    if len(names) == 2:
        ax.plot(time_of(run)[0], np.degrees(libration_angle(run).value), color=SECONDARY, lw=0.8)
        return over_time(ax, run, "libration angle [deg]", f"Libration of {plain(names[1])}")
    for i in range(1, len(names)):
        if run.system.bodies[i].is_point:
            continue
        try:
            angle = np.degrees(libration_angle(run, (0, i)).value)
        except InputError:  # its rows are too far apart, or it moves on a line: others may not be
            continue
        if np.abs(angle).max() < 90:
            ax.plot(time_of(run)[0], angle, color=colour(i), lw=0.8, label=plain(names[i]))
    if not ax.lines:
        raise InputError(f"no body keeps its x axis towards {names[0]}: there is no libration to draw")
    ax.legend(loc="best", fontsize="small")
    return over_time(ax, run, "libration angle [deg]", f"Libration about {plain(names[0])}")


def energy_exchange(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw how energy goes to and fro between orbit, spins and potential, each from its value at the start."""
    ax = axes_of(run, ax)
    time, _ = time_of(run)
    scale = abs(run.si.potential_energy[0])
    for values, label, ink in (
        (run.translational_energy, "translation", PRIMARY),
        (run.rotational_energy, "rotation", SECONDARY),
        (run.potential_energy, "potential", "#6a994e"),
    ):
        ax.plot(time, (values.value - values.value[0]) / scale, color=ink, lw=0.6, alpha=0.8, label=label)
    ax.legend(loc="best", fontsize="small")
    return over_time(ax, run, "change / |U at the start|", "Exchange of energy")


def conserved(run: Trajectory, ax: Axes | None = None) -> Axes:
    """Draw the errors of energy, angular momentum and rotation at the saved rows, on a logarithmic axis.

    Those of energy and angular momentum are from the start, or the impulse before.
    """
    ax = axes_of(run, ax)
    time, _ = time_of(run)
    energy = np.concatenate([_relative_error(leg.energy.value[:, None]) for leg in run.legs])
    momentum = np.concatenate([_relative_error(leg.angular_momentum.value) for leg in run.legs])
    curves: tuple[tuple[Floats, str, str], ...] = (
        (energy, "energy", PRIMARY),
        (run.rotation_error, r"rotation, $\|I - R^T R\|$", "#6a994e"),
        (momentum, "angular momentum", SECONDARY),
    )
    floor = np.finfo(float).eps / 4  # an error of zero has no logarithm
    for values, label, ink in curves:
        ax.semilogy(time, np.maximum(values, floor), color=ink, lw=0.8, label=label)
    ax.legend(loc="best", fontsize="small")
    return over_time(ax, run, "relative error", "What should be conserved")


def _relative_error(values: Floats) -> Floats:
    """Return the distance (N,) of vectors (N, k) from the first, over its size; as it is where that is zero."""
    size = float(np.linalg.norm(values[0]))
    return np.asarray(np.linalg.norm(values - values[0], axis=1) / (size if size > 0 else 1.0))


KINDS: dict[str, Callable[..., Any]] = {
    "orbit": orbit,
    "orbit_from_primary": orbit_from_primary,
    "separation": separation,
    "spins": spins,
    "libration": libration,
    "energy_exchange": energy_exchange,
    "conserved": conserved,
    "roll_pitch_yaw": roll_pitch_yaw,
    "spectrum": spectrum,
    "poincare_section": poincare_section,
}


def overview(run: Trajectory, figure: Figure | None = None) -> Figure:
    """Draw all of it on one page.

    Parameters
    ----------
    run : Trajectory
    figure : Figure, optional
        An empty one to draw into; a new one of pyplot's by default.

    Returns
    -------
    Figure

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> figure = ba.plotting.overview(run)
    """
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    if figure is None:
        import matplotlib.pyplot as plt

        figure = plt.figure()
    figure.set_size_inches(18, 8.5)
    axes = figure.subplots(2, 4)
    figure.subplots_adjust(left=0.045, right=0.985, bottom=0.07, top=0.9, wspace=0.36, hspace=0.3)
    figure.suptitle(plain(f"{joined(run.system.names)}: {_title(run)}"))
    panels: dict[Callable[..., Any], Axes] = {
        orbit: axes[0, 0],
        orbit_from_primary: axes[1, 0],
        separation: axes[0, 1],
        libration: axes[1, 1],
        spins: axes[0, 2],
        energy_exchange: axes[1, 2],
        conserved: axes[0, 3],
        _figures: axes[1, 3],
    }
    for draw, ax in panels.items():
        try:
            draw(run, ax)
        except InputError as error:  # such as libration on a line: the other pictures are worth having
            ax.text(0.5, 0.5, "\n".join(textwrap.wrap(str(error), 30)), ha="center", transform=ax.transAxes)
    return figure


def _title(run: Trajectory) -> str:
    time, unit = time_of(run)
    method = run.integrator
    return f"{time[-1]:.4g} {unit}, {type(method).__name__} of order {method.order}, steps of {run.step.value:g} s"


def _figures(run: Trajectory, ax: Axes) -> None:
    """Write the figures of the run into an Axes without axes."""
    lines = [
        f"status: {run.status}",
        f"{run.steps} steps of {run.step.value:g} s" + (" on average" if run.integrator.adaptive else ""),
        "",
        "largest errors, over every step:",
        f"  energy            {run.max_relative_energy_error:.2e} |E0|",
        f"                    {run.max_energy_error_over_potential:.2e} |U0|",
        f"  angular momentum  {run.max_relative_angular_momentum_error:.2e}",
        f"  linear momentum   {run.max_relative_linear_momentum_error:.2e}",
        f"  rotation          {run.max_rotation_error:.2e}",
        "",
        f"closest approach    {run.closest_approach.value:.6g} m",
    ]
    ax.axis("off")
    ax.text(0.02, 0.95, "\n".join(lines), transform=ax.transAxes, va="top", family="monospace")


def save(run: Trajectory, path: str | Path, *, kind: str | None = None, force: bool = False) -> Path:
    """Draw a run into a file, whole or not at all.

    Parameters
    ----------
    run : Trajectory
    path : path
        Its suffix says the format: png, pdf, svg.
    kind : str, optional
        One of `KINDS`; the overview by default.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    Path

    Raises
    ------
    StorageError
        Where it cannot be written.
    InputError
        For an unknown kind or format.
    """
    path = as_path(path)
    kind_of_file = path.suffix.lstrip(".").lower() or "png"
    if kind_of_file not in FORMATS:
        raise InputError(f"{path}: expected a name that ends in {', '.join(FORMATS)}")
    refuse(path, force=force)
    if kind is not None and str(kind) not in KINDS:
        raise InputError(f"{kind!r} is not a kind of picture: expected one of {', '.join(KINDS)}")
    memory = io.BytesIO()
    try:
        if kind is None:
            figure = overview(run, Figure())
        else:
            figure = Figure(layout="constrained")
            KINDS[kind](run, figure.subplots())
        figure.savefig(memory, format=kind_of_file, dpi=110)
    except (ValueError, RuntimeError) as error:
        raise InputError(f"{path}: {brief(error)}") from None
    return replace_whole(path, memory.getvalue(), force=force)
