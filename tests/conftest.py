"""What the tests share: a few systems, and a matplotlib that opens no windows."""

import astropy.units as u
import hypothesis
import matplotlib as mpl
import numpy as np
import pytest
from validation.cases import tumbling_pair

import binaryast as ba
from binaryast.outcome import Watch
from binaryast.working import Working

mpl.use("agg")
hypothesis.settings.register_profile("patient", deadline=None)  # the first example may have to compile
hypothesis.settings.load_profile("patient")


@pytest.fixture(scope="session")
def didymos() -> ba.System:
    """The catalogue's pair."""
    return ba.catalogue.load("didymos")[0]


@pytest.fixture(scope="session")
def tumbling() -> tuple[ba.System, ba.State]:
    """`tumbling_pair`."""
    return tumbling_pair()


def attitude_angle(one: np.ndarray, two: np.ndarray) -> float:
    """Return the largest angle [rad] between two stacks of attitudes, exact for small ones."""
    return float(np.linalg.norm(one - two, axis=(-2, -1)).max() / np.sqrt(2))


def take_steps(w: Working, h: float, count: int) -> np.ndarray:
    """Take production steps, in place; return what was watched."""
    watch = Watch()
    watch.begin(w.measure(w.state, w.constants), 0.0)
    kernel = ba.LGVI(1 * u.s).kernel(inertial=len(w.before) > 3)
    rows = np.empty((1, w.row_size))
    arrays = (w.attraction, w.parameters, w.constants, np.zeros_like(w.surfaces), w.state, w.before, watch.array)
    status = w.advance(kernel, w.measure, w.touching, *arrays, h, count, count, rows)
    assert status == 0
    return watch.array
