"""Free rigid bodies in closed form: the symmetric top by sines and cosines, the triaxial one by Jacobi's functions."""

import numpy as np
from scipy.spatial.transform import Rotation
from scipy.special import ellipj, ellipk

NODES, WEIGHTS = np.polynomial.legendre.leggauss(20)


class SymmetricTop:
    """A top with equal moments about x and y: z of the body goes round the angular momentum at a steady rate.

    Parameters
    ----------
    moments : array-like
        (A, A, C) [kg m2].
    spin : array-like
        Angular velocity at the start, in the body's frame (3,) [rad/s].
    attitude : array-like
        Body frame -> inertial at the start (3, 3).
    """

    def __init__(self, moments: np.ndarray, spin: np.ndarray, attitude: np.ndarray) -> None:
        self.start, self.first = np.asarray(spin, dtype=float), np.asarray(attitude, dtype=float)
        transverse, axial = moments[0], moments[2]
        self.precession = self.first @ (moments * self.start) / transverse  # L/A, inertial
        self.slip = (axial - transverse) / transverse * self.start[2]  # of the spin's projection in the body [rad/s]

    def spin(self, time: float) -> np.ndarray:
        """Return the angular velocity in the body's frame (3,)."""
        return Rotation.from_rotvec([0, 0, self.slip * time]).apply(self.start)

    def attitude(self, time: float) -> np.ndarray:
        """Return the attitude (3, 3)."""
        precessed = Rotation.from_rotvec(self.precession * time).as_matrix()
        return precessed @ self.first @ Rotation.from_rotvec([0, 0, -self.slip * time]).as_matrix()


class TriaxialTop:
    """A top with three moments A < B < C about x, y and z (Landau and Lifshitz, Mechanics, section 37).

    Parameters
    ----------
    moments : array-like
        A < B < C [kg m2].
    momentum : array-like
        Angular momentum, inertial (3,) [kg m2/s].
    ratio : float
        L^2/(2 E), between A and C and not B: above B the momentum circles the z axis in the body, below it the x axis.
    phase : float
        Argument of Jacobi's functions at the start.
    """

    def __init__(self, moments: np.ndarray, momentum: np.ndarray, ratio: float, phase: float) -> None:
        self.moments = np.asarray(moments, dtype=float)
        self.size = float(np.linalg.norm(momentum))
        self.phase = phase
        self.to_inertial = Rotation.align_vectors([momentum], [[0, 0, 1]])[0].as_matrix()
        square, twice = self.size**2, self.size**2 / ratio  # L^2, 2 E
        # the axes in which the momentum goes as cn, sn and dn: what is circled comes last
        self.order = np.array([0, 1, 2] if ratio > self.moments[1] else [2, 1, 0])
        one, two, three = self.moments[self.order]
        near, far = twice * three - square, square - twice * one  # both change sign with the order of the axes
        self.amplitudes = np.sqrt(
            [near / (one * (three - one)), near / (two * (three - two)), far / (three * (three - one))]
        )
        self.rate = float(np.sqrt((three - two) * far / (one * two * three)))
        self.modulus2 = float((two - one) * near / ((three - two) * far))

    @property
    def period(self) -> float:
        """The time [s] after which the momentum is the same in the body's frame."""
        return 4 * float(ellipk(self.modulus2)) / self.rate

    def spin(self, time: np.ndarray | float) -> np.ndarray:
        """Return the angular velocity in the body's frame (..., 3)."""
        sn, cn, dn, _ = ellipj(self.rate * np.asarray(time) + self.phase, self.modulus2)
        spin = np.empty((*np.shape(time), 3))
        spin[..., self.order] = self.amplitudes * np.stack([cn, sn, dn], axis=-1)
        return spin

    def attitude(self, time: float) -> np.ndarray:
        """Return the attitude (3, 3).

        The momentum in the body's frame gives it but for a turn about the momentum: the nodes of the circled axis'
        equator on the plane across the momentum advance at a rate that is integrated here.
        """
        nodes = self._nodes(self.moments * self.spin(time) / self.size)
        return self.to_inertial @ Rotation.from_rotvec([0, 0, self._advance(time)]).as_matrix() @ nodes

    def _nodes(self, up: np.ndarray) -> np.ndarray:
        """Return the attitude in axes with z along the momentum, ``up`` in the body, and x to the nodes."""
        node = np.cross(np.eye(3)[self.order[2]], up)
        node /= np.linalg.norm(node)
        return np.array([node, np.cross(up, node), up])

    def _advance(self, time: float) -> float:
        """Return the angle by which the nodes advance: Gauss's rule in pieces of less than an eighth of a period."""
        pieces = int(np.ceil(8 * time / self.period)) + 1
        width = time / pieces
        at = width * (np.arange(pieces)[:, None] + (NODES + 1) / 2)
        one, two = self.order[:2]
        spin = self.spin(at)
        momentum = self.moments * spin
        across = momentum[..., one] ** 2 + momentum[..., two] ** 2
        rate = self.size * (momentum[..., one] * spin[..., one] + momentum[..., two] * spin[..., two]) / across
        return float(np.sum(rate @ WEIGHTS) * width / 2)
