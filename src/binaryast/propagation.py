"""The driver of a run: it checks, has the run followed by compiled steps, by SciPy or by heyoka, and reports."""

import platform
import warnings
from collections.abc import Sequence
from dataclasses import replace
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import version
from math import inf, pi
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast import choosing, closest, constants, legs, streaming
from binaryast.errors import (
    AccuracyError,
    BinaryastError,
    EndWarning,
    GravityWarning,
    InputError,
    StepWarning,
    StorageError,
)
from binaryast.events import Contact, Event, checked
from binaryast.gravity import LARGEST_DEGREE
from binaryast.impulses import AnyImpulse, in_order
from binaryast.integrators import Integrator, RungeKutta, Splitting, Stepping, Taylor
from binaryast.kernels import loop
from binaryast.kernels.clearance import least_clearance
from binaryast.kernels.jit import source_hash
from binaryast.outcome import Outcome, interruption_message
from binaryast.progress import bar, said_if_long
from binaryast.rates import rates
from binaryast.rows import TrajectoryFloats
from binaryast.run_file import pieces_of
from binaryast.schedule import Leg, schedule
from binaryast.state import State
from binaryast.stepping import SteppedRun, turn_error
from binaryast.storage import as_path, refuse
from binaryast.streaming import Memory
from binaryast.system import Pair, System
from binaryast.trajectory import Trajectory
from binaryast.trials import Trials
from binaryast.units import Floats, brief, numbers, quantity, span, to_si
from binaryast.working.base import surfaces

if TYPE_CHECKING:
    from binaryast.solving import SolvedRun
    from binaryast.taylor.run import TaylorRun

DOUBTFUL_ENERGY_ERROR = 0.01
DOUBTFUL_TURN = 2 * pi / 20  # rad in one step
DOUBTFUL_TERM = 1e-3  # of gravity that is left out, over G m1 m2/r
TERM_ROWS = 1000  # how many of the saved rows are looked at for it
LEAST_ACCURACY, MOST_ACCURACY = 1e-14, 1e-2
ATTEMPTS = 8  # to reach it
TRY_OUT = Splitting(quantity(1.0, "s"))


class Method(NamedTuple):
    """How a run is to be followed, by an integrator or to an accuracy; whether with a bar; where its rows go."""

    integrator: Integrator | None
    accuracy: float
    progress: bool
    keeper: Memory
    events: tuple[Event, ...] = ()


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
    """Which leg of a run: its number, the inputs of the run, and the legs before."""

    number: int
    inputs: Inputs
    runs: list[Trajectory]


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
    method = Method(inputs.integrator, inputs.accuracy, progress, keeper, inputs.events)
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
            followed = _follow(system, now, leg, method, Place(number, inputs, runs))
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
        runs.append(_trajectory(system, inputs.state, method.events, *followed))
        keeper.over(number, leg, runs, legs.joined(runs, inputs.impulses))
        pressed = followed.outcome.pressed
    return keeper.finished(legs.joined(runs, inputs.impulses))


def follow_leg(system: System, state: State, leg: Leg, integrator: Integrator, events: Sequence[Event]) -> Trajectory:
    """Return a run along a leg by itself: what acts from outside knows the time when it begins."""
    inputs = Inputs(state, leg.end, None, integrator, 0.0, (), checked(events, system))
    method = Method(integrator, 0.0, False, Memory(), inputs.events)
    return _trajectory(system, state, inputs.events, *_follow(system, state, leg, method, Place(0, inputs, [])))


def _accuracy(value: Any) -> float:
    """Return an accuracy within bounds."""
    asked = float(numbers(value, "accuracy", ()))
    if not LEAST_ACCURACY <= asked <= MOST_ACCURACY:
        raise InputError(f"accuracy: expected {LEAST_ACCURACY:g} to {MOST_ACCURACY:g}, got {asked:g}")
    return asked


def _follow(system: System, state: State, leg: Leg, method: Method, place: Place) -> Followed:
    """Follow a system along a leg, as far as it goes."""
    if not leg.length:
        return Followed(_one_row(system, state, leg), method.integrator or TRY_OUT, {})
    if method.integrator is None:
        return _to_accuracy(system, state, leg, method, place)
    _check_kinds(system, state, method.integrator)
    compiling = "heyoka compiles the equations, once for all systems of one kind; it may take some seconds"
    method.keeper.begin(place.number, leg, {})
    with said_if_long(compiling, method.progress and isinstance(method.integrator, Taylor)):
        run = _run(system, state, method.integrator, leg, method.events)
    outcome = _gone(system, run, leg, method, place, (method.integrator, {}))
    return Followed(outcome, method.integrator, {})


