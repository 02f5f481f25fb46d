"""The commands that show a run: ``binaryast view`` writes a page that plays it, ``binaryast animate`` a movie."""

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Any

from binaryast.storage import refuse


def add(commands: Any, as_file: Callable[[argparse.Action], None]) -> None:
    """Add the commands; ``as_file`` has an argument completed by file names."""
    viewing = commands.add_parser("view", help="write a run as one web page that plays it, offline")
    as_file(viewing.add_argument("file", metavar="FILE.h5", help="a run"))
    as_file(viewing.add_argument("-o", "--output", metavar="PAGE.html", help="the page (default: FILE.html here)"))
    viewing.add_argument("--rows", type=int, default=10_000, metavar="N", help="rows it holds at most (default: 10000)")
    viewing.add_argument("--force", action="store_true", help="replace a file that exists")
    viewing.set_defaults(command=_view)

    moving = commands.add_parser("animate", help="draw a run as a movie, .gif or .mp4")
    as_file(moving.add_argument("file", metavar="FILE.h5", help="a run"))
    as_file(moving.add_argument("-o", "--output", metavar="MOVIE.mp4", help="the movie (default: FILE.gif here)"))
    moving.add_argument("--pictures", type=int, default=240, metavar="N", help="how many (default: 240)")
    moving.add_argument("--rate", type=int, default=24, metavar="N", help="pictures a second (default: 24)")
    moving.add_argument("--axes", choices=("inertial", "line"), default="inertial", help="line: of the centres")
    moving.add_argument("--force", action="store_true", help="replace a file that exists")
    moving.set_defaults(command=_animate)


def _output(options: argparse.Namespace, suffix: str) -> Path:
    """Return where to write, after a look whether that can be."""
    output = Path(f"{Path(options.file).stem}{suffix}" if options.output is None else options.output)
    refuse(output, force=options.force)
    return output


def _view(options: argparse.Namespace) -> int:
    from binaryast.trajectory import Trajectory
    from binaryast.viewer import view

    run = Trajectory.read(options.file)
    path = view(run, _output(options, ".html"), rows=options.rows, force=options.force)
    print(f"written: {path} ({path.stat().st_size / 1e6:.2g} MB): open it in a browser")
    return 0


def _animate(options: argparse.Namespace) -> int:
    from binaryast.trajectory import Trajectory
    from binaryast.viewer import animate

    run = Trajectory.read(options.file)
    how = {"pictures": options.pictures, "rate": options.rate, "axes": options.axes}
    path = animate(run, _output(options, ".gif"), force=options.force, **how)
    print(f"written: {path} ({path.stat().st_size / 1e6:.2g} MB)")
    return 0
