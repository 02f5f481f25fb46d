"""What the options of ``binaryast run`` ask for: a scenario, or the end of a run, with other values in their place."""

import argparse
import os
import sys
from dataclasses import fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from binaryast.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from binaryast.events import Event
    from binaryast.gravity import Gravity
    from binaryast.impulses import AnyImpulse
    from binaryast.integrators import Integrator
    from binaryast.scenario import Scenario
    from binaryast.state import State
    from binaryast.system import System

RUN = ".h5"  # the suffix of a run


def show_warning(message: Any, *_: Any, **__: Any) -> None:
    """Print a warning in a line of its own."""
    print(f"binaryast: warning: {message}", file=sys.stderr)


def is_file(system: str) -> bool:
    """Whether an argument is meant as a file, not as a name of the catalogue."""
    return Path(system).suffix.lower() in (".toml", RUN) or os.sep in system


def scenario_of(system: str) -> "Scenario":
    """Return the scenario of a file or a catalogue entry."""
    from binaryast import catalogue, scenario

    if Path(system).suffix.lower() == RUN:
        raise InputError(f"{system} is a run, not a scenario: draw it with binaryast plot, go on with binaryast run")
    if not is_file(system):
        catalogue.text(system)  # an unknown name is said before anything is compiled
    return scenario.load(system) if is_file(system) else catalogue.entry(system)


def _time(text: str | None, option: str) -> Any:
    """Return the time that an option says, None where it is not given."""
    from binaryast.units import parse, quantity, to_si

    return None if text is None else quantity(to_si(parse(text, option, "40 s"), "s", option, sign="positive"), "s")


def start(options: argparse.Namespace) -> tuple["System", "State", dict[str, Any], Any, Any]:
    """Return what to run: a scenario or the end of an earlier run, with the options in the place of its own values.

    The third of them is how: the integrator or the accuracy, and the impulses and events, by name.
    """
    duration, step, save_every = (
        _time(getattr(options, name), f"--{name.replace('_', '-')}") for name in ("duration", "step", "save_every")
    )
    integrator: Integrator | None
    if Path(options.system).suffix.lower() == RUN:
        from binaryast.trajectory import Trajectory

        earlier = Trajectory.read(options.system)
        if duration is None:
            raise InputError(f"--duration: say how long to go on from the end of {options.system}, such as 60d")
        pair, start, integrator, accuracy = earlier.system, earlier[-1], earlier.integrator, earlier.accuracy
        reached = earlier.time[-1]
        impulses = [replace(one, time=one.time - reached) for one in earlier.impulses if one.time > reached]
        events = _known(earlier.watched)
    else:
        entry = scenario_of(options.system)
        pair, start, integrator, accuracy = entry.system, entry.state, entry.integrator, entry.accuracy
        duration, impulses = entry.duration if duration is None else duration, list(entry.impulses)
        events = list(entry.events)
        save_every = entry.save_every if save_every is None else save_every
    if options.degree is not None:
        pair = replace(pair, gravity=_gravity_of_degree(options.degree))
    if save_every is not None and options.save_every is None and save_every > duration:
        save_every = None  # the scenario's, for its own longer duration
    how = _method(integrator, accuracy, step, options) | {"impulses": _within(impulses, duration)}
    how |= {"events": events}
    return pair, start, how, duration, save_every


def _known(events: "Sequence[Event]") -> "list[Event]":
    """Return the events of an earlier run without those of functions that are not here, and say which these are."""
    for one in events:
        if isinstance(getattr(one, "function", None), str):
            show_warning(f"the event {one.name} is left out: its function is not known here")  # type: ignore[attr-defined]
    return [one for one in events if not isinstance(getattr(one, "function", None), str)]


def _within(impulses: "list[AnyImpulse]", duration: Any) -> "list[AnyImpulse]":
    """Return the impulses that a run is long enough for, and say which it is not."""
    from binaryast.units import span

    for one in impulses:
        if one.time > duration:
            left_out = f"the {type(one).__name__.lower()} after {span(one.time.value)}"
            show_warning(f"{left_out} is left out: the run ends after {span(duration.value)}")
    return [one for one in impulses if one.time <= duration]


def _method(
    before: "Integrator | None", accuracy: float | None, step: Any, options: argparse.Namespace
) -> dict[str, Any]:
    """Return the integrator, or the accuracy where one is known and no integrator is asked for."""
    asked = [name for name in ("integrator", "order", "scheme", "frame") if getattr(options, name) is not None]
    asked += ["step"] * (step is not None)
    if options.accuracy is not None and asked:
        raise InputError(f"--accuracy: got --{asked[0]} too: an accuracy picks the method and its step")
    if options.accuracy is not None or (accuracy is not None and not asked):
        return {"accuracy": accuracy if options.accuracy is None else options.accuracy}
    return {"integrator": _integrator(before, step, options)}


def _gravity_of_degree(degree: int) -> "Gravity":
    """Return the gravity that ``--degree`` asks for."""
    from binaryast import gravity

    if degree in (0, 2):
        return gravity.PointMass() if degree == 0 else gravity.SecondDegree()
    try:
        return gravity.Multipole(degree)
    except InputError:
        raise InputError(
            f"--degree: expected 0 (point masses) or 2 to {gravity.LARGEST_DEGREE}, got {degree}"
        ) from None


def _integrator(before: "Integrator | None", step: Any, options: argparse.Namespace) -> "Integrator":
    """Return the integrator that the options ask for, the scenario's or the earlier run's where they do not."""
    from binaryast.integrators import KINDS, LGVI, Stepping

    asked = {
        name: getattr(options, name) for name in ("order", "scheme", "frame") if getattr(options, name) is not None
    }
    if before is not None and step is None and options.integrator is None and not asked:
        return before
    keep = before is not None and step is None and set(asked) <= {"frame"}  # --step alone: LGVI of order 2
    kind = KINDS[options.integrator] if options.integrator else type(before) if keep and before is not None else LGVI
    arguments = before.arguments() if isinstance(before, kind) and not issubclass(kind, Stepping) else {}
    if issubclass(kind, Stepping):
        frame = getattr(before, "frame", None) if kind is not KINDS["KeplerSplitting"] else None
        arguments = {} if frame is None else {"frame": frame}
        if step is None and isinstance(before, Stepping):
            step = before.step
        if step is None:
            raise InputError(f"--step: say how large the steps of {kind.__name__} may be, such as 40s")
    if step is not None:
        arguments["step"] = step
    arguments |= asked
    known = [field.name for field in fields(kind) if field.init]  # type: ignore[arg-type]
    for name in arguments:
        if name not in known:
            raise InputError(f"--{name}: {kind.__name__} does not take it: see 'binaryast list --integrators'")
    return kind(**arguments)
