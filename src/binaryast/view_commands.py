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
