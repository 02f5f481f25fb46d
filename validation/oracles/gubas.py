"""Runs of GUBAS, the field's standard code for binary asteroids: a few of its rows are kept in ``references``."""

from pathlib import Path
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.equations.legendre import Snapshot
from binaryast.gravity import Gravity
from validation.differences import snapshot_of

FOLDER = Path(__file__).parents[1] / "references"
KM, MEGAJOULE = 1000.0, 1e6
AXES = {"A": (420, 400, 330), "B": (100, 80, 60)}  # m
DENSITY = 2400 * u.kg / u.m**3


class Point(NamedTuple):
    """What GUBAS prints at the start, in kg, km and s."""

    U: float
    gradient: tuple[float, float, float]
    moment: tuple[float, float, float]


AT_THE_START = {
    0: Point(-161.52375634509278, (143.86731334380733, 19.618270001428268, -6.539423333809423), (0.0, 0.0, 0.0)),
    2: Point(
        -162.7105142220118,
        (147.00974423592021, 20.156826766543912, -6.9957460271174607),
        (0.017168494556464312, -0.10893762085003092, 0.050894017692121818),
    ),
    4: Point(
        -162.73326183193132,
        (147.1094317367178, 20.174431061339376, -7.0245691171366529),
        (0.019151129466029253, -0.11504999710931431, 0.05226528055045021),
    ),
}


class Rows(NamedTuple):
    """GUBAS's columns in SI: time, X, V, Omega2, Omega (in A), Q (A -> inertial), C (B -> A), U, E, H (inertial)."""

    time: np.ndarray
    X: np.ndarray
    V: np.ndarray
    Omega2: np.ndarray
    Omega: np.ndarray
    Q: np.ndarray
    C: np.ndarray
    U: np.ndarray
    E: np.ndarray
    H: np.ndarray

    @classmethod
    def read(cls, path: Path) -> "Rows":
        """Read a file of GUBAS's, or one of the references."""
        table = np.genfromtxt(path, delimiter=",", comments="#")
        table = table[np.isfinite(table[:, 0])]  # without the names of the columns
        X, V, Omega2, Omega = table[:, 1:13].reshape(-1, 4, 3).transpose(1, 0, 2)
        Q, C = table[:, 13:31].reshape(-1, 2, 3, 3).transpose(1, 0, 2, 3)
        U, E, H = table[:, 31], table[:, 32], table[:, 33:36]
        return cls(table[:, 0], X * KM, V * KM, Omega2, Omega, Q, C, U * MEGAJOULE, E * MEGAJOULE, H * MEGAJOULE)

    def start(self, gravity: Gravity) -> tuple[ba.System, ba.State]:
        """Return the system and its state in the first row."""
        return system(gravity), self.relative(0).to_state(system(gravity))

    def relative(self, k: int) -> ba.RelativeState:
        """Return the k-th row as the paper's variables, its attitudes as the nearest rotations."""
        C, Q = (Rotation.from_matrix(matrix[k]).as_matrix() for matrix in (self.C, self.Q))
        spins = {"Omega": self.Omega[k] * u.rad / u.s, "Omega2": self.Omega2[k] * u.rad / u.s}
        return ba.RelativeState(X=self.X[k] * u.m, V=self.V[k] * u.m / u.s, R=C, R2=Q, **spins)

    def snapshot(self, k: int) -> Snapshot:
        """Return the k-th row as inertial arrays, the barycentre at rest."""
        return snapshot_of(self.relative(k).to_state(system(ba.PointMass())))


def system(gravity: Gravity) -> ba.System:
    """Return the pair of its runs: A is the primary."""
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(a * u.m, b * u.m, c * u.m), density=DENSITY) for name, (a, b, c) in AXES.items()
    ]
    return ba.System(bodies, gravity=gravity)


def reference(degree: int, kind: str) -> Rows:
    """Return the kept rows of a run: ``lgvi_h10`` or ``rk78_tol1e-13``."""
    return Rows.read(FOLDER / f"gubas_N{degree}_{kind}.csv")
