"""Production steps without a driver: what the checks, the benchmark and the tests call."""

import astropy.units as u
import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from binaryast.integrators import Stepping
from binaryast.outcome import Watch
from binaryast.working import Working

SECOND_ORDER = ba.LGVI(1 * u.s)


def snapshot(w: Working, time: float = 0.0) -> Snapshot:
    """Return where a working state is now, ``time`` [s] after the start."""
    motion = w.from_rows(w.state[None, : w.row_size], np.array([time]))
    return Snapshot(motion.velocity[0], motion.spin[0], motion.position[0], motion.attitude[0])


def take_steps(
    w: Working, h: float, count: int, *, integrator: Stepping = SECOND_ORDER, save: int = 0, touching: bool = False
) -> np.ndarray:
    """Take watched steps of h [s], in place; return what was watched.

    The integrator's own step does not matter. ``save`` saves every so many steps, ``touching`` looks for contact.
    """
    watch = Watch()
    watch.begin(w.measure(w.state, w.constants), 0.0)
    kernel = integrator.kernel(inertial=w.inertial)
    stride = save or count
    rows = np.empty((count // stride, w.row_size))
    surfaces = w.surfaces if touching else np.zeros_like(w.surfaces)
    arrays = (
        integrator.shares.shares,
        w.attraction,
        w.parameters,
        w.external,
        w.constants,
        surfaces,
        w.state,
        w.before,
        watch.array,
    )
    status = w.advance(kernel, w.measure, w.touching, *arrays, h, count, stride, rows)
    if status != 0:
        raise RuntimeError(f"the loop of steps ended with status {status}")
    return watch.array
