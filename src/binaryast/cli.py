"""The command line: ``binaryast list | show | run | resume | plot | view | animate | completion``.

Results go to standard output, everything else to standard error; an error is one line and an exit status that is not 0:
1 for a run that failed, 2 for wrong input, 130 for Ctrl-C.
"""

import argparse
import contextlib
import json
import os
import re
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

from binaryast import view_commands
from binaryast.constants import VERSION
from binaryast.errors import BinaryastError, InputError
from binaryast.run_options import RUN, is_file, scenario_of, show_warning, start

if TYPE_CHECKING:
    from binaryast.bodies import RigidBody
    from binaryast.impulses import AnyImpulse
    from binaryast.occurrences import Occurrence
    from binaryast.system import System
    from binaryast.trajectory import Trajectory

FAILED, WRONG_INPUT, INTERRUPTED = 1, 2, 130
INTEGRATORS = ("LGVI", "Splitting", "KeplerSplitting", "RungeKutta", "Taylor")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line; return the exit status."""
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    try:
        options = parser().parse_args(_joined(arguments))
        with warnings.catch_warnings():
            warnings.showwarning = show_warning
            status: int = options.command(options)
        if sys.stdout is not None:
            sys.stdout.flush()
        return status
    except BrokenPipeError:  # the reader has seen enough, as in "binaryast list | head -1"
        _leave_output()
        return 0
    except KeyboardInterrupt:
        return _complain("stopped before there was anything to keep", "KeyboardInterrupt", arguments, INTERRUPTED)
    except BinaryastError as error:  # before OSError: a StorageError is both
        return _complain(str(error), type(error).__name__, arguments, WRONG_INPUT)
    except OSError as error:  # standard output cannot take any more
        _leave_output()
        return _complain(f"standard output: {error.strerror or error}", type(error).__name__, [], FAILED)
    except MemoryError:
        return _complain("not enough memory: save less often, with --save-every", "MemoryError", arguments, FAILED)


def _leave_output() -> None:
    """Send what is still to be printed nowhere, so that Python does not complain at its end."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def _joined(arguments: Sequence[str]) -> list[str]:
    """Join ``--duration -5d`` to ``--duration=-5d``: a wrong value, not an unknown option."""
    result: list[str] = []
    for argument in arguments:
        if result and result[-1].startswith("--") and "=" not in result[-1] and re.match(r"-\.?\d", argument):
            result[-1] += f"={argument}"
        else:
            result.append(argument)
    return result


def _complain(text: str, kind: str, arguments: Sequence[str], status: int) -> int:
    """Say in one line what was wrong; with ``--json`` also as the one object on standard output."""
    print(f"binaryast: error: {' '.join(text.split())}", file=sys.stderr)
    if "--json" in arguments:
        print(json.dumps({"status": "error", "error": kind, "message": text}))
    return status


class _Parser(argparse.ArgumentParser):
    """A parser whose errors are ours: one line, with a hint; options are not abbreviated."""

    def __init__(self, **options: Any) -> None:
        super().__init__(allow_abbrev=False, **options)

    def error(self, message: str) -> NoReturn:
        raise InputError(f"{message}; see '{self.prog} --help'")


