"""A pair as the production steps see it: the working state, the constants and surfaces beside it, and back.

The layout is that of ``kernels/layout.py``. The barycentre moves uniformly, so it is no part of the working state.
"""

from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.kernels import layout
from binaryast.kernels.contact import HEADER, SPACING
from binaryast.kernels.lgvi import prepare
from binaryast.kernels.so3 import quaternion_to_matrix
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats


class Barycentre(NamedTuple):
    """Where the barycentre is at the start, and how fast it moves (3,), (3,)."""

    position: Floats
    velocity: Floats


class Motion(NamedTuple):
    """The motion of a pair, time first and primary first: (N, 2, 3), (N, 2, 3), (N, 2, 3, 3), (N, 2, 3), and U (N,)."""

    position: Floats
    velocity: Floats
    attitude: Floats
    spin: Floats
    potential_energy: Floats


def constants(system: System) -> Floats:
    """Return the constants of a pair."""
    result = np.empty(layout.CONSTANTS_SIZE)
    result[layout.REDUCED_MASS] = system.reduced_mass
    for body, inverse, ratios in (
        (system.primary, layout.INVERSE_2, layout.RATIOS_2),
        (system.secondary, layout.INVERSE_1, layout.RATIOS_1),
    ):
        a, b, c = body.si.moments
        result[inverse : inverse + 3] = 1 / a, 1 / b, 1 / c
        result[ratios : ratios + 3] = (b - c) / a, (c - a) / b, (a - b) / c
    return result


def surfaces(system: System) -> Floats:
    """Return the surfaces of a pair for the contact kernel; a distance of zero where one of them has none."""
    two, one = system.primary.surface, system.secondary.surface
    reach = system.primary.bounding_radius + system.secondary.bounding_radius if one and two else 0.0
    pieces = [np.concatenate([centre, matrix[np.triu_indices(3)]]) for centre, matrix in two + one]
    smallest = min((np.sqrt(np.linalg.eigvalsh(matrix)[0]) for _, matrix in two + one), default=1.0)
    surfaces = np.zeros(HEADER)
    surfaces[:3] = reach, len(two), len(one)
    surfaces[SPACING] = smallest / 2
    return np.concatenate([surfaces, *pieces])


def barycentre(system: System, state: State) -> Barycentre:
    """Return the barycentre of a state."""
    shares = _shares(system)
    return Barycentre(shares @ state.si.position, shares @ state.si.velocity)


def to_working(system: System, state: State) -> Floats:
    """Return the working state, complete with what its configuration exerts.

    Raises
    ------
    InputError
        Where gravity is not a number there, or a user's potential raises.
    """
    working = np.zeros(layout.STATE_SIZE)
    position, velocity, attitude, spin = state.si
    working[layout.POSITION : layout.POSITION + 3] = position[1] - position[0]
    working[layout.VELOCITY : layout.VELOCITY + 3] = velocity[1] - velocity[0]
    quaternions = Rotation.from_matrix(attitude.copy()).as_quat()  # SciPy below 1.15 takes no read-only array
    for i, at_attitude, at_momentum in (
        (0, layout.ATTITUDE_2, layout.MOMENTUM_2),
        (1, layout.ATTITUDE_1, layout.MOMENTUM_1),
    ):
        working[at_attitude : at_attitude + 4] = quaternions[i]
        working[at_momentum : at_momentum + 3] = system.bodies[i].si.moments * spin[i]
    to_primary = attitude[0].T
    if np.any(working[layout.POSITION : layout.POSITION + 3]):  # mass centres in one place are refused as an overlap
        system.attraction(to_primary @ (position[1] - position[0]), to_primary @ attitude[1])
        prepare(working, system.gravity.potential, system.parameters)
    return working


def from_rows(system: System, rows: Floats, time: Floats, origin: Barycentre) -> Motion:
    """Return the inertial motion of both bodies from saved starts of working states at times since the start."""
    two, one = _shares(system)
    moving = origin.position + time[:, None] * origin.velocity
    x = rows[:, layout.POSITION : layout.POSITION + 3]
    v = rows[:, layout.VELOCITY : layout.VELOCITY + 3]
    quaternions = np.stack([rows[:, at : at + 4] for at in (layout.ATTITUDE_2, layout.ATTITUDE_1)], axis=1)
    momenta = np.stack([rows[:, at : at + 3] for at in (layout.MOMENTUM_2, layout.MOMENTUM_1)], axis=1)
    return Motion(
        position=np.stack([moving - one * x, moving + two * x], axis=1),
        velocity=np.stack([origin.velocity - one * v, origin.velocity + two * v], axis=1),
        attitude=_matrices(quaternions),
        spin=momenta / np.array([body.si.moments for body in system.bodies]),
        potential_energy=rows[:, layout.POTENTIAL].copy(),
    )


def _matrices(quaternions: Floats) -> Floats:
    """Return matrices (..., 3, 3) by the formula of the kernels, which shows a length that is not 1."""
    elements = quaternion_to_matrix.py_func(tuple(np.moveaxis(quaternions, -1, 0)))  # type: ignore[attr-defined]
    return np.asarray(np.stack(elements, axis=-1).reshape(*quaternions.shape[:-1], 3, 3))


def _shares(system: System) -> Floats:
    """Return each body's share of the mass, primary first."""
    masses = np.array([body.si.mass for body in system.bodies])
    return np.asarray(masses / masses.sum())
