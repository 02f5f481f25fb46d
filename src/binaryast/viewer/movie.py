"""A movie of a run: its bodies, shaded, on their ways, and how well the energy is kept; by matplotlib."""

import tempfile
import warnings
from importlib.util import find_spec
from pathlib import Path
from shutil import which
from typing import Any

import numpy as np
from matplotlib import animation, rc_context
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from scipy.spatial.transform import Rotation

from binaryast.canvas import DARK, colour, length_unit, plain, time_of
from binaryast.errors import InputError, InterpolationWarning, MissingPackageError
from binaryast.rows import rotations_of
from binaryast.storage import as_path, refuse, replace_whole
from binaryast.summaries import joined
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief, quantity, whole_number
from binaryast.viewer import frames
from binaryast.viewer.conserved import kept
from binaryast.viewer.facets import facets, seen
from binaryast.viewer.solids import reach

FORMATS = (".gif", ".mp4")
AXES = ("inertial", "line")
ELEVATION = np.deg2rad(35.0)  # of the eye above the plane of the orbit
SIZE = (8.0, 6.6)  # inches, of 100 pixels
SPACE, STRIP = (0.11, 0.24, 0.87, 0.7), (0.11, 0.08, 0.87, 0.1)  # left, bottom, width and height in shares of it
WIDTH_OVER_HEIGHT = SPACE[2] * SIZE[0] / (SPACE[3] * SIZE[1])
MOST_NAMES, FASTEST = 20, 240
GROUND, INK = "#101318", "#d8d6d1"


def animate(
    run: Trajectory,
    path: str | Path,
    *,
    pictures: int = 240,
    rate: int = 24,
    axes: str = "inertial",
    force: bool = False,
) -> Path:
    """Draw a run as a movie: its bodies with their shapes and attitudes, shaded, and the error of its energy.

    Pictures are evenly spaced in time, by `Trajectory.at` between rows. Bodies are lit by the Sun where a
    `binaryast.Sun` acts on the run, else from beside the eye, which looks from 35 degrees above the plane of the orbit.

    Parameters
    ----------
    run : Trajectory
    path : path
        The file, whose name ends in .gif or .mp4. The latter needs ffmpeg, as a program or as the package
        imageio-ffmpeg.
    pictures : int
        How many; of a run of one row there is one.
    rate : int
        Pictures a second.
    axes : {"inertial", "line"}
        Inertial, or turning with the line of the first two bodies' centres.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        For what is not a run, another ending, other axes, or numbers that are not positive.
    MissingPackageError
        Where there is no ffmpeg.
    StorageError
        Where it cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     ba.animate(run, f"{folder}/didymos.gif", pictures=3).name
    'didymos.gif'
    """
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    pictures, rate = whole_number(pictures, "pictures", 1), whole_number(rate, "rate", 1, FASTEST)
    if axes not in AXES:
        raise InputError(f"axes: expected 'inertial' or 'line', got {brief(repr(axes))}")
    path = as_path(path)
    if path.suffix.lower() not in FORMATS:
        raise InputError(f"{path}: expected a name that ends in .gif or .mp4")
    refuse(path, force=force)
    program = _ffmpeg() if path.suffix.lower() == ".mp4" else ""
    count = 1 if len(run) == 1 else pictures
    figure = Figure(figsize=SIZE, facecolor=GROUND)
    draw: Any = Film(run, figure, count, axes).draw
    movie = animation.FuncAnimation(figure, draw, frames=count, init_func=tuple, blit=False)
    with tempfile.TemporaryDirectory() as folder, rc_context({"animation.ffmpeg_path": program or "ffmpeg"}):
        whole = Path(folder) / f"movie{path.suffix.lower()}"
        writer = animation.FFMpegWriter(fps=rate) if program else animation.PillowWriter(fps=rate)
        movie.save(whole, writer=writer, dpi=100, savefig_kwargs={"facecolor": GROUND})
        return replace_whole(path, whole.read_bytes(), force=force)


