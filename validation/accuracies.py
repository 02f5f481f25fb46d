"""Whether a run is as accurate as was asked: ``python -m validation.accuracies [SYSTEM ...]``.

For each system and accuracy: what was asked, estimated and true, by which method and step, and at what cost. The truth
is a Taylor series by heyoka at 1e-18, whose gravity is written apart from ours; where there is none, and over so many
orbits that its round-off shows, a run of order 10 with steps a sixth as long as needed.
"""

import sys
import time
import warnings
from collections.abc import Callable, Iterator, Sequence
from importlib import util
from typing import NamedTuple

import astropy.units as u
import numpy as np

import binaryast as ba
from validation import differences
from validation.cases import kepler, pluto_charon, triple
from validation.systems import four_bodies, tumbling_pair, wobbling_pair

ASKED = (1e-5, 1e-7, 1e-9)
ROUNDING = 1e-11  # beside which an error is not looked at any more
LONGEST = 3000.0  # revolutions of the fastest spin and orbit that the Taylor series is used for

Pair = tuple[ba.System, ba.State]


class Setting(NamedTuple):
    """What is run, and for how long."""

    make: Callable[[], Pair]
    duration: u.Quantity


SETTINGS = {
    "didymos, a day": Setting(lambda: ba.catalogue.load("didymos"), 1 * u.day),
    "didymos": Setting(lambda: ba.catalogue.load("didymos"), 60 * u.day),
    "didymos, second degree": Setting(lambda: with_gravity("didymos", ba.SecondDegree()), 60 * u.day),
    "moshup": Setting(lambda: ba.catalogue.load("moshup"), 60 * u.day),
    "patroclus": Setting(lambda: ba.catalogue.load("patroclus"), 365 * u.day),
    "sn263": Setting(lambda: ba.catalogue.load("sn263"), 100 * u.day),
    "dumbbells, before": Setting(lambda: ba.catalogue.load("dumbbells"), 5 * u.s),
    "dumbbells, past the encounter": Setting(lambda: ba.catalogue.load("dumbbells"), 15 * u.s),
    "wobbling pair": Setting(wobbling_pair, 10 * u.day),
    "tumbling pair": Setting(tumbling_pair, 20 * u.h),
    "four bodies": Setting(four_bodies, 5 * u.day),
    "eccentric, 0.3": Setting(lambda: eccentric(0.3), 30 * u.day),
    "eccentric, 0.8": Setting(lambda: eccentric(0.8), 30 * u.day),
    "points, e = 0.9": Setting(lambda: kepler.orbit("points", 0.9, ba.PointMass()), 30 * u.day),
    "Pluto and Charon": Setting(pluto_charon.pluto_and_charon, 365 * u.day),
    "sn263 and a craft": Setting(triple.sn263_and_craft, 30 * u.day),
}


class Result(NamedTuple):
    """What came of an accuracy that was asked for."""

    asked: float
    estimated: float
    true: float
    run: ba.Trajectory
    seconds: float


def with_gravity(name: str, gravity: ba.SecondDegree) -> Pair:
    """Return a catalogue entry with another gravity."""
    system, state = ba.catalogue.load(name)
    return ba.System(system.bodies, gravity), state


def eccentric(e: float) -> Pair:
    """Return a wobbling ellipsoid and a sphere on an eccentric orbit, which is regular; begun at the apocentre."""
    primary, other = tumbling_pair()[0].bodies
    system = ba.System([primary, ba.RigidBody("B", ba.Sphere(80 * u.m), mass=other.mass)])
    spins = [[3e-5, -2e-5, 7e-4], [0, 0, 2e-4]] * u.rad / u.s
    pericentre = 1100 * u.m
    state = ba.State.from_elements(
        system, semi_major_axis=pericentre / (1 - e), eccentricity=e, true_anomaly=180 * u.deg, spins=list(spins)
    )
    return system, state


def error(one: ba.State, two: ba.State) -> float:
    """Return the largest error: positions from the primary's over the distance from it, attitudes [rad]."""
    x, y = (state.si.position[1:] - state.si.position[0] for state in (one, two))
    position = np.linalg.norm(x - y, axis=1) / np.linalg.norm(y, axis=1)
    return float(max(position.max(), differences.turns(one.si.attitude, two.si.attitude).max()))


def truth(system: ba.System, state: ba.State, duration: u.Quantity, step: u.Quantity) -> ba.State:
    """Return where a run truly ends; ``step`` is one that is good enough for 1e-9."""
    options = {"duration": duration, "save_every": duration}
    if util.find_spec("heyoka") is not None and duration / step < LONGEST:
        return ba.propagate(system, state, integrator=ba.Taylor(1e-18), **options)[-1]
    return ba.propagate(system, state, integrator=ba.Splitting(step / 6, "ss10"), **options)[-1]


def results(setting: Setting, asked: Sequence[float] = ASKED) -> Iterator[Result]:
    """Yield what comes of each accuracy, the tightest first."""
    system, state = setting.make()
    true: ba.State | None = None
    for accuracy in sorted(asked):
        began = time.perf_counter()
        run = ba.propagate(system, state, duration=setting.duration, accuracy=accuracy)
        seconds = time.perf_counter() - began
        true = truth(system, state, setting.duration, run.step) if true is None else true
        yield Result(accuracy, float(run.estimated_error or np.nan), error(run[-1], true), run, seconds)


def main(names: Sequence[str]) -> int:
    """Print the table; return 1 where an accuracy is missed, undercut a hundredfold, or badly estimated."""
    print("| system | asked | estimated | true | method | step, s | steps | run, ms | with trials, ms |")
    print("|---|---|---|---|---|---|---|---|---|")
    wrong = 0
    for name in names or SETTINGS:
        for result in results(SETTINGS[name]):
            run = result.run
            method = f"{type(run.integrator).__name__} {run.integrator.shares.name}"
            good = result.true <= result.asked and (result.true >= result.asked / 100 or result.true < ROUNDING)
            good = good and result.estimated >= result.true / 10
            wrong += not good
            print(
                f"| {name} | {result.asked:.0e} | {result.estimated:.1e} | {result.true:.1e}{'' if good else ' !'} | "
                f"{method} | {run.step.value:.4g} | {run.steps} | {run.wall_time.to_value('ms'):.3g} | "
                f"{1e3 * result.seconds:.3g} |",
                flush=True,
            )
    return 1 if wrong else 0


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.BinaryastWarning)
        sys.exit(main(sys.argv[1:]))
