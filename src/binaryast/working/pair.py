"""The working arrays of a pair, in the layout of ``kernels/pair/layout.py``."""

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.kernels.pair import layout
from binaryast.kernels.pair.contact import touching
from binaryast.kernels.pair.loop import advance
from binaryast.kernels.pair.measure import measure
from binaryast.kernels.pair.stages import prepare
from binaryast.state import State
from binaryast.system import System
from binaryast.units import Floats
from binaryast.working.base import Motion, Working, check_gravity, matrices, ratios, spins

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

    def __init__(self, system: System, state: State) -> None:
        super().__init__(system, state)
        self.attraction, self.parameters = system.pairs[0].potential, system.parameters
        self.constants = np.empty(layout.CONSTANTS_SIZE)
        self.constants[layout.REDUCED_MASS] = system.reduced_mass
        self.constants[layout.GM] = sum(body.si.gm for body in system.bodies)
        self.state = np.zeros(layout.STATE_SIZE)
        self.before = self.state.copy()
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
        if np.any(self.state[layout.POSITION : layout.POSITION + 3]):
            self.exert()

    def exert(self) -> None:
        """Fill in what the motion in the state exerts."""
        prepare(self.state, self.attraction, self.parameters)

    def from_rows(self, rows: Floats, time: Floats) -> Motion:
        """Return the inertial motion of both bodies from saved starts of working states at times since the start."""
        moving, (_, drift) = self.moving_origin(time), self.origin
        two, one = self.shares
        factors = np.array([[-one], [two]])
        x = rows[:, None, layout.POSITION : layout.POSITION + 3]
        v = rows[:, None, layout.VELOCITY : layout.VELOCITY + 3]
        quaternions = np.stack([rows[:, at : at + 4] for at in ATTITUDES], axis=1)
        momenta = np.stack([rows[:, at : at + 3] for at in MOMENTA], axis=1)
        return Motion(
            position=moving + factors * x,
            velocity=drift + factors * v,
            attitude=matrices(quaternions),
            spin=spins(self.system, momenta),
            potential_energy=rows[:, layout.POTENTIAL].copy(),
        )

    def momentum_and_torque(self, body: int) -> tuple[Floats, Floats]:
        """Return a body's angular momentum and the torque on it, both in its own frame."""
        return self.state[MOMENTA[body] : MOMENTA[body] + 3], self.state[TORQUES[body] : TORQUES[body] + 3]