def _ffmpeg() -> str:
    """Return where ffmpeg is."""
    if program := which("ffmpeg"):
        return program
    if find_spec("imageio_ffmpeg"):
        import imageio_ffmpeg

        return str(imageio_ffmpeg.get_ffmpeg_exe())
    raise MissingPackageError(
        "an .mp4 needs ffmpeg: install it, or its package by pip install 'binaryast[movie]'; or write a .gif"
    )


class Film:
    """The pictures of a run: what changes from one to the next, drawn into one figure."""

    def __init__(self, run: Trajectory, figure: Figure, pictures: int, axes: str) -> None:
        self.run, self.bodies = run, run.system.bodies
        self.times = np.linspace(run.si.time[0], run.si.time[-1], pictures)
        self.shown = _at(run, self.times)
        self.turns = _turns(run, self.shown, axes)
        self.places = np.einsum("nij,nbj->nbi", self.turns, frames.about_barycentre(self.shown)[0])
        self.paths = np.einsum("nij,nbj->nbi", _turns(run, run, axes), frames.about_barycentre(run)[0])
        self.light = frames.sunlight(run, self.times)
        self.trail = frames.period(run)
        self.surfaces = [facets(body) for body in self.bodies]
        self.inks = 0.35 + 0.65 * np.array([to_rgb(colour(i)) for i in range(len(self.bodies))])  # on a dark ground
        self._prepare(figure)

    def _prepare(self, figure: Figure) -> None:
        """Draw what stays, and make what will change."""
        reaches = np.array([reach(body) for body in self.bodies])
        self.size, unit = length_unit(float(np.abs(self.places).max() + reaches.max()))
        self.space, strip = _panels(figure, self.run)
        _fit(self.space, self.places, reaches, self.size, unit)
        self.solid: Any = PolyCollection([], linewidths=0.2, zorder=3)
        self.space.add_collection(self.solid)
        dots: Any = self.space.scatter  # matplotlib's types do not know colours of three numbers
        self.dots = dots(*self.places[0, :, :2].T / self.size, s=12, c=self.inks, zorder=2)
        self.lines = [self.space.plot([], [], color=tuple(ink), lw=0.9, zorder=1)[0] for ink in self.inks]
        for body, ink in list(zip(self.bodies, self.inks, strict=True))[:MOST_NAMES]:
            self.space.plot([], [], "o", color=tuple(ink), label=plain(body.name))
        self.space.legend(loc="upper right", fontsize="small", facecolor=GROUND, edgecolor=GROUND, labelcolor=INK)
        self.now = strip.axvline(0, color=INK, lw=0.8)

    def draw(self, k: int) -> None:
        """Draw the k-th picture."""
        corners, shades = self._bodies(k)
        self.solid.set(verts=corners / self.size, facecolor=shades, edgecolor=shades)
        self.dots.set_offsets(self.places[k, :, :2] / self.size)
        time, place = self.times[k], self.places[k, :, :2]
        rows = (self.run.si.time <= time) & (self.run.si.time >= time - self.trail)
        for i, line in enumerate(self.lines):
            line.set_data(*np.concatenate([self.paths[rows, i, :2], place[None, i]]).T / self.size)
        scale, name = _time_unit(self.run)
        self.now.set_xdata([time / scale] * 2)
        epoch = self.run.epoch
        date = "" if epoch is None else f"   {(epoch + quantity(time, 's')).iso[:19]} TDB"
        self.space.set_title(plain(f"{joined(self.run.system.names)}   {time / scale:.3f} {name}{date}"), color=INK)

    def _bodies(self, k: int) -> tuple[Floats, Floats]:
        """Return the triangles that are seen (m, 3, 2), from back to front, and their colours (m, 3)."""
        lamp = np.array([0.4, 0.3, 0.85]) if self.light is None else self.turns[k] @ self.light[k]
        parts = []
        for i, triangles in enumerate(self.surfaces):
            attitude = self.turns[k] @ rotations_of(self.shown.si.attitude[k, i])
            part = seen(triangles @ attitude.T + self.places[k, i], lamp / np.linalg.norm(lamp))
            parts.append((part.corners, part.depth, part.shade[:, None] * self.inks[i]))
        corners, depth, shades = (np.concatenate(arrays) for arrays in zip(*parts, strict=True))
        order = np.argsort(depth)
        return corners[order], shades[order]


