"""The driver of a run: it checks, has the run followed by compiled steps, by SciPy or by heyoka, and reports."""

import warnings
from collections.abc import Sequence
from dataclasses import replace
from math import inf, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast import choosing, closest, legs, streaming
from binaryast.errors import AccuracyError, BinaryastError, InputError, StepWarning, StorageError
from binaryast.events import Event, checked
from binaryast.impulses import AnyImpulse, in_order
from binaryast.integrators import Integrator, RungeKutta, Splitting, Stepping, Taylor
from binaryast.outcome import Outcome, interruption_message, turn_error
from binaryast.progress import bar, said_if_long
from binaryast.rates import rates
from binaryast.reporting import trajectory_of
from binaryast.schedule import Leg, schedule
from binaryast.state import State
from binaryast.stepping import SteppedRun
from binaryast.storage import as_path, refuse
from binaryast.streaming import Memory
from binaryast.system import System
from binaryast.trajectory import Trajectory
from binaryast.trials import Trials
from binaryast.units import brief, numbers, quantity, span, to_si

if TYPE_CHECKING:
    from binaryast.solving import SolvedRun
    from binaryast.taylor.run import TaylorRun

DOUBTFUL_TURN = 2 * pi / 20  # rad in one step
LEAST_ACCURACY, MOST_ACCURACY = 1e-14, 1e-2
ATTEMPTS = 8  # to reach it
TRY_OUT = Splitting(quantity(1.0, "s"))


class Inputs(NamedTuple):
    """What a run depends on beside its system, checked: start, times [s], method, impulses in order, and events."""

    state: State
    end: float
    interval: float | None
    integrator: Integrator | None
    accuracy: float
    impulses: tuple[AnyImpulse, ...]
    events: tuple[Event, ...] = ()


class Place(NamedTuple):
    """Which leg of which run: its number, the legs before, the inputs of the run, where rows go, whether with a bar."""

    number: int
    runs: list[Trajectory]
    inputs: Inputs
    keeper: Memory
    progress: bool = False


class Followed(NamedTuple):
    """A leg that is over: the rows and how it ended, by which integrator, and what an accuracy adds to the run."""

    outcome: Outcome
    integrator: Integrator
    asked: dict[str, Any]


