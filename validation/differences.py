"""How far two moments of a motion are apart: position, velocity, attitude and spin, of each body or the largest."""

from typing import Generic, NamedTuple, TypeVar

import numpy as np

import binaryast as ba
from binaryast.equations.legendre import Snapshot

Number = TypeVar("Number", float, np.ndarray)


class Difference(NamedTuple, Generic[Number]):
    """Position and velocity over those of the second body from the first; attitude [rad]; spin, relative."""

    position: Number
    velocity: Number
    attitude: Number
    spin: Number

    @property
    def largest(self) -> float:
        """The largest of all, not a number where one is none."""
        return float(np.max(self))


def snapshot_of(state: ba.State) -> Snapshot:
    """Return a state as the arrays that differences are taken of."""
    position, velocity, attitude, spin = state.si
    return Snapshot(velocity, spin, position, attitude)


def of_bodies(one: Snapshot, two: Snapshot) -> Difference[np.ndarray]:
    """Return how far two moments are apart, body by body (n,), the second being the measure."""
    spins = np.linalg.norm(two.Omega, axis=1)
    spin = np.linalg.norm(one.Omega - two.Omega, axis=1)
    return Difference(
        np.linalg.norm(one.x - two.x, axis=1) / np.linalg.norm(two.x[1] - two.x[0]),
        np.linalg.norm(one.v - two.v, axis=1) / np.linalg.norm(two.v[1] - two.v[0]),
        turns(one.R, two.R),
        np.divide(spin, spins, out=np.where(spin > 0, np.inf, 0.0), where=spins > 0),
    )


def difference(one: Snapshot, two: Snapshot) -> Difference[float]:
    """Return how far two moments are apart: the largest of all bodies."""
    return Difference(*(float(np.max(values)) for values in of_bodies(one, two)))


def turns(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """Return the angles [rad] between two stacks of attitudes (..., 3, 3), exact for small ones."""
    return np.linalg.norm(one - two, axis=(-2, -1)) / np.sqrt(2)
