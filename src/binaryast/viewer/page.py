"""The page: its template, styles and scripts put together with the numbers of a run."""

import html
import json
import re
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from binaryast.canvas import colour
from binaryast.constants import VERSION
from binaryast.errors import InputError
from binaryast.storage import as_path, refuse, replace_whole
from binaryast.summaries import joined
from binaryast.trajectory import Trajectory
from binaryast.units import Floats, brief, whole_number
from binaryast.viewer import frames, threejs
from binaryast.viewer.conserved import kept
from binaryast.viewer.packing import packed
from binaryast.viewer.solids import reach, solids

SUFFIXES = (".html", ".htm")
SCRIPTS = ("motion.js", "camera.js", "space.js", "panel.js", "player.js")


def view(run: Trajectory, path: str | Path, *, rows: int = 10_000, force: bool = False) -> Path:
    """Write a run as one web page that plays it in any browser, without a server or a network.

    All bodies have their true shapes and attitudes. The page plays, pauses, goes to any time, shows inertial axes,
    those that turn with the line of centres and those of each body, paths, what should be conserved, and light from the
    Sun where a `binaryast.Sun` acts on the run. Between rows places are polynomials of degree 3, and bodies turn by
    their spins.

    Parameters
    ----------
    run : Trajectory
    path : path
        The file, whose name ends in .html.
    rows : int
        How many rows the page holds at most, evenly chosen from those of the run; of many bodies it may be fewer, so
        that the page stays below 10 MB.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    Path

    Raises
    ------
    InputError
        For what is not a run, another ending of the name, or less than one row.
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
    ...     ba.view(run, f"{folder}/didymos.html").name
    'didymos.html'
    """
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    rows = whole_number(rows, "rows", 1)
    path = as_path(path)
    if path.suffix.lower() not in SUFFIXES:
        raise InputError(f"{path}: expected a name that ends in .html")
    refuse(path, force=force)
    return replace_whole(path, page(run, rows).encode(), force=force)


def page(run: Trajectory, rows: int = 10_000) -> str:
    """Return the text of the page."""
    folder = files("binaryast.viewer") / "page"
    parts = {
        "title": html.escape(f"{joined(run.system.names)} - binaryast"),
        "styles": (folder / "page.css").read_text(encoding="utf-8"),
        "data": json.dumps(contents(run, rows), allow_nan=False).replace("<", "\\u003c"),
        "library": threejs.library(),
        "scripts": "\n".join((folder / name).read_text(encoding="utf-8") for name in SCRIPTS),
    }
    template = (folder / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda found: parts[found.group(1)], template)


def contents(run: Trajectory, rows: int) -> dict[str, Any]:
    """Return what the scripts know of the run, as plain values and packed arrays."""
    chosen = frames.chosen_rows(run, rows)
    light = frames.sunlight(run, run.si.time[chosen])
    sizes = [reach(body) for body in run.system.bodies]
    distances = _distances(run)
    unit = float(np.median(distances.max(axis=1))) or max(sizes) or 1.0
    return {
        "title": joined(run.system.names),
        "summary": run.summary(),
        "made": f"binaryast {VERSION}",
        "status": run.status,
        "axes": run.frame,
        "epoch": None if run.epoch is None else run.epoch.isot,
        "unit": unit,
        "rows": len(run),
        "period": frames.period(run),
        "pole": frames.pole(run).tolist(),
        "bodies": [
            {
                "name": body.name,
                "colour": colour(i),
                "reach": sizes[i] / unit,
                "solids": solids(body, unit),
            }
            for i, body in enumerate(run.system.bodies)
        ],
        "motion": frames.motion(run, chosen, unit),
        "sunlight": None if light is None else packed(light, np.float32),
        "kept": [
            {
                "name": one.name,
                "unit": one.unit,
                "scale": one.scale,
                "values": packed(one.values[chosen], np.float64),
                "errors": packed(one.errors[chosen], np.float32),
            }
            for one in kept(run)
        ],
    }


def _distances(run: Trajectory) -> Floats:
    """Return the distances of bodies from the first [m] (N, n)."""
    return np.asarray(np.linalg.norm(run.si.position - run.si.position[:, :1], axis=-1))
