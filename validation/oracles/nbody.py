"""Oracles of point masses: REBOUND's integrators, given our G, masses and starts, and closed forms beside them.

REBOUND is licensed under the GPL: it is called from here, and nothing of it is copied. The units that it offers
(``sim.units``) carry a G of their own, so they are never used: its simulations are in SI, with our G.

All bodies are points here. Spheres attract like points and turn freely, so their attitudes are in closed form.
"""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from validation.case import Check
from validation.methods import Method

if TYPE_CHECKING:
    import rebound

IN_EXTENDED = "in extended precision"  # a check of this name is left out where there is none
EXTENDED = bool(np.finfo(np.longdouble).eps < 1e-18)  # some machines have nothing longer than a double


def simulation(system: ba.System, position: np.ndarray, velocity: np.ndarray, integrator: str) -> "rebound.Simulation":
    """Return a simulation in SI with our G and masses."""
    import rebound  # an extra: without it other cases still run

    sim = rebound.Simulation()
    sim.G = ba.constants.G
    for body, x, v in zip(system.bodies, position, velocity, strict=True):
        sim.add(m=body.si.mass, x=x[0], y=x[1], z=x[2], vx=v[0], vy=v[1], vz=v[2])
    sim.integrator = integrator
    if integrator == "whfast":
        sim.integrator.safe_mode = 0  # half steps are joined: faster, and with less round-off
    return sim


def motion(sim: "rebound.Simulation") -> tuple[np.ndarray, np.ndarray]:
    """Return the positions and velocities (n, 3) of a simulation as they are now."""
    sim.synchronize()
    position, velocity = np.zeros((sim.N, 3)), np.zeros((sim.N, 3))
    sim.serialize_particle_data(xyz=position, vxvyvz=velocity)
    return position, velocity


def ias15(system: ba.System, state: ba.State, time: float) -> Snapshot:
    """Return the motion by IAS15, order 15 with steps of its own choice, spheres turning uniformly."""
    sim = simulation(system, state.si.position, state.si.velocity, "ias15")
    sim.dt = 1e-4 * time  # the first step; its own first step of 1 ms would only be made longer
    sim.integrate(time)
    return _snapshot(state, motion(sim), _turned(state, time))


def stepped(integrator: str) -> Method:
    """Return an integrator of REBOUND with equal steps as a method: ``leapfrog`` or ``whfast``, both of order 2."""

    def end(system: ba.System, state: ba.State, time: float, count: int) -> Snapshot:
        sim = simulation(system, state.si.position, state.si.velocity, integrator)
        sim.dt = time / count
        sim.steps(count)
        return _snapshot(state, motion(sim), _turned(state, time))

    return Method({"leapfrog": "REBOUND leapfrog", "whfast": "REBOUND WHFast"}[integrator], 2, end)


LEAPFROG = stepped("leapfrog")
WHFAST = stepped("whfast")


def acceleration(system: ba.System, position: np.ndarray) -> np.ndarray:
    """Return the accelerations (n, 3) of point masses, in the precision of their positions."""
    masses = np.array([body.si.mass for body in system.bodies], dtype=position.dtype)
    apart = position[None, :] - position[:, None]
    squares = np.einsum("ijk,ijk->ij", apart, apart)
    np.fill_diagonal(squares, np.inf)
    return ba.constants.G * np.einsum("j,ijk->ik", masses, apart / (squares * np.sqrt(squares))[:, :, None])