def parser() -> argparse.ArgumentParser:
    """Return the parser of the whole command line."""
    top = _Parser(prog="binaryast", description="Rigid bodies under mutual gravity: the full two-body problem.")
    top.add_argument("--version", action="version", version=f"binaryast {VERSION}")
    commands = top.add_subparsers(title="commands", metavar="COMMAND", required=True)

    listing = commands.add_parser("list", help="the systems of the catalogue, or the integrators")
    listing.add_argument("--integrators", action="store_true", help="the integrators, with their orders and properties")
    listing.set_defaults(command=_list)

    showing = commands.add_parser("show", help="what the catalogue knows of a system, or a scenario file says")
    _system_argument(showing)
    showing.add_argument("--toml", action="store_true", help="print it as a scenario file, to start one's own from")
    showing.set_defaults(command=_show)

    running = commands.add_parser("run", help="follow a system through time; write a file and a picture")
    _system_argument(running, "; or the .h5 file of a run, to go on from its end")
    running.add_argument("--duration", metavar="TIME", help="how long, such as 60d")
    running.add_argument("--step", metavar="TIME", help="largest step, such as 40s")
    running.add_argument("--save-every", metavar="TIME", help="time between saved rows, such as 10min")
    running.add_argument("--degree", type=int, metavar="N", help="degree of gravity: 0 (point masses), or 2 to 16")
    running.add_argument(
        "--accuracy", type=float, metavar="X", help="error at the end, of positions over the distance and angles"
    )
    running.add_argument("--integrator", choices=INTEGRATORS, help="method, instead of an accuracy (default: LGVI)")
    running.add_argument("--order", type=int, choices=(2, 4, 6, 8, 10), help="order of LGVI (default: 2)")
    running.add_argument("--scheme", metavar="NAME", help="scheme, of those of binaryast list --integrators")
    running.add_argument("--frame", choices=("relative", "inertial"), help="whose variables are stepped")
    _file(running.add_argument("-o", "--output", metavar="FILE.h5", help="where to write (default: NAME.h5 here)"))
    running.add_argument("--no-picture", action="store_true", help="write no picture beside the file")
    running.add_argument("--force", action="store_true", help="replace files that exist")
    running.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    running.set_defaults(command=_run)

    resuming = commands.add_parser("resume", help="go on with a run that was stopped, to the end it was to have")
    _file(resuming.add_argument("file", metavar="FILE.h5", help="its file"))
    resuming.add_argument("--no-picture", action="store_true", help="write no picture beside the file")
    resuming.add_argument("--force", action="store_true", help="replace a picture that exists")
    resuming.add_argument("--json", action="store_true", help="print one JSON object and nothing else")
    resuming.set_defaults(command=_resume)

    plotting = commands.add_parser("plot", help="draw a run")
    _file(plotting.add_argument("file", metavar="FILE.h5", help="a run"))
    kinds = ["orbit", "orbit_from_primary", "separation", "spins", "libration", "energy_exchange", "conserved"]
    kinds += ["roll_pitch_yaw", "spectrum", "poincare_section"]
    plotting.add_argument("--kind", choices=kinds, help="one picture instead of all on a page")
    _file(plotting.add_argument("-o", "--output", metavar="FILE.png", help="png, pdf or svg (default: FILE.png)"))
    plotting.add_argument("--force", action="store_true", help="replace a file that exists")
    plotting.set_defaults(command=_plot)

    view_commands.add(commands, _file)

    completing = commands.add_parser("completion", help="print the completion script of a shell")
    completing.add_argument("shell", choices=("bash", "zsh"))
    completing.set_defaults(command=_completion)
    return top


def _system_argument(command: argparse.ArgumentParser, more: str = "") -> None:
    """Add the argument that names a system, completed by the catalogue's names and files."""
    action = command.add_argument(
        "system", metavar="NAME-or-FILE", help=f"catalogue entry or scenario file (.toml){more}"
    )
    action.complete = {"bash": "_binaryast_systems", "zsh": "_binaryast_systems"}  # type: ignore[attr-defined]


def _file(action: argparse.Action) -> None:
    """Have an option completed by file names."""
    action.complete = {"bash": "_shtab_compgen_files", "zsh": "_files"}  # type: ignore[attr-defined]


def _list(options: argparse.Namespace) -> int:
    from binaryast import catalogue

    if options.integrators:
        return _list_integrators()
    for name in catalogue.names():
        print(f"{name:12} {catalogue.title(name)}")
    return 0


def _list_integrators() -> int:
    """Print each integrator, what it keeps and takes, and its variants."""
    from binaryast.integrators import KINDS

    for name, kind in KINDS.items():
        kept = [word for word, has in (("symplectic", kind.symplectic), ("reversible", kind.reversible)) if has]
        taken = "any number of bodies" if kind.several else "pairs"
        print(f"{name:16} {kind.title}; {', '.join([*kept, taken])}")
        for line in kind.variants():
            print(f"    {line}")
    return 0


def _show(options: argparse.Namespace) -> int:
    import numpy as np

    from binaryast.units import span

    entry = scenario_of(options.system)
    if options.toml:
        print(entry.text, end="")
        return 0
    print(f"{entry.name}: {entry.title}")
    others = "secondary" if len(entry.system.bodies) == 2 else f"about {entry.system.names[0]}"
    for i, body in enumerate(entry.system.bodies):
        role = others if i else "primary"
        moments = ", ".join(f"{moment:.6g}" for moment in body.si.moments)
        pulls = "" if body.pulls else "; it feels others and does not pull"
        density = "" if body.density is None else f", {body.density.value:.5g} kg/m3"
        print(f"  {body.name} ({role}): {body.shape!r}".replace("<Quantity ", "").replace(">", ""))
        print(f"    {body.si.mass:.6g} kg, GM {body.si.gm:.8g} m3/s2{density}; moments {moments} kg m2{pulls}")
        for line in _place(body):
            print(line)
    for line in _gravity(entry.system):
        print(f"  gravity{line}")
    for perturbation in entry.system.perturbations:
        print(f"  from outside: {perturbation!r}")
    distances = np.linalg.norm(entry.state.si.position[1:] - entry.state.si.position[0], axis=1)
    print(f"  start: separation {', '.join(f'{d:.8g}' for d in distances)} m, axes {entry.state.frame}")
    how = f"by {entry.integrator!r}" if entry.accuracy is None else f"to an accuracy of {entry.accuracy:g} at the end"
    print(f"  by default: {span(entry.duration.value)} {how}")
    for source in entry.sources:
        more = "".join(f"; {key}: {source[key]}" for key in ("uncertainty", "note") if key in source)
        print(f"  {source['what']}: {source['source']}{more}")
    return 0