def propagate(
    system: System,
    state: State,
    *,
    duration: Quantity,
    integrator: Integrator | None = None,
    accuracy: float | None = None,
    save_every: Quantity | None = None,
    impulses: Sequence[AnyImpulse] = (),
    events: Sequence[Event] = (),
    progress: bool = False,
    file: str | Path | None = None,
    force: bool = False,
) -> Trajectory:
    """Follow a system through time.

    Parameters
    ----------
    system : System
        The bodies and their gravity.
    state : State
        Where they start. A barycentre that moves goes on doing so.
    duration : Quantity
        How long (time); met exactly.
    integrator : Integrator, optional
        How, such as ``LGVI(step=40 * u.s)``. The step used is the largest one up to this that divides ``save_every``.
    accuracy : float, optional
        Instead of an integrator: how large the error may be at the end, in positions relative to the distance from the
        primary and in the attitudes [rad] of all bodies; 1e-6 where neither is given. Method and step are picked by
        trials over some orbits, which say what each method needs, and a model of what a step costs; a second run, with
        steps twice as long, estimates the error, and where it is larger than was asked, the step is shortened. The
        trajectory has the ``estimated_error`` and says in ``choice`` what was picked and why.
    save_every : Quantity, optional
        Time between saved rows; met exactly, with one more row at the end where it does not divide ``duration``. By
        default at most 2000 rows are kept, each a whole number of steps apart.
    impulses : sequence of Impulse and Impact, optional
        Sudden changes of velocities and spins, each at its very time, several at one time in the order given. They cut
        the run into legs, `Trajectory.legs`, each an ordinary run from the changed state; the rows before and after
        are both kept, at the same time. Figures of the trajectory are the largest of all legs: errors of energy and
        momentum are those from the start of each leg, and an accuracy is that of each leg by itself.
    events : sequence of Event
        What to look for, of `binaryast.events`: each time it happens is kept in `Trajectory.events` with the state
        there, and a terminal event ends the run. The motion is the same, bit for bit, as without. What happens at the
        very start does not count, nor what an impulse jumps over. That two bodies touch ends a run anyway, unless there
        is a ``Contact(terminal=False)``.
    progress : bool
        Whether to show a bar with the simulated and the remaining time, on standard error.
    file : path, optional
        Where the run is written while it is under way: it is there from the first step on, rows are appended to it and
        leave memory, and at the end it becomes the HDF5 file that `Trajectory.write` makes. Whatever ends the process,
        `binaryast.resume` goes on from there. Rows of more than 64 MB stay in the file, and are read as needed.
    force : bool
        Whether a file of that name may be replaced.

    Returns
    -------
    Trajectory
        Also where the run ends early, by contact or another event, by Ctrl-C or because a step had no solution: its
        ``status`` says so.

    Raises
    ------
    StepError
        For a step longer than the run, or one that turns a body so far that (128) has no solution: by h Omega >= 1 at
        order 2.
    ContactError
        Where the bodies overlap at the start.
    AccuracyError
        Where an accuracy cannot be had, with the one that can, or the time for which it can: round-off grows to more
        than what was asked, as it does soon where the motion is chaotic.
    StorageError
        Where the file cannot be written, or no more of it; then what was written before remains.
    InputError
        For anything else that cannot be.

    Warns
    -----
    StepWarning
        For a step, or a longest part of one, above 1/20 of the fastest turn (of a variational integrator) or of the
        time of an orbit, and where the energy was wrong by more than 1 % of its size.
    GravityWarning
        Where gravity is cut at a degree whose next terms reach more than 1e-3 of G m1 m2/r at a saved row.
    EndWarning
        Where the run ends early by itself.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s))
    >>> run.status, run.steps
    ('completed', 2160)
    >>> run = ba.propagate(system, state, duration=1 * u.day, accuracy=1e-8)
    >>> run.estimated_error < 1e-8
    True
    """
    if integrator is not None and accuracy is not None:
        raise InputError(
            f"propagate: got integrator={brief(integrator)} and accuracy={brief(accuracy)}: give one of them"
        )
    accuracy = _accuracy(1e-6 if accuracy is None else accuracy)
    _check_kinds(system, state, integrator or TRY_OUT)
    looked_for = checked(events, system)
    end = float(to_si(duration, "s", "duration", sign="positive"))
    interval = None if save_every is None else float(to_si(save_every, "s", "save_every", sign="positive"))
    inputs = Inputs(state, end, interval, integrator, accuracy, in_order(impulses, system, end), looked_for)
    if file is None:
        return follow(system, inputs, Memory(), progress=progress)
    path = as_path(file)
    refuse(path, force=force)
    start = _quietly(system, inputs, Followed(_one_row(system, state, Leg.of_run(end)), integrator or TRY_OUT, {}))
    with streaming.begun(path, _stopped(start, inputs), inputs._asdict(), force=force) as keeper:
        return follow(system, inputs, keeper, progress=progress)


def _stopped(start: Trajectory, inputs: Inputs) -> Trajectory:
    """Return a run that has not moved yet, as its file tells of it."""
    return replace(start, status="interrupted", message="stopped before it moved", impulses=inputs.impulses)


def follow(system: System, inputs: Inputs, keeper: Memory, *, progress: bool) -> Trajectory:
    """Follow a system through all legs that are not over yet, and have their rows kept."""
    runs = keeper.runs()
    pressed = False
    for number, (leg, due) in enumerate(legs.cut(inputs.end, inputs.interval, inputs.impulses)):
        if number < len(runs):
            continue
        if runs and runs[-1].status != "completed":
            break
        now = runs[-1][-1] if runs else inputs.state
        for impulse in due:
            now = impulse.apply(now, system)
        try:
            if pressed and leg.length:
                raise KeyboardInterrupt
            followed = _follow(system, now, leg, Place(number, runs, inputs, keeper, progress))
        except KeyboardInterrupt:  # between two legs: what has been computed is kept
            if not runs:
                raise
            followed = _interrupted(system, now, leg)
        except StorageError:  # it speaks of the file, not of the leg
            raise
        except BinaryastError as error:  # it speaks of a start, a duration: those of the leg
            if not leg.begin:
                raise
            raise type(error)(f"from {span(leg.begin)} on, after an impulse: {error}") from None
        runs.append(trajectory_of(system, inputs.state, inputs.events, *followed))
        keeper.over(number, leg, runs, legs.joined(runs, inputs.impulses))
        pressed = followed.outcome.pressed
    return keeper.finished(legs.joined(runs, inputs.impulses))


