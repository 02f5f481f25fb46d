"""What the tests share: a few systems, and a matplotlib that opens no windows."""

import hypothesis
import matplotlib as mpl
import numpy as np
import pytest
from validation.systems import tumbling_pair

import binaryast as ba

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
