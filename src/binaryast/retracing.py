"""The motion between saved rows, followed again: as accurate as the run itself."""

import warnings
from dataclasses import replace
from typing import Any, Literal

import numpy as np
from astropy.units import Quantity

from binaryast.errors import BinaryastWarning, InputError
from binaryast.events import Contact
from binaryast.integrators import Integrator
from binaryast.propagation import follow_leg
from binaryast.rows import TrajectoryFloats
from binaryast.schedule import Leg
from binaryast.state import State
from binaryast.trajectory import Trajectory
from binaryast.units import brief, quantity
from binaryast.working.base import GIVEN


def retrace(run: Trajectory, time: Quantity, *, side: Literal["before", "after"] = "after") -> State | Trajectory:
    """Return where everything is between the saved rows, by following the motion again from the row before.

    It is what `Trajectory.at` interpolates, in steps of the run and as accurate as they are, at their cost.

    Parameters
    ----------
    run : Trajectory
        Of any integrator.
    time : Quantity
        Since the start: one time, or an array (M,) of them that grow.
    side : {"after", "before"}
        Of an impulse at this very time.

    Returns
    -------
    State or Trajectory
        A state of one time; of several a trajectory, whose figures remain those of the whole run.

    Raises
    ------
    InputError
        As for `Trajectory.at`.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> system, state = ba.catalogue.load("didymos")
    >>> run = ba.propagate(system, state, duration=1 * u.day, integrator=ba.LGVI(step=40 * u.s), save_every=8 * u.h)
    >>> ba.retrace(run, 12345.6 * u.s).separation.round(3)
    <Quantity 1184.266 m>
    """
    if not isinstance(run, Trajectory):
        raise InputError(f"run: expected a ba.Trajectory, got {brief(run)}")
    times, single = run.checked_times(time, side)
    rows = [_row(run, when, side) for when in times.tolist()]
    result = replace(run, si=TrajectoryFloats(*(np.concatenate(arrays) for arrays in zip(*rows, strict=True))))
    return result[0] if single else result


def _row(run: Trajectory, time: float, side: str) -> TrajectoryFloats:
    """Return one row, at a time."""
    before = int(np.searchsorted(run.si.time, time, side="right")) - 1
    if run.si.time[before] == time:
        if side == "before":
            before = int(np.searchsorted(run.si.time, time, side="left"))
        return TrajectoryFloats(*(array[before : before + 1] for array in run.si))
    length = time - float(run.si.time[before])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", BinaryastWarning)  # the run itself has said what there is to say
        again = follow_leg(
            run.system,
            run[before],
            Leg(float(run.si.time[before]), time, time, None),
            _by_steps_up_to(run, length),
            [one for one in run.watched if isinstance(one, Contact) and not one.terminal],
        )
    found = TrajectoryFloats(*(array[-1:] for array in again.si))
    given = {name: getattr(found, name) + getattr(run.si, name)[before] for name in GIVEN}
    return found._replace(time=np.array([time]), **given)


def _by_steps_up_to(run: Trajectory, length: float) -> Integrator:
    """Return the integrator of a run with the step that it used, or a shorter one."""
    integrator: Any = run.integrator
    if getattr(integrator, "step", None) is None:
        return run.integrator
    return replace(integrator, step=quantity(min(float(run.step.value), length), "s"))  # type: ignore[no-any-return]