def kick_and_drift(
    system: ba.System, position: np.ndarray, velocity: np.ndarray, h: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion after half a kick and half a drift: from the nodes of one leapfrog to those of the other.

    With K and D for half a kick and half a drift, a step of ours is K D D K and one of REBOUND's leapfrog D K K D; so
    (D K)(K D D K) = (D K K D)(D K): after D K on the start both are the same map.
    """
    velocity = velocity + 0.5 * h * acceleration(system, position)
    return position + 0.5 * h * velocity, velocity


def drift_and_kick_back(
    system: ba.System, position: np.ndarray, velocity: np.ndarray, h: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the inverse of `kick_and_drift`."""
    position = position - 0.5 * h * velocity
    return position, velocity - 0.5 * h * acceleration(system, position)


def kick_drift_kick(system: ba.System, state: ba.State, time: float, count: int) -> Snapshot:
    """Return the motion by REBOUND's leapfrog between `kick_and_drift` and its inverse: the map that ours must be."""
    h = time / count
    sim = simulation(system, *kick_and_drift(system, state.si.position, state.si.velocity, h), "leapfrog")
    sim.dt = h
    sim.steps(count)
    return _snapshot(state, drift_and_kick_back(system, *motion(sim), h), _stepwise(state, time, count))


def rows(
    system: ba.System, state: ba.State, integrator: str, h: float, stride: int, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and velocities (count + 1, n, 3), one row every ``stride`` steps, by WHFast or `leapfrog`.

    The leapfrog's are those of `kick_drift_kick`.
    """
    shifted = integrator == "leapfrog"
    start = state.si.position, state.si.velocity
    sim = simulation(system, *(kick_and_drift(system, *start, h) if shifted else start), integrator)
    sim.dt = h
    moved = [start]
    for _ in range(count):
        sim.steps(stride)
        moved.append(drift_and_kick_back(system, *motion(sim), h) if shifted else motion(sim))
    position, velocity = zip(*moved, strict=True)
    return np.array(position), np.array(velocity)


def kick_drift_kick_extended(system: ba.System, state: ba.State, time: float, count: int) -> Snapshot:
    """Return the motion by the same map in extended precision, where the machine has one: free of round-off."""
    position, velocity = state.si.position.astype(np.longdouble), state.si.velocity.astype(np.longdouble)
    h = np.longdouble(time) / count
    pull = acceleration(system, position)
    for _ in range(count):
        velocity = velocity + h / 2 * pull
        position = position + h * velocity
        pull = acceleration(system, position)
        velocity = velocity + h / 2 * pull
    return _snapshot(state, (position.astype(float), velocity.astype(float)), _stepwise(state, time, count))


def kepler(system: ba.System, state: ba.State, time: float) -> Snapshot:
    """Return the exact motion of two bodies, by Lagrange's f and g and Kepler's equation, in extended precision."""
    gm = np.array([body.si.gm for body in system.bodies], dtype=np.longdouble)
    position, velocity = state.si.position.astype(np.longdouble), state.si.velocity.astype(np.longdouble)
    x, v = position[1] - position[0], velocity[1] - velocity[0]
    r = np.sqrt(x @ x)
    a = 1 / (2 / r - v @ v / gm.sum())
    n = np.sqrt(gm.sum() / a**3)
    cosine, sine = 1 - r / a, x @ v / (n * a**2)  # e cos E and e sin E at the start
    low, high = n * np.longdouble(time) - 3, n * np.longdouble(time) + 3
    for _ in range(80):  # by halves: how far E has come
        E = (low + high) / 2
        early = E - cosine * np.sin(E) + sine * (1 - np.cos(E)) < n * np.longdouble(time)
        low, high = (E, high) if early else (low, E)
    later = a * (1 - cosine * np.cos(E) + sine * np.sin(E))  # the distance
    f, g = 1 - a / r * (1 - np.cos(E)), (r / a * np.sin(E) + sine * (1 - np.cos(E))) / n
    df, dg = -n * a**2 / (r * later) * np.sin(E), 1 - a / later * (1 - np.cos(E))
    shares = np.array([[-gm[1]], [gm[0]]]) / gm.sum()
    centre, drift = gm @ position / gm.sum(), gm @ velocity / gm.sum()
    moved = centre + drift * time + shares * (f * x + g * v), drift + shares * (df * x + dg * v)
    return _snapshot(state, (moved[0].astype(float), moved[1].astype(float)), _turned(state, time))


def possible(checks: Sequence[Check]) -> list[Check]:
    """Return the checks without those against extended precision, where the machine has none."""
    return [check for check in checks if EXTENDED or IN_EXTENDED not in check.what]


def _stepwise(state: ba.State, time: float, count: int) -> np.ndarray:
    """Return the attitudes of spheres that a step turns by theta with sin(theta) = h Omega: (128), moments equal."""
    rates = np.linalg.norm(state.si.spin, axis=1, keepdims=True)
    return _turned(state, count * np.arcsin(time / count * rates) / np.where(rates > 0, rates, 1))


def _turned(state: ba.State, time: float | np.ndarray) -> np.ndarray:
    """Return the attitudes after so long of a uniform turn, which may differ from body to body (n, 1)."""
    return state.si.attitude @ Rotation.from_rotvec(time * state.si.spin).as_matrix()


def _snapshot(state: ba.State, moved: tuple[np.ndarray, np.ndarray], attitude: np.ndarray) -> Snapshot:
    position, velocity = moved
    return Snapshot(velocity, state.si.spin, position, attitude)
