"""The working arrays of several bodies, in the layout of ``kernels/bodies/layout.py``."""

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.bodies import RigidBody
from binaryast.gravity import PointMass
from binaryast.kernels.bodies import layout
from binaryast.kernels.bodies.contact import touching
from binaryast.kernels.bodies.loop import advance
from binaryast.kernels.bodies.measure import measure
from binaryast.kernels.bodies.stages import exert
from binaryast.kernels.pointers import table_of
from binaryast.perturbations.base import Span
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working.base import Motion, Working, check_gravity, matrices, ratios, spins
from binaryast.working.external import check_perturbations


class WorkingBodies(Working):
    """Any number of bodies: position, velocity, attitude and angular momentum of each about the barycentre."""

    inertial = True
    measure, touching, advance = staticmethod(measure), staticmethod(touching), staticmethod(advance)

    def __init__(self, system: System, state: State, span: Span | None = None) -> None:
        super().__init__(system, state, span)
        self.count = n = len(system.bodies)
        self.row_size, self.potential_at = layout.row_size_of(n), layout.potential_of(n)
        self.attraction = table_of([pair.potential for pair in system.pairs])
        self.parameters = np.concatenate([pair.parameters for pair in system.pairs])
        self.constants = constants(system)
        self.state = np.zeros(layout.size_of(n))
        position, velocity, attitude, spin = state.si
        moments = np.array([body.si.moments for body in system.bodies])
        motion = (
            position - self.origin[0],
            velocity - self.origin[1],
            Rotation.from_matrix(attitude.copy()).as_quat(),
            moments * spin,
        )
        self.state[: layout.MOTION * n] = np.concatenate([part.ravel() for part in motion])
        check_gravity(system, state)
        if self.disturbed:
            self.extend()
            check_perturbations(system, state, self.origin, self.span)
        self.before = self.state.copy()
        self.exert()

    def extend(self) -> None:
        """Make room in the state for what outside action needs, and take what watches it."""
        from binaryast.kernels.bodies.disturbed import measure

        super().extend()
        self.measure = measure

    def exert(self) -> None:
        """Fill in what the motion in the state exerts."""
        if not self.disturbed:
            exert(self.state, self.constants, self.attraction, self.parameters)
            return
        from binaryast.kernels.bodies.disturbed import exert_all

        exert_all(self.state, self.constants, self.attraction, self.parameters, self.external)

    def centres(self, rows: Floats) -> Floats:
        """Return by how much the barycentre (N, 3) was moved up to saved rows."""
        return np.asarray(self.shares @ rows[:, : 3 * self.count].reshape(-1, self.count, 3))

    def from_rows(self, rows: Floats, time: Floats) -> Motion:
        """Return the inertial motion of all bodies from saved starts of working states at times since the start."""
        n = self.count
        position, velocity, quaternion, momentum, potential, _ = np.split(
            rows,
            [f(n) for f in (layout.velocity_of, layout.attitude_of, layout.momentum_of, layout.potential_of)]
            + [layout.potential_of(n) + 1],
            axis=1,
        )
        return Motion(
            position=self.moving_origin(time) + position.reshape(-1, n, 3),
            velocity=self.origin[1] + velocity.reshape(-1, n, 3),
            attitude=matrices(quaternion.reshape(-1, n, 4)),
            spin=spins(self.system, momentum.reshape(-1, n, 3)),
            potential_energy=potential[:, 0].copy(),
            **self.given(rows),
        )

    def momentum_and_torque(self, body: int) -> tuple[Floats, Floats]:
        """Return a body's angular momentum and the torque on it, both in its own frame."""
        momentum = layout.momentum_of(self.count) + 3 * body
        torque = layout.torque_of(self.count) + 3 * body
        return self.state[momentum : momentum + 3], self.state[torque : torque + 3]


def constants(system: System) -> Floats:
    """Return the constants of several bodies and their pairs."""
    parts = [np.array([len(system.bodies), len(system.pairs)], dtype=float)]
    for body in system.bodies:
        inverse, differences = ratios(body.si.moments)
        parts.append(np.concatenate([[body.si.mass, body.is_point], inverse, differences, [body.pulls]]))
    begin = 0
    for pair in system.pairs:
        end = begin + len(pair.parameters)
        felt_by = felt(system.bodies[pair.primary], system.bodies[pair.secondary])
        as_points = isinstance(pair.gravity, PointMass) and felt_by == layout.BOTH
        parts.append(np.array([pair.primary, pair.secondary, begin, end, as_points, felt_by], dtype=float))
        begin = end
    return np.concatenate(parts)


def felt(primary: RigidBody, secondary: RigidBody) -> float:
    """Return who feels the attraction of a pair: a body that does not pull leaves the other in peace."""
    if not secondary.pulls:
        return layout.ONLY_SECONDARY
    return layout.BOTH if primary.pulls else layout.ONLY_PRIMARY
