"""What the working arrays of a pair and of several bodies have in common."""

from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cache
from typing import Any, NamedTuple

import numpy as np

from binaryast.kernels import contact
from binaryast.kernels.external import layout as external_layout
from binaryast.kernels.external.arguments import External
from binaryast.kernels.so3 import quaternion_to_matrix
from binaryast.perturbations.base import Span
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working.external import extended, external_of


class Motion(NamedTuple):
    """The motion of n bodies, time first: (N, n, 3), (N, n, 3), (N, n, 3, 3), (N, n, 3), and U (N,).

    Then what was given from outside since the start: work (N,), linear (N, 3) and angular momentum (N, 3), the work and
    the latter about the barycentre.
    """

    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats
    potential_energy: Floats
    work: Floats
    impulse: Floats
    angular_impulse: Floats


GIVEN = Motion._fields[-3:]


def nothing_given(count: int) -> dict[str, Floats]:
    """Return what was given from outside where there is nothing: arrays of zeros that take no room, to be read only."""
    shapes = {"work": (count,), "impulse": (count, 3), "angular_impulse": (count, 3)}
    return {name: np.broadcast_to(0.0, shape) for name, shape in shapes.items()}


def coinciding(system: System, position: Floats) -> int:
    """Return which pair of mass centres (n, 3) lies in one place, counted from 1, or 0."""
    for k, pair in enumerate(system.pairs, start=1):
        if np.array_equal(position[pair.primary], position[pair.secondary]):
            return k
    return 0


class Working(ABC):
    """The arrays that the compiled loop works on, and the compiled functions that know their layout.

    Attributes
    ----------
    inertial : bool
        Whether it is that of several bodies.
    state : ndarray
        The working state: what a step changes, and a checkpoint.
    before : ndarray
        Room for the state before a step.
    constants, surfaces, parameters : ndarray
        Masses and moments; what may touch; what the potentials need.
    attraction : object
        The potential of a pair, or the table of one for each pair.
    external : External
        What acts from outside.
    row_size, potential_at : int
        How much of the state a saved row keeps, and where in it U is.
    measure, touching, advance : callable
        What is watched at a step, what touches in it, and the loop of steps.
    """

    inertial: bool
    state: Floats
    before: Floats
    constants: Floats
    parameters: Floats
    attraction: Any
    external: External
    row_size: int
    potential_at: int
    measure: Callable[..., Any]
    touching: Callable[..., Any]
    advance: Callable[..., Any]

    def __init__(self, system: System, state: State, span: Span | None) -> None:
        self.system = system
        self.masses = np.array([body.si.mass * body.pulls for body in system.bodies])
        self.shares = self.masses / self.masses.sum()
        self.origin = self.shares @ state.si.position, self.shares @ state.si.velocity
        self.surfaces = surfaces(system)
        self.span = span or Span(0.0, 0.0, None, state.frame)
        self.disturbed = bool(span is not None and system.perturbations)
        self.external = external_of(system, self.span) if self.disturbed else nothing_external()

    @abstractmethod
    def exert(self) -> None:
        """Fill in what the motion in the state exerts."""

    @abstractmethod
    def from_rows(self, rows: Floats, time: Floats) -> Motion:
        """Return the inertial motion of all bodies from saved starts of working states at times since the start."""

    @abstractmethod
    def momentum_and_torque(self, body: int) -> tuple[Floats, Floats]:
        """Return a body's angular momentum and the torque on it, both in its own frame."""

    @property
    def extra(self) -> int:
        """Where in the state the numbers begin that outside action needs."""
        return self.state.size - external_layout.SIZE

    def extend(self) -> None:
        """Make room in the state for what outside action needs, and look at it."""
        self.state = extended(self.state, self.span.begin)
        self.row_size = self.extra + external_layout.KEPT

    def given(self, rows: Floats) -> dict[str, Floats]:
        """Return what was given from outside up to saved rows, about the barycentre, which it moves."""
        if not self.disturbed:
            return nothing_given(len(rows))
        numbers = rows[:, self.extra :]
        at = external_layout
        linear, angular = numbers[:, at.LINEAR : at.LINEAR + 3], numbers[:, at.ANGULAR : at.ANGULAR + 3]
        work = numbers[:, at.WORK] - 0.5 * np.sum(linear**2, axis=1) / self.masses.sum()
        orbit = np.cross(self.centres(rows), linear)
        return {"work": work, "impulse": linear.copy(), "angular_impulse": angular - orbit}

    @abstractmethod
    def centres(self, rows: Floats) -> Floats:
        """Return by how much the barycentre (N, 3) was moved up to saved rows."""

    def moving_origin(self, time: Floats) -> Floats:
        """Return the barycentre (N, 1, 3) at times since the start: it moves uniformly, so no step carries it."""
        position, velocity = self.origin
        return np.asarray((position + time[:, None] * velocity)[:, None, :])


@cache
def nothing_external() -> External:
    """Return what acts from outside where nothing does."""
    table, none, no_rows = np.zeros(0, dtype=np.int64), np.zeros(0), np.zeros((0, 3))
    return External(table, table, none, table, no_rows, no_rows, np.zeros((0, 3, 3)), no_rows, no_rows, no_rows, none)


def check_gravity(system: System, state: State) -> None:
    """Raise where a pair's gravity is not a number at a state; mass centres in one place are refused as an overlap."""
    position, _, attitude, _ = state.si
    for pair in system.pairs:
        x = position[pair.secondary] - position[pair.primary]
        if np.any(x):
            to_primary = attitude[pair.primary].T
            system.attraction(to_primary @ x, to_primary @ attitude[pair.secondary], pair)


def surfaces(system: System) -> Floats:
    """Return the surfaces of all bodies for the contact kernels."""
    bodies = system.bodies
    header = np.zeros((len(bodies), contact.HEADER))
    pieces: list[Floats] = []
    for i, body in enumerate(bodies):
        surface = body.surface
        first = header.size + contact.PIECE * len(pieces)
        smallest = min((np.sqrt(max(np.linalg.eigvalsh(matrix)[0], 0.0)) for _, matrix in surface), default=0.0)
        header[i] = body.bounding_radius, smallest, first, len(surface), body.pulls
        pieces += [np.concatenate([centre, matrix[np.triu_indices(3)]]) for centre, matrix in surface]
    return np.concatenate([header.ravel(), *pieces])


def ratios(moments: Floats) -> tuple[Floats, Floats]:
    """Return 1/I_i and (I_j - I_k)/I_i, cyclic, of principal moments; zeros for a point."""
    if not np.any(moments):
        return np.zeros(3), np.zeros(3)
    a, b, c = moments
    return 1 / moments, np.array([(b - c) / a, (c - a) / b, (a - b) / c])


def spins(system: System, momenta: Floats) -> Floats:
    """Return the spins of angular momenta (N, n, 3); a point has none."""
    moments = np.array([body.si.moments for body in system.bodies])
    return np.asarray(np.divide(momenta, moments, out=np.zeros_like(momenta), where=moments > 0))


def matrices(quaternions: Floats) -> Floats:
    """Return the rotations (..., 3, 3) nearest to the matrices of quaternions.

    The formula rounds each element several times; Newton's step for the polar factor leaves one rounding of each.
    """
    elements = quaternion_to_matrix.py_func(tuple(np.moveaxis(quaternions, -1, 0)))  # type: ignore[attr-defined]
    r = np.stack(elements, axis=-1).reshape(*quaternions.shape[:-1], 3, 3)
    return np.asarray(r + 0.5 * r @ (np.eye(3) - np.swapaxes(r, -1, -2) @ r))