def follow_leg(system: System, state: State, leg: Leg, integrator: Integrator, events: Sequence[Event]) -> Trajectory:
    """Return a run along a leg by itself: what acts from outside knows the time when it begins."""
    inputs = Inputs(state, leg.end, None, integrator, 0.0, (), checked(events, system))
    return trajectory_of(system, state, inputs.events, *_follow(system, state, leg, Place(0, [], inputs, Memory())))


def _accuracy(value: Any) -> float:
    """Return an accuracy within bounds."""
    asked = float(numbers(value, "accuracy", ()))
    if not LEAST_ACCURACY <= asked <= MOST_ACCURACY:
        raise InputError(f"accuracy: expected {LEAST_ACCURACY:g} to {MOST_ACCURACY:g}, got {asked:g}")
    return asked


def _follow(system: System, state: State, leg: Leg, place: Place) -> Followed:
    """Follow a system along a leg, as far as it goes."""
    integrator = place.inputs.integrator
    if not leg.length:
        return Followed(_one_row(system, state, leg), integrator or TRY_OUT, {})
    if integrator is None:
        return _to_accuracy(system, state, leg, place)
    _check_kinds(system, state, integrator)
    compiling = "heyoka compiles the equations, once for all systems of one kind; it may take some seconds"
    place.keeper.begin(place.number, leg, {})
    with said_if_long(compiling, place.progress and isinstance(integrator, Taylor)):
        run = _run(system, state, integrator, leg, place.inputs.events)
    outcome = _gone(system, run, leg, place, (integrator, {}))
    return Followed(outcome, integrator, {})


def _gone(
    system: System, run: streaming.Run, leg: Leg, place: Place, how: tuple[Integrator, dict[str, Any]]
) -> Outcome:
    """Have a run followed as far as it goes, with a bar, and its rows kept."""

    def report(outcome: Outcome) -> Trajectory:
        under_way = _quietly(system, place.inputs, Followed(outcome, *how))
        return legs.joined([*place.runs, under_way], place.inputs.impulses)

    place.keeper.report, place.keeper.refine = report, _refine
    with bar(leg.whole, place.progress, leg.begin) as show:
        return place.keeper.go(run, show)


def _refine(run: streaming.Run) -> None:
    """Look for the closest approach also within steps; solvers that know their arcs have done so."""
    if isinstance(run, SteppedRun):
        closest.refine(run)


def _one_row(system: System, state: State, leg: Leg) -> Outcome:
    """Return a state as a run that has not moved."""
    return SteppedRun(system, state, TRY_OUT, [], leg.begin).outcome()


def _interrupted(system: System, state: State, leg: Leg) -> Followed:
    """Return a leg that was stopped before it began to move."""
    message = interruption_message(leg.begin)
    return Followed(replace(_one_row(system, state, leg), status="interrupted", message=message), TRY_OUT, {})


def _to_accuracy(system: System, state: State, leg: Leg, place: Place) -> Followed:
    """Follow a leg to an accuracy: plan, run, estimate, and again with a shorter step where it is not reached."""
    asked, length = place.inputs.accuracy, leg.length
    SteppedRun(system, state, TRY_OUT, schedule(leg, leg.whole), leg.begin)  # first says what is wrong with the start
    trials = Trials(system, state, leg.begin)
    known = dict(place.keeper.planned(place.number))
    first = known.pop("attempt", 0)
    longest = min(length / 4, leg.interval or length)
    plan = choosing.Plan(**{"floor": None} | known) if known else choosing.plan(trials, length, asked, longest)
    for attempt in range(first, ATTEMPTS):
        place.keeper.begin(place.number, leg, plan._asdict() | {"attempt": attempt})
        segments = schedule(leg, plan.integrator.step.value)
        run = SteppedRun(system, state, plan.integrator, segments, leg.begin, place.inputs.events)
        about = {"accuracy": asked, "choice": plan.reason}
        outcome = _gone(system, run, leg, place, (plan.integrator, about))
        if outcome.status != "completed":
            return Followed(outcome, plan.integrator, about)
        try:
            with bar(leg.whole, place.progress, leg.begin) as trials.show:
                found = choosing.estimate(trials, plan, outcome, asked)
        except KeyboardInterrupt:  # what has been computed is kept
            found = None
        if found is None:
            text = "the error at the end is not known: runs with other steps did not come so far, or were stopped"
            warnings.warn(text, StepWarning, stacklevel=5)
            return Followed(outcome, plan.integrator, about)
        if found.within(asked):
            return Followed(outcome, plan.integrator, about | {"estimated_error": found.error})
        plan = plan.shortened(outcome.step, max(1.0, found.of_steps / asked))
    raise AccuracyError(
        f"accuracy: {asked:g} is not reached after {span(leg.end)} with steps down to {outcome.step:.3g} s: ask for "
        "ten times more, or for a shorter run"
    )


