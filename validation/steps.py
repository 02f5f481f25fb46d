"""Production steps without a driver: what the checks, the benchmark and the tests call."""

import astropy.units as u
import numpy as np

import binaryast as ba
from binaryast.outcome import Watch
from binaryast.working import Working


def take_steps(w: Working, h: float, count: int, *, save: int = 0, touching: bool = False) -> np.ndarray:
    """Take watched steps of h [s], in place; return what was watched.

    ``save`` saves every so many steps, ``touching`` looks for contact.
    """
    watch = Watch()
    watch.begin(w.measure(w.state, w.constants), 0.0)
    kernel = ba.LGVI(1 * u.s).kernel(inertial=w.inertial)
    stride = save or count
    rows = np.empty((count // stride, w.row_size))
    surfaces = w.surfaces if touching else np.zeros_like(w.surfaces)
    arrays = (w.attraction, w.parameters, w.constants, surfaces, w.state, w.before, watch.array)
    status = w.advance(kernel, w.measure, w.touching, *arrays, h, count, stride, rows)
    if status != 0:
        raise RuntimeError(f"the loop of steps ended with status {status}")
    return watch.array
