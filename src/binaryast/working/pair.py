"""The working arrays of a pair, in the layout of ``kernels/pair/layout.py``."""

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.kernels.external import layout as external_layout
from binaryast.kernels.pair import layout
from binaryast.kernels.pair.contact import touching
from binaryast.kernels.pair.loop import advance
from binaryast.kernels.pair.measure import measure
from binaryast.kernels.pair.stages import prepare
from binaryast.perturbations.base import Span
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working.base import Motion, Working, check_gravity, matrices, ratios, spins
from binaryast.working.external import check_perturbations

ATTITUDES = (layout.ATTITUDE_2, layout.ATTITUDE_1)  # primary first
MOMENTA = (layout.MOMENTUM_2, layout.MOMENTUM_1)
TORQUES = (layout.TORQUE_2, layout.TORQUE_1)
INVERSES = (layout.INVERSE_2, layout.INVERSE_1)
RATIOS = (layout.RATIOS_2, layout.RATIOS_1)


class WorkingPair(Working):
    """A pair: the relative position, and attitude and angular momentum of both bodies."""

    inertial = False
    row_size = layout.ROW_SIZE
    potential_at = layout.POTENTIAL
    measure, touching, advance = staticmethod(measure), staticmethod(touching), staticmethod(advance)

    def __init__(self, system: System, state: State, span: Span | None = None) -> None:
        super().__init__(system, state, span)
        self.attraction, self.parameters = system.pairs[0].potential, system.parameters
        self.constants = np.empty(layout.CONSTANTS_SIZE)
        self.constants[layout.REDUCED_MASS] = system.reduced_mass
        self.constants[[layout.SHARE_2, layout.SHARE_1]] = self.shares
        self.constants[layout.INVERSE_MASS] = 1 / self.masses.sum()
        self.constants[layout.GM] = sum(body.si.gm for body in system.bodies)
        self.state = np.zeros(layout.STATE_SIZE)
        position, velocity, attitude, spin = state.si
        self.state[layout.POSITION : layout.POSITION + 3] = position[1] - position[0]
        self.state[layout.VELOCITY : layout.VELOCITY + 3] = velocity[1] - velocity[0]
        quaternions = Rotation.from_matrix(attitude.copy()).as_quat()  # SciPy below 1.15 takes no read-only array
        for i, body in enumerate(system.bodies):
            inverse, differences = ratios(body.si.moments)
            self.constants[INVERSES[i] : INVERSES[i] + 3] = inverse
            self.constants[RATIOS[i] : RATIOS[i] + 3] = differences
            self.state[ATTITUDES[i] : ATTITUDES[i] + 4] = quaternions[i]
            self.state[MOMENTA[i] : MOMENTA[i] + 3] = body.si.moments * spin[i]
        check_gravity(system, state)
        if self.disturbed:
            self.extend()
            check_perturbations(system, state, self.origin, self.span)
        self.before = self.state.copy()
        if np.any(self.state[layout.POSITION : layout.POSITION + 3]):
            self.exert()

    def extend(self) -> None:
        """Make room in the state for what outside action needs, and take what watches and completes it."""
        from binaryast.kernels.pair.disturbed import measure

        super().extend()
        self.measure = measure

    def exert(self) -> None:
        """Fill in what the motion in the state exerts."""
        if not self.disturbed:
            prepare(self.state, self.attraction, self.parameters)
            return
        from binaryast.kernels.pair.disturbed import prepare as prepare_disturbed

        prepare_disturbed(self.state, self.constants, self.attraction, self.parameters, self.external)

    def centres(self, rows: Floats) -> Floats:
        """Return by how much the barycentre (N, 3) was moved up to saved rows."""
        begin = self.extra + external_layout.CENTRE
        return rows[:, begin : begin + 3]

    def from_rows(self, rows: Floats, time: Floats) -> Motion:
        """Return the inertial motion of both bodies from saved starts of working states at times since the start."""
        moving, (_, drift) = self.moving_origin(time), self.origin
        two, one = self.shares
        factors = np.array([[-one], [two]])
        x = rows[:, None, layout.POSITION : layout.POSITION + 3]
        v = rows[:, None, layout.VELOCITY : layout.VELOCITY + 3]
        quaternions = np.stack([rows[:, at : at + 4] for at in ATTITUDES], axis=1)
        momenta = np.stack([rows[:, at : at + 3] for at in MOMENTA], axis=1)
        given = self.given(rows)
        if self.disturbed:
            moving = moving + self.centres(rows)[:, None]
            drift = drift + given["impulse"][:, None] / self.masses.sum()
        return Motion(
            position=moving + factors * x,
            velocity=drift + factors * v,
            attitude=matrices(quaternions),
            spin=spins(self.system, momenta),
            potential_energy=rows[:, layout.POTENTIAL].copy(),
            **given,
        )

    def momentum_and_torque(self, body: int) -> tuple[Floats, Floats]:
        """Return a body's angular momentum and the torque on it, both in its own frame."""
        return self.state[MOMENTA[body] : MOMENTA[body] + 3], self.state[TORQUES[body] : TORQUES[body] + 3]