def _run(
    system: System, state: State, integrator: Integrator, leg: Leg, events: tuple[Event, ...]
) -> "SteppedRun | SolvedRun | TaylorRun":
    """Return the run of an integrator, looked at and ready to go."""
    if isinstance(integrator, Stepping):
        segments = schedule(leg, integrator.step.value)
        longest = max(segment.step for segment in segments)
        _check_turns(system, state, integrator, longest)
        _check_orbits(system, state, integrator, longest)
        return SteppedRun(system, state, integrator, segments, leg.begin, events)
    if isinstance(integrator, Taylor):
        from binaryast.taylor.run import TaylorRun

        return TaylorRun(system, state, integrator, leg, events)
    if not isinstance(integrator, RungeKutta):
        raise InputError(f"integrator: expected one of binaryast's, such as ba.LGVI, got {brief(integrator)}")
    from binaryast.solving import SolvedRun  # a third of a second, needed only here

    return SolvedRun(system, state, integrator, leg, events)


def _check_kinds(system: Any, state: Any, integrator: Any = TRY_OUT) -> None:
    """Raise where an argument is another object than it should be."""
    for name, value, kind in (
        ("system", system, System),
        ("state", state, State),
        ("integrator", integrator, Integrator),
    ):
        if not isinstance(value, kind):
            raise InputError(f"{name}: expected an object of class {kind.__name__}, got {brief(value)}")
    if len(state.si.position) != len(system.bodies):
        raise InputError(f"state: it has {len(state.si.position)} bodies, the system has {len(system.bodies)}")
    for body, spin in zip(system.bodies, state.si.spin, strict=True):
        if body.is_point and np.any(spin):
            raise InputError(f"state: {body.name} is a point, which does not turn: expected a spin of zero, got {spin}")
    integrator.check_start(system, state)


def _check_turns(system: System, state: State, integrator: Stepping, step: float) -> None:
    """Refuse a step without a solution, and warn of a doubtful one; exact rotation knows neither."""
    if integrator.largest_turn == inf:
        return
    for body, spin in zip(system.bodies, np.linalg.norm(state.si.spin, axis=1), strict=True):
        if step * spin >= integrator.largest_turn:
            raise turn_error(body.name, float(spin), integrator, step)
        part = step * integrator.shares.longest
        turn = part * spin
        if turn > (DOUBTFUL_TURN if integrator.order <= 4 else 2 * DOUBTFUL_TURN):
            what, remedy = f"the longest part, {part:.3g} s, of a step of {step:g} s", "a shorter step mends that"
            lead = "its attitude may be far off"
            if integrator.order == 2:
                what, remedy = f"a step of {step:g} s", f"{0.05 / spin:.3g} s would turn it by 0.05 rad"
                lead = f"its attitude will run ahead by about {turn**3 / 6:.2g} rad a step"
            warnings.warn(
                f"{what} turns {body.name} by {turn:.2g} rad: {lead}; {remedy}, and ba.Splitting turns it exactly",
                StepWarning,
                stacklevel=6,
            )


def _check_orbits(system: System, state: State, integrator: Stepping, step: float) -> None:
    """Warn of a step that is long beside the time in which two bodies fall or go round each other, as they are now."""
    longest = integrator.shares.longest
    for pair, rate in rates(system, state):
        if longest * step * rate > DOUBTFUL_TURN:
            part = "" if integrator.order == 2 else f", with parts of {longest * step:.3g} s,"
            warnings.warn(
                f"a step of {step:g} s{part} is long beside the {2 * pi / rate:.3g} s in which, as they are at the "
                f"start, {system.names[pair.secondary]} would go once round {system.names[pair.primary]}; "
                f"{0.05 / rate / longest:.3g} s would be 0.05 rad of it. A light body's error does not show in the "
                "energy of all",
                StepWarning,
                stacklevel=6,
            )


def _quietly(system: System, inputs: Inputs, followed: Followed) -> Trajectory:
    """Return what has been computed of a run that goes on: what is to be said of it is said at its end."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return trajectory_of(system, inputs.state, inputs.events, *followed)
