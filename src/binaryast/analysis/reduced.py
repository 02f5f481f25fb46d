"""The reduced motion of a pair in numbers of order one, to find where it stands still and how it moves near there.

Everything is in the frame of one of the bodies, the paper's body 2; lengths over a separation r, times over that of a
turn there, masses over the reduced mass m. Variables are (63)-(67): X, a turn theta of R = exp(theta) R0, Gamma, Pi and
Pi2.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial.transform import Rotation

from binaryast.system import System
from binaryast.units import Floats

EQUAL = 1e-12  # relative difference of moments of inertia of a round body
STENCIL = np.array([4 / 5, -1 / 5, 4 / 105, -1 / 280])  # central differences of order 8
STEP = 4e-3  # of them, in numbers of order one: their error and the round-off are below 1e-12


class Pull(NamedTuple):
    """dU/dX (3,), the torques on the body that is seen and on the one whose frame it is (3,), and U."""

    gradient: Floats
    torque_seen: Floats
    torque_own: Floats
    energy: float


@dataclass(frozen=True, eq=False)
class Reduced:
    """A pair seen from one of its bodies.

    Parameters
    ----------
    system : System
        The pair.
    swapped : bool
        Whether the frame is that of the secondary: where the primary is round, and has none of its own.
    separation, rate : float
        Units of length [m] and of 1/time [rad/s].
    """

    system: System
    swapped: bool
    separation: float
    rate: float

    @property
    def moments(self) -> tuple[Floats, Floats]:
        """Principal moments of the body that is seen, and of the one whose frame it is (3,), over m r^2."""
        both = [body.si.moments / (self.system.reduced_mass * self.separation**2) for body in self.system.bodies]
        return (both[0], both[1]) if self.swapped else (both[1], both[0])

    def pull(self, x: Floats, r: Floats) -> Pull:
        """Return what the bodies feel at X and R, in this frame."""
        size = self.system.reduced_mass * self.separation * self.rate**2
        length = self.separation
        place, turn = (-length * (r.T @ x), r.T) if self.swapped else (length * x, r)
        found = np.array(self.system.attraction(place, turn))
        gradient, moment = found[1:4], found[4:]
        torques = -moment, np.cross(place, gradient) + moment  # on the secondary, and on the primary
        if self.swapped:  # turned into the secondary's frame; the force is on the primary, which is seen
            gradient, torques = -r @ gradient, (r @ torques[1], r @ torques[0])
        seen, own = torques
        return Pull(gradient / size, seen / (size * length), own / (size * length), found[0] / (size * length))

    def imbalance(self, x: Floats, r: Floats, rate: Floats) -> Floats:
        """Return what is left of the force and both torques (9,) where everything turns as one: (63)-(65).

        Torques are over the moments of their bodies.
        """
        seen, own = self.moments
        found = self.pull(x, r)
        spin = r @ (seen * (r.T @ rate))
        return np.concatenate(
            [
                -found.gradient - np.cross(rate, np.cross(rate, x)),
                (found.torque_seen - np.cross(rate, spin)) / _size(seen),
                (found.torque_own - np.cross(rate, own * rate)) / _size(own),
            ]
        )

    def matrix(self, x: Floats, r: Floats, rate: Floats, seen_turns: bool) -> Floats:
        """Return the linear motion about an equilibrium: (15, 15), or (9, 9) where what is seen is round."""
        seen, own = self.moments

        def rates(z: Floats) -> Floats:
            place, theta, gamma, Pi, Pi2 = z.reshape(5, 3)
            turned = Rotation.from_rotvec(theta).as_matrix() @ r
            found = self.pull(place, turned)
            Omega = turned @ ((turned.T @ Pi) / np.where(seen > 0, seen, 1.0)) if np.any(seen) else np.zeros(3)
            Omega2 = Pi2 / np.where(own > 0, own, 1.0)
            return np.concatenate(
                [
                    gamma - np.cross(Omega2, place),  # (66)
                    Omega - Omega2,  # (67), to first order
                    -found.gradient - np.cross(Omega2, gamma),  # (63)
                    found.torque_seen - np.cross(Omega2, Pi),  # (64)
                    found.torque_own - np.cross(Omega2, Pi2),  # (65)
                ]
            )

        start = np.concatenate([x, np.zeros(3), np.cross(rate, x), r @ (seen * (r.T @ rate)), own * rate])
        scale = np.repeat([1.0, 1.0, 1.0, _size(seen), _size(own)], 3)
        kept = np.arange(15) if seen_turns else np.r_[0:3, 6:9, 12:15]
        columns = [derivative(lambda h, k=k: rates(start + h * scale * np.eye(15)[k])) for k in kept]  # type: ignore[misc]
        return np.asarray((np.column_stack(columns) / scale[:, None])[kept])

    def is_round(self, seen: bool, x: Floats, r: Floats) -> bool:
        """Whether a body has equal moments, and gravity does not see its attitude: a point, or a sphere."""
        moments = self.moments[0 if seen else 1]
        if np.ptp(moments) > EQUAL * moments.max():
            return False
        energy = self.pull(x, r).energy
        for turn in Rotation.from_rotvec([[0.3, 0.4, 0.5], [1.0, -0.7, 0.4]]).as_matrix():
            place = (x, turn @ r) if seen else (turn @ x, turn @ r)
            if abs(self.pull(*place).energy / energy - 1) > 10 * EQUAL:
                return False
        return True


def derivative(function: Callable[[float], Floats]) -> Floats:
    """Return the derivative of a function of one number at zero, by central differences of order 8."""
    parts = [c * (function((k + 1) * STEP) - function(-(k + 1) * STEP)) for k, c in enumerate(STENCIL)]
    return np.asarray(sum(parts) / STEP)


def _size(moments: Floats) -> float:
    """Return what the torques of a body are measured by; of a point, anything."""
    return float(moments.max()) or 1.0