def _gone(
    system: System, run: streaming.Run, leg: Leg, method: Method, place: Place, how: tuple[Integrator, dict[str, Any]]
) -> Outcome:
    """Have a run followed as far as it goes, with a bar, and its rows kept."""

    def report(outcome: Outcome) -> Trajectory:
        under_way = _quietly(system, place.inputs, Followed(outcome, *how))
        return legs.joined([*place.runs, under_way], place.inputs.impulses)

    method.keeper.report, method.keeper.refine = report, _refine
    with bar(leg.whole, method.progress, leg.begin) as show:
        return method.keeper.go(run, show)


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


def _to_accuracy(system: System, state: State, leg: Leg, method: Method, place: Place) -> Followed:
    """Follow a leg to an accuracy: plan, run, estimate, and again with a shorter step where it is not reached."""
    asked, length = method.accuracy, leg.length
    SteppedRun(system, state, TRY_OUT, schedule(leg, leg.whole), leg.begin)  # first says what is wrong with the start
    trials = Trials(system, state, leg.begin)
    known = dict(method.keeper.planned(place.number))
    first = known.pop("attempt", 0)
    longest = min(length / 4, leg.interval or length)
    plan = choosing.Plan(**{"floor": None} | known) if known else choosing.plan(trials, length, asked, longest)
    for attempt in range(first, ATTEMPTS):
        method.keeper.begin(place.number, leg, plan._asdict() | {"attempt": attempt})
        segments = schedule(leg, plan.integrator.step.value)
        run = SteppedRun(system, state, plan.integrator, segments, leg.begin, method.events)
        about = {"accuracy": asked, "choice": plan.reason}
        outcome = _gone(system, run, leg, method, place, (plan.integrator, about))
        if outcome.status != "completed":
            return Followed(outcome, plan.integrator, about)
        try:
            with bar(leg.whole, method.progress, leg.begin) as trials.show:
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
        return _trajectory(system, inputs.state, inputs.events, *followed)


def _trajectory(
    system: System,
    state: State,
    events: tuple[Event, ...],
    outcome: Outcome,
    integrator: Integrator,
    asked: dict[str, Any],
) -> Trajectory:
    """Return what has been computed of a run from a state, and warn where it ended early or badly."""
    if outcome.status in ("contact", "failed"):
        warnings.warn(f"the run ended after {outcome.time[-1]:g} s: {outcome.message}", EndWarning, stacklevel=4)
    figures = _figures(system, outcome)
    of_total, of_potential = figures["max_relative_energy_error"], figures["max_energy_error_over_potential"]
    error = min(of_total, of_potential)
    if of_potential > 10 * DOUBTFUL_ENERGY_ERROR and of_total > 1e-6:  # large spins hide the orbit in the total
        error = of_potential
    if error > DOUBTFUL_ENERGY_ERROR:
        cause = "its tolerances are too loose" if integrator.adaptive else f"a step of {outcome.step:g} s is too large"
        warnings.warn(
            f"the energy was wrong by {error:.2g} of its size at some step: {cause} for what happened, such as a "
            "close approach",
            StepWarning,
            stacklevel=4,
        )
    figures["max_next_degree_term"] = _next_degree_term(system, outcome)
    return Trajectory(
        system=system,
        integrator=integrator,
        si=TrajectoryFloats(*(_in_memory(part) for part in (outcome.time, *outcome.motion))),
        epoch=state.epoch,
        frame=state.frame,
        status=outcome.status,
        message=outcome.message,
        steps=outcome.steps,
        step=quantity(outcome.step, "s"),
        wall_time=quantity(outcome.wall_time, "s"),
        watched=_watched(system, events, outcome),
        occurrences=outcome.occurrences,
        provenance=provenance() | ({"heyoka": version("heyoka")} if isinstance(integrator, Taylor) else {}),
        **figures,
        **asked,
    )


def _watched(system: System, events: tuple[Event, ...], outcome: Outcome) -> tuple[Event, ...]:
    """Return what was looked for, and the contact that ended a run where it was none of that."""
    indices = outcome.occurrences.event
    if len(indices) and int(indices[-1]) >= len(events):
        position, attitude = outcome.occurrences.position[-1:], outcome.occurrences.attitude[-1:]
        pair = int(least_clearance(position[0], attitude[0], surfaces(system))[1])
        events = (*events, Contact(tuple(system.names[i] for i in system.pairs[pair][:2])))
    return events


def _in_memory(rows: Any) -> Floats:
    """Return rows, the last alone of those that are in a file."""
    return rows if isinstance(rows, np.ndarray) else np.asarray(rows[len(rows) - 1 :])