def _at(run: Trajectory, times: Floats) -> Trajectory:
    """Return the run at times, for pictures: how accurate it is between rows matters little."""
    if len(run) == 1 or len(times) == 1:
        return run[:1]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InterpolationWarning)
        result = run.at(quantity(times, "s"))
    assert isinstance(result, Trajectory)
    return result


def _turns(run: Trajectory, shown: Trajectory, axes: str) -> Floats:
    """Return the turns (N, 3, 3) from inertial axes to those of the picture: x to the right, z to the eye."""
    position, velocity = shown.si.position, shown.si.velocity
    if axes == "line" and len(run.system.bodies) > 1:
        first, pole = (x[:, 1] - x[:, 0] for x in (position, velocity))
        pole = np.cross(first, pole)
    else:
        pole = np.tile(frames.pole(run), (len(position), 1))
        first = np.tile(np.eye(3)[np.argmin(np.abs(pole[0]))], (len(position), 1))
    size = np.linalg.norm(pole, axis=1, keepdims=True)
    if not np.all(size > 0):
        raise InputError("animate: axes='line': the bodies move on a line at some time, which has no plane")
    z = pole / size
    x = first - np.sum(first * z, axis=1, keepdims=True) * z
    x = x / np.linalg.norm(x, axis=1, keepdims=True)
    of_plane = np.stack([x, np.cross(z, x), z], axis=1)
    return np.asarray(Rotation.from_euler("x", ELEVATION - np.pi / 2).as_matrix() @ of_plane)


def _panels(figure: Figure, run: Trajectory) -> tuple[Axes, Axes]:
    """Return where bodies are drawn, and a strip with the error of the energy."""
    space, strip = figure.add_axes(SPACE), figure.add_axes(STRIP)
    scale, name = _time_unit(run)
    energy = kept(run)[0]
    strip.semilogy(run.si.time / scale, np.maximum(energy.errors, 1e-17), color="#f0b35a", lw=0.8)
    strip.set_xlabel(f"time [{name}]", color=INK, fontsize="small")
    strip.set_ylabel("energy error\nover |E0|", color=INK, fontsize="small")
    for ax in (space, strip):
        ax.set_facecolor(GROUND)
        ax.tick_params(colors=INK, labelsize="small")
        for side in ax.spines.values():
            side.set_color(DARK)
    return space, strip


def _fit(space: Axes, places: Floats, reaches: Floats, size: float, unit: str) -> None:
    """Make room for all that is ever shown."""
    low = (places - reaches[:, None])[..., :2].min(axis=(0, 1)) / size
    high = (places + reaches[:, None])[..., :2].max(axis=(0, 1)) / size
    middle, half = (low + high) / 2, (high - low) / 2
    half_height = 1.06 * max(half[1], half[0] / WIDTH_OVER_HEIGHT) or 1.0
    for axis, reached in (("x", half_height * WIDTH_OVER_HEIGHT), ("y", half_height)):
        at = middle[0 if axis == "x" else 1]
        space.set(**{f"{axis}lim": (at - reached, at + reached)})
        getattr(space, f"set_{axis}label")(f"{axis} [{unit}]", color=INK, fontsize="small")
    space.set_aspect("equal")


def _time_unit(run: Trajectory) -> tuple[float, str]:
    """Return the size [s] and the name of the unit of time that reads best."""
    time, name = time_of(run)
    return (float(run.si.time[-1] / time[-1]) if time[-1] > 0 else 1.0), name