def _place(body: "RigidBody") -> list[str]:
    """Return where the body frame is in the shape's, in one line; nothing where they are the same."""
    import numpy as np

    cosine = (np.trace(body.turn) - 1) / 2
    sine = np.linalg.norm(body.turn - body.turn.T) / np.sqrt(8)
    angle = float(np.degrees(np.arctan2(sine, cosine)))
    size = np.sqrt(body.si.moments.max() / body.si.mass)
    offset = [x if abs(x) > 1e-9 * size else 0.0 for x in body.offset.value.tolist()]  # without round-off
    if not any(offset) and angle <= 1e-6:
        return []
    shown = ", ".join(f"{x:.6g}" for x in offset)
    return [f"    mass centre [{shown}] m, axes turned by {angle:.6g} deg in the shape's frame"]


def _gravity(system: "System") -> list[str]:
    """Return what is said of gravity: one model, or that of each pair."""
    if not isinstance(system.gravity, tuple):
        return [f": {system.gravity!r}"]
    names = system.names
    return [f" of {names[pair.primary]} and {names[pair.secondary]}: {pair.gravity!r}" for pair in system.pairs]


def _run(options: argparse.Namespace) -> int:
    from binaryast import storage

    stem = Path(options.system).stem if is_file(options.system) else options.system
    continued = Path(options.system).suffix.lower() == RUN
    default = f"{stem}-continued.h5" if continued else f"{stem}.h5"
    output = Path(default if options.output is None else options.output)
    picture = None if options.no_picture else Path(output.parent, f"{output.stem}.png")
    for path in (output, picture):
        if path is not None:
            storage.refuse(path, force=options.force)
    if output.suffix.lower() != RUN:
        raise InputError(f"--output: {output}: the file of a run is HDF5: give a name that ends in .h5")
    system, state, how, duration, save_every = start(options)
    from binaryast.propagation import propagate

    file = {"file": output, "force": options.force}
    run = _early_ends_reported(
        lambda progress: propagate(
            system, state, duration=duration, save_every=save_every, progress=progress, **how, **file
        ),
        options,
    )
    return _ended(run, output, picture, options)


def _resume(options: argparse.Namespace) -> int:
    from binaryast import storage
    from binaryast.resuming import resume

    output = storage.as_path(options.file)
    picture = None if options.no_picture else Path(output.parent, f"{output.stem}.png")
    if picture is not None:
        storage.refuse(picture, force=options.force)
    run = _early_ends_reported(lambda progress: resume(output, progress=progress), options)
    return _ended(run, output, picture, options)


def _ended(run: "Trajectory", output: Path, picture: Path | None, options: argparse.Namespace) -> int:
    """Draw and report a run that is safely in its file; return the exit status."""
    code = 0 if picture is None else _draw(run, picture, output, force=options.force)
    _report(run, output, None if code else picture, as_json=options.json)
    if run.status == "failed":
        print(f"binaryast: error: {run.message}; what was computed is in {output}", file=sys.stderr)
        return FAILED
    if run.status == "interrupted":
        text = f"binaryast: stopped by Ctrl-C; what was computed is in {output}. Go on with: binaryast resume {output}"
        print(text, file=sys.stderr)
        return INTERRUPTED
    return code


def _draw(run: "Trajectory", picture: Path, output: Path, *, force: bool) -> int:
    """Draw a run that is safely in its file; the exit status, 0 where the picture is there."""
    from binaryast import plotting

    try:
        plotting.save(run, picture, force=force)
    except (KeyboardInterrupt, MemoryError, BinaryastError) as error:
        reason = str(error) or type(error).__name__
        print(
            f"binaryast: warning: the run is in {output}, but its picture was not drawn ({reason}); "
            f"draw it with: binaryast plot {output}",
            file=sys.stderr,
        )
        return INTERRUPTED if isinstance(error, KeyboardInterrupt) else FAILED
    return 0


