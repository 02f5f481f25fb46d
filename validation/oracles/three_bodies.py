"""A pair and the Sun as three points that attract each other, with nothing taken apart: Newton's equations as they are.

heyoka's own n-body model in quadruple precision, whose 34 digits are enough to have the pair beside the Sun; REBOUND's
IAS15 in double precision, where an astronomical unit leaves few.
"""

import heyoka as hy
import numpy as np

import binaryast as ba
from validation.oracles import nbody, taylor
from validation.oracles.outside import Distant
from validation.oracles.taylor import REAL, Array, Units

IAS15_STEP = 600.0  # s


def starts(state: ba.State, distant: Distant, masses: Array) -> tuple[Array, Array]:
    """Return positions and velocities (3, 3) of the pair and the Sun about the barycentre of all, in SI."""
    x = np.vstack([state.si.position.astype(REAL), distant.x.astype(REAL)])
    v = np.vstack([state.si.velocity.astype(REAL), distant.v.astype(REAL)])
    shares = masses.astype(REAL) / masses.astype(REAL).sum()
    return x - shares @ x, v - shares @ v


def by_heyoka(system: ba.System, state: ba.State, distant: Distant, time: float) -> Array:
    """Return the secondary's place from the primary (3,) [m] after a time [s], in quadruple precision."""
    length, unit, _ = Units.of(system, state)
    gm = np.array([*(body.si.gm for body in system.bodies), distant.gm])
    x, v = starts(state, distant, gm)
    y = np.hstack([x / REAL(length), v * REAL(unit / length)]).ravel()
    masses = [REAL(value / length**3 * unit**2) for value in gm]
    end = taylor.integrate(hy.model.nbody(3, masses=masses), y, time / unit, precise=True).reshape(3, 6)
    return np.asarray((end[1, :3] - end[0, :3]) * REAL(length)).astype(float)


def by_ias15(system: ba.System, state: ba.State, distant: Distant, time: float) -> Array:
    """Return the same by REBOUND's IAS15, in SI and in double precision."""
    import rebound

    gm = np.array([*(body.si.gm for body in system.bodies), distant.gm])
    sim = rebound.Simulation()
    sim.G, sim.integrator = 1.0, "ias15"
    for m, x, v in zip(gm, *(array.astype(float) for array in starts(state, distant, gm)), strict=True):
        sim.add(m=m, x=x[0], y=x[1], z=x[2], vx=v[0], vy=v[1], vz=v[2])
    sim.integrator.epsilon, sim.dt = 0.0, IAS15_STEP  # its own steps are for the pull of the Sun: too long
    sim.integrate(time)
    position, _ = nbody.motion(sim)
    return np.asarray(position[1] - position[0])