def _figures(system: System, outcome: Outcome) -> dict[str, Any]:
    """Return the largest errors in the ways in which they are reported."""
    watch = outcome.watch.array
    energy_error = float(watch[loop.ENERGY_ERROR])
    angular = float(np.linalg.norm(watch[loop.ANGULAR_MOMENTUM : loop.ANGULAR_MOMENTUM + 3]))
    masses = np.array([body.si.mass * body.pulls for body in system.bodies])
    velocity = outcome.motion.velocity
    impulse = outcome.motion.impulse
    first = np.einsum("i,nij->nj", masses, velocity[:1]) - impulse[:1]
    of_rows = 0.0
    for begin, end in pieces_of(len(velocity)):
        linear = np.einsum("i,nij->nj", masses, velocity[begin:end]) - impulse[begin:end]
        of_rows = max(of_rows, float(np.linalg.norm(linear - first, axis=1).max()))
    speeds = masses @ np.linalg.norm(velocity[:1][0], axis=1)
    return {
        "max_relative_energy_error": _over(energy_error, abs(watch[loop.ENERGY])),
        "max_energy_error": quantity(energy_error, "J"),
        "max_energy_error_over_potential": _over(energy_error, abs(outcome.watch.potential_energy)),
        "max_relative_angular_momentum_error": _over(float(watch[loop.ANGULAR_ERROR]), angular),
        "max_relative_linear_momentum_error": _over(max(of_rows, float(watch[loop.LINEAR_ERROR])), speeds),
        "max_rotation_error": float(watch[loop.ROTATION_ERROR]),
        "closest_approach": quantity(float(watch[loop.CLOSEST]), "m"),
        "closest_approach_time": quantity(outcome.closest_time, "s"),
    }


def _next_degree_term(system: System, outcome: Outcome) -> float | None:
    """Return the largest size of the terms that gravity leaves out, and warn of a doubtful one; None without a cut."""
    sizes: list[tuple[float, Pair]] = []
    for pair in system.pairs:
        primary, secondary = system.bodies[pair.primary], system.bodies[pair.secondary]
        terms = pair.gravity.next_terms(secondary, primary, *_configurations(outcome, pair))
        if terms is not None:
            sizes.append((float(terms.max(initial=0.0)), pair))
    if not sizes:
        return None
    size, pair = max(sizes, key=lambda item: item[0])
    if size > DOUBTFUL_TERM:
        warnings.warn(
            f"{pair.gravity!r} between {system.names[pair.primary]} and {system.names[pair.secondary]} leaves out "
            f"terms up to {size:.2g} of G m1 m2/r, and more of the torques: {_remedy(system, outcome, pair)}",
            GravityWarning,
            stacklevel=5,
        )
    return size


def _remedy(system: System, outcome: Outcome, pair: Pair) -> str:
    """Return what helps where gravity leaves out too much."""
    closest = float(np.linalg.norm(_configurations(outcome, pair)[0], axis=1).min(initial=np.inf))
    points = "take ba.PointPairs() of bodies filled with points, ba.mascons"
    if closest < system.bodies[pair.primary].bounding_radius + system.bodies[pair.secondary].bounding_radius:
        return f"at {closest:.4g} m spheres that hold the bodies meet, a higher degree need not be better: {points}"
    if pair.gravity.cut_at == LARGEST_DEGREE:
        return f"there is no higher degree: {points}"
    return "take a higher degree of ba.Multipole"


def _configurations(outcome: Outcome, pair: Pair) -> tuple[Floats, Floats]:
    """Return X (N, 3) and R (N, 3, 3) of a pair, (34) and (35), at saved rows, that of its closest among them."""
    one, two = pair.secondary, pair.primary
    position, attitude = outcome.motion.position, outcome.motion.attitude
    count, closest, row = len(position), np.inf, 0
    for begin, end in pieces_of(count):
        piece = position[begin:end]
        distances = np.linalg.norm(piece[:, one] - piece[:, two], axis=1)
        if distances.min() < closest:
            closest, row = distances.min(), begin + int(np.argmin(distances))
    rows = np.append(np.unique(np.linspace(0, count - 1, min(count, TERM_ROWS)).astype(int)), row)
    places, turns = position[rows], attitude[rows]
    apart = places[:, one] - places[:, two]
    distinct = np.any(apart, axis=1)
    to_primary = np.swapaxes(turns[distinct, two], -1, -2)
    return np.einsum("nij,nj->ni", to_primary, apart[distinct]), to_primary @ turns[distinct, one]


def _over(error: float, size: float) -> float:
    """Return a relative error; the absolute one where there is nothing to compare it with."""
    return float(error / size) if size > 0 else error


def provenance() -> dict[str, str]:
    """Return what is needed to repeat a run: versions, sources, machine, date, and G."""
    return _origin() | {"date": datetime.now(UTC).isoformat(timespec="seconds")}


@cache
def _origin() -> dict[str, str]:
    """Return what does not change in a process: looking it up takes longer than a short run."""
    return {
        "binaryast": constants.VERSION,
        "kernels": source_hash(),
        "python": platform.python_version(),
        **{name: version(name) for name in ("numpy", "scipy", "numba", "astropy", "h5py")},
        "machine": f"{platform.machine()} {platform.system()}",
        "host": platform.node(),
        "G": repr(constants.G),
    }