def _early_ends_reported(go: "Callable[[bool], Trajectory]", options: argparse.Namespace) -> "Trajectory":
    """Run, with a bar unless told otherwise; what ends a run early is in the report, so it needs no warning."""
    from binaryast.errors import EndWarning

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", EndWarning)
        return go(not options.json)


def _periods(run: "Trajectory") -> dict[str, float]:
    """Return the mean period of each body about the primary [s], as far as the rows tell."""
    from binaryast import analysis

    periods: dict[str, float] = {}
    for i, name in enumerate(run.system.names[1:], start=1):
        if i == 1 and len(run.system.bodies) == 2 and not run.energy_of_orbit[-1] < 0:
            continue
        with contextlib.suppress(InputError):  # less than one turn, or too few rows to count turns
            periods[name] = float(analysis.mutual_period(run, (0, i)).to_value("s"))
    return periods


def _motion(leg: "Trajectory") -> dict[str, Any]:
    """Return what is read off the rows between impulses: periods [s], and how far the secondary of a pair librates."""
    import numpy as np

    from binaryast import analysis

    libration = None
    if len(leg.system.bodies) == 2 and len(leg) > 1:
        with contextlib.suppress(InputError):  # a point, a line, or rows too far apart
            largest = float(np.degrees(np.abs(analysis.libration_angle(leg).value).max()))
            libration = largest if largest < 90 else None  # it turns freely
    return {"periods": _periods(leg), "libration": libration}


def _shown(impulse: "AnyImpulse") -> dict[str, Any]:
    """Return an impulse as plain numbers, in SI."""
    plain = {name: getattr(value, "value", value) for name, value in impulse.arguments().items()}
    numbers = {name: value.tolist() if hasattr(value, "tolist") else value for name, value in plain.items()}
    return {"type": type(impulse).__name__, **numbers}


def _happened(run: "Trajectory", one: "Occurrence") -> dict[str, Any]:
    """Return what happened as plain numbers, in SI."""
    event = {"type": type(one.event).__name__, "title": one.event.title(run.system)}
    return event | {"time": float(one.time.value), "direction": one.direction}


def _report(run: "Trajectory", output: Path, picture: Path | None, *, as_json: bool) -> None:
    """Print the summary, or one JSON object; where there are impulses, periods are those after the last."""
    from binaryast.trajectory import FIGURES
    from binaryast.units import span

    legs = [{"begin": float(leg.si.time[0]), "end": float(leg.si.time[-1]), **_motion(leg)} for leg in run.legs]
    periods = legs[-1]["periods"]
    pair = len(run.system.bodies) == 2
    if as_json:
        names = ("status", "message", "steps", "step", "wall_time", "choice", *FIGURES)
        figures = {name: getattr(run, name) for name in names}
        result = {name: getattr(value, "value", value) for name, value in figures.items()}
        result |= {
            "names": list(run.system.names),
            "integrator": repr(run.integrator),
            "rows": len(run),
            "duration": float(run.si.time[-1]),
            "mutual_period": periods.get(run.system.names[1]) if pair else None,
            "periods": periods,
            "impulses": [_shown(one) for one in run.impulses],
            "legs": legs,
            "events": [_happened(run, one) for one in run.events],
            "file": str(output),
            "picture": None if picture is None else str(picture),
            "provenance": run.provenance,
        }
        print(json.dumps(result, allow_nan=False, default=float))
        return
    print(run.summary())
    for leg in legs:
        when = "" if len(legs) == 1 else f" from {span(leg['begin'])} to {span(leg['end'])}"
        for name, period in leg["periods"].items():
            print(f"  {'mutual period' if pair else f'period of {name}'}{when} {period / 3600:.8g} h")
        if len(legs) > 1 and leg["libration"] is not None:
            print(f"  libration{when} at most {leg['libration']:.3g} deg")
    print(f"  written: {output}" + ("" if picture is None else f", {picture}"))


def _plot(options: argparse.Namespace) -> int:
    from binaryast import plotting, storage
    from binaryast.trajectory import Trajectory

    default = f"{Path(options.file).stem}.png"
    output = Path(default if options.output is None else options.output)
    run = Trajectory.read(options.file)
    storage.refuse(output, force=options.force)
    path = plotting.save(run, output, kind=options.kind, force=options.force)
    print(f"written: {path}")
    return 0


def _completion(options: argparse.Namespace) -> int:
    import shtab

    from binaryast import catalogue

    names = " ".join(catalogue.names())
    preamble = {
        "bash": f'_binaryast_systems() {{ compgen -W "{names}" -- "$1"; compgen -f -- "$1"; }}',
        "zsh": f"_binaryast_systems() {{ compadd {names}; _files }}",
    }
    print(shtab.complete(parser(), options.shell, preamble=preamble[options.shell]))
    return 0
