"""The picture of a surface: its faces, coloured by what lies on them, seen from several sides."""

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from binaryast.errors import InputError, did_you_mean
from binaryast.surfaces import Surface
from binaryast.units import Floats, brief

QUANTITIES = {  # of a Surface: what the colour bar calls them
    "slope": "slope",
    "gravity": "effective gravity",
    "effective_potential": "effective potential",
    "escape_speed": "escape speed",
}
VIEWS = {  # elevation and azimuth of the eye [deg], and the axes to the right and up
    "+x": (0, 0, "y", "z"),
    "-x": (0, 180, "-y", "z"),
    "+y": (0, 90, "-x", "z"),
    "-y": (0, -90, "x", "z"),
    "+z": (90, -90, "x", "y"),
    "-z": (-90, -90, "x", "-y"),
}


def surface(
    found: Surface,
    quantity: str = "slope",
    figure: Figure | None = None,
    *,
    views: Sequence[str] = ("+x", "+y", "+z"),
    cmap: str = "viridis",
) -> Figure:
    """Draw the faces of a body, coloured by slope, gravity, effective potential or escape speed, with a colour bar.

    Parameters
    ----------
    found : Surface
        What `binaryast.surface` returns.
    quantity : {"slope", "gravity", "effective_potential", "escape_speed"}
        What the colours show.
    figure : Figure, optional
        An empty one to draw into; a new one of pyplot's by default.
    views : sequence of {"+x", "-x", "+y", "-y", "+z", "-z"}
        Where the eye is: ``"+z"`` looks down on the north pole. Without perspective.
    cmap : str
        One of matplotlib's colour maps.

    Returns
    -------
    Figure

    Raises
    ------
    InputError
        For something that is not a Surface, another quantity or view.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> corners = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [-1, 0, 0], [0, -1, 0], [0, 0, -1]] * u.km
    >>> faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]]
    >>> rock = ba.RigidBody("rock", ba.Polyhedron(corners, faces), density=2000 * u.kg / u.m**3)
    >>> moon = ba.RigidBody("moon", ba.Sphere(100 * u.m), density=2000 * u.kg / u.m**3)
    >>> system = ba.System([rock, moon], gravity=ba.PolyhedronPoint())
    >>> state = ba.State.circular_orbit(system, separation=4 * u.km, spins=[5 * u.h, "synchronous"])
    >>> figure = ba.plotting.surface(ba.surface(system, state), "escape_speed", views=["+x", "-z"])
    """
    if not isinstance(found, Surface):
        raise InputError(f"surface: expected a ba.Surface, such as ba.surface(system, state), got {brief(found)}")
    _known(quantity, QUANTITIES, "quantity")
    if isinstance(views, str) or not len(views):
        raise InputError(f"surface: views: expected a list of {', '.join(VIEWS)}, got {brief(repr(views))}")
    for view in views:
        _known(view, VIEWS, "views")
    if figure is None:
        import matplotlib.pyplot as plt  # half a second, not needed where a figure goes straight to a file

        figure = plt.figure()
    values = getattr(found, quantity)
    colours = ScalarMappable(Normalize(values.value.min(), values.value.max()), cmap)
    figure.set_size_inches(3.6 * len(views) + 1.3, 4.0)
    panels = [figure.add_subplot(1, len(views), i + 1, projection="3d", proj_type="ortho") for i in range(len(views))]
    figure.subplots_adjust(left=0.0, right=1 - 1.2 / figure.get_figwidth(), bottom=0.02, top=0.82, wspace=0.0)
    for ax, view in zip(panels, views, strict=True):
        _draw(ax, found, colours.to_rgba(values.value), view)
    bar = figure.add_axes((1 - 1.1 / figure.get_figwidth(), 0.14, 0.18 / figure.get_figwidth(), 0.64))
    figure.colorbar(colours, cax=bar, label=f"{QUANTITIES[quantity]} [{values.unit}]")
    name = found.body.replace("$", r"\$")
    figure.suptitle(f"{name}: {QUANTITIES[quantity]}")
    return figure


def _known(word: Any, words: dict[str, Any], name: str) -> None:
    if not isinstance(word, str) or word not in words:
        near = did_you_mean(word, words) if isinstance(word, str) else ""
        raise InputError(f"surface: {name}: {brief(repr(word))} is not known{near}; expected one of {', '.join(words)}")


def _draw(ax: Axes3D, found: Surface, colours: Floats, view: str) -> None:
    """Draw the faces that are turned to the eye, and the two axes across the line of sight to scale."""
    elevation, azimuth, right, up = VIEWS[view]
    vertices = found.vertices.value
    eye = _axis(view)
    seen = found.normals @ eye > 0
    ax.add_collection3d(
        Poly3DCollection(vertices[found.faces[seen]], fc=colours[seen], ec=colours[seen], lw=0.4), autolim=False
    )
    reach = float(np.abs(vertices).max())
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), zlim=(-reach, reach))
    ax.set_box_aspect((1, 1, 1), zoom=1.35)
    ax.view_init(elev=elevation, azim=azimuth)
    ax.set_axis_off()
    size = _round_length(reach)
    corner = reach * (1.2 * eye - _axis(right) - 0.95 * _axis(up))
    for name in (right, up):
        end = corner + size * _axis(name)
        ax.plot(*np.stack([corner, end], axis=1), color="#333333", lw=1.0)
        ax.text(*(end + 0.07 * reach * _axis(name)), name, ha="center", va="center", fontsize=8)
    ax.set_title(f"from {view}; axes of {size:g} m", fontsize=9, y=1.0)


def _axis(name: str) -> Floats:
    """Return the unit vector of a name such as ``-x``."""
    return np.asarray(np.eye(3)["xyz".index(name[-1])] * (-1 if name[0] == "-" else 1))


def _round_length(reach: float) -> float:
    """Return the largest of 1, 2, 5, 10, .. that is at most two fifths of a length."""
    power = 10.0 ** np.floor(np.log10(0.4 * reach))
    return float(max(step * power for step in (1, 2, 5) if step * power <= 0.4 * reach))
