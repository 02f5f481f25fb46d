"""Fields of homogeneous polyhedra for G rho = 1: by polyhedral-gravity, and a prism's in closed form."""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import product
from time import perf_counter
from typing import NamedTuple

import numpy as np


class Field(NamedTuple):
    """U (P,), dU/dx (P, 3) and the second derivatives (P, 3, 3)."""

    energy: np.ndarray
    gradient: np.ndarray
    hessian: np.ndarray


def by_polyhedral_gravity(vertices: np.ndarray, faces: np.ndarray, points: np.ndarray) -> tuple[Field, float]:
    """Return the field at points (P, 3), by the line integrals of Tsoulis, and how long it took on one thread [s].

    J. Schuhmacher, E. Blazquez, F. Gratl, D. Izzo, P. Gomez, J. Open Source Softw. 9 (2024) 6384. Its potential is
    positive, so that all signs are changed here.
    """
    import polyhedral_gravity as pg

    with quiet():
        polyhedron = pg.Polyhedron(
            (vertices, faces),
            density=1.0,
            normal_orientation=pg.NormalOrientation.OUTWARDS,
            integrity_check=pg.PolyhedronIntegrity.DISABLE,
            metric_unit=pg.MetricUnit.UNITLESS,
        )
        start = perf_counter()
        found = pg.evaluate(polyhedron, [tuple(point) for point in points], False)
        took = perf_counter() - start
    energy, gradient, second = (np.array([one[k] for one in found]) for k in range(3))
    return Field(-energy, -gradient, -second[:, [0, 3, 4, 3, 1, 5, 4, 5, 2]].reshape(-1, 3, 3)), took


@contextmanager
def quiet() -> Iterator[None]:
    """Drop what a library in C++ writes on standard output: a line for each face that a point is near to."""
    sys.stdout.flush()
    kept = os.dup(1)
    with open(os.devnull, "w") as nothing:  # noqa: PTH123
        os.dup2(nothing.fileno(), 1)
        try:
            yield
        finally:
            os.dup2(kept, 1)
            os.close(kept)


def of_prism(half: np.ndarray, points: np.ndarray) -> Field:
    """Return the field of a box about the origin, at points that are in no plane of its faces.

    It is a sum over the corners, with alternating signs (W. D. MacMillan, The Theory of the Potential, 1930, sec. 43).
    """
    energy, gradient, hessian = np.zeros(len(points)), np.zeros((len(points), 3)), np.zeros((len(points), 3, 3))
    for signs in product((-1, 1), repeat=3):
        d, sign = signs * half - points, np.prod(signs)
        r = np.linalg.norm(d, axis=1)
        for i in range(3):
            j, k = (i + 1) % 3, (i + 2) % 3
            logarithm, angle = sign * np.log(d[:, i] + r), sign * np.arctan(d[:, j] * d[:, k] / (d[:, i] * r))
            energy -= d[:, j] * d[:, k] * logarithm - d[:, i] ** 2 / 2 * angle
            gradient[:, i] -= d[:, i] * angle
            gradient[:, j] += d[:, k] * logarithm
            gradient[:, k] += d[:, j] * logarithm
            hessian[:, i, i] += angle
            hessian[:, j, k] -= logarithm
            hessian[:, k, j] -= logarithm
    return Field(energy, gradient, hessian)
