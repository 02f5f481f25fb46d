"""The gravity of a polyhedron at many points."""

from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.polyhedron_table import layers_of, table_of
from binaryast.units import Floats, as_quantity, brief, quantity, to_si, whole_number
from binaryast.values import Value

COLUMNS = 11  # of the kernel's result
SLICES = 4  # for each thread, so that none waits long for the last


@dataclass(frozen=True, eq=False)
class GravityField(Value):
    """The gravity of a body at points, in the body frame; of P points, P comes first in every array.

    Attributes
    ----------
    potential : Quantity
        U (P,), negative [m2 / s2].
    attraction : Quantity
        Acceleration -dU/dx (P, 3) [m / s2].
    hessian : Quantity
        Second derivatives of U (P, 3, 3) [1 / s2]: minus the gravity gradient, which is that of the attraction.
    laplacian : Quantity
        Their trace (P,), from the solid angles of the faces [1 / s2]: 4 pi G times the density, so 0 outside.
    """

    potential: Quantity
    attraction: Quantity
    hessian: Quantity = field(repr=False)
    laplacian: Quantity = field(repr=False)

    def __post_init__(self) -> None:
        self._set(**self.arguments())  # read-only


def polyhedron_field(body: RigidBody, points: Quantity, *, threads: int = 1) -> GravityField:
    """Return the gravity of a homogeneous polyhedron at points, exact everywhere: outside, inside and on the surface.

    Parameters
    ----------
    body : RigidBody
        Its shape is a `binaryast.Polyhedron`, or a `binaryast.Layered` of two of them.
    points : Quantity
        Positions (P, 3), or one (3,), in the body frame: about the mass centre, along the principal axes (length).
    threads : int
        How many threads share the work.

    Returns
    -------
    GravityField
        With one row for each point; without the first axis for one point.

    Raises
    ------
    InputError
        For another shape of body, points that are not finite, or a number of threads below 1.

    Notes
    -----
    On the surface the potential and the attraction are continuous; the second derivatives are the mean of both sides.
    On edges they are infinite, and what is returned is their value at a distance of round-off.

    The relative error is that of round-off near the body, and grows as r/size with the distance: 1e-15 at the surface,
    3e-14 at a hundred radii, 5e-12 at ten thousand.

    References
    ----------
    R. A. Werner, D. J. Scheeres, Celest. Mech. Dyn. Astron. 65 (1996) 313-344.

    Examples
    --------
    >>> import astropy.units as u, numpy as np
    >>> import binaryast as ba
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] * u.km
    >>> rock = ba.Polyhedron(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> body = ba.RigidBody("rock", rock, density=2000 * u.kg / u.m**3)
    >>> field = ba.polyhedron_field(body, [[0, 0, 0], [0, 0, 2]] * u.km)
    >>> print(field.potential.round(5))
    [-0.08881 -0.01119] m2 / s2
    >>> print((field.laplacian / (4 * np.pi * ba.constants.G)).round(3).value + 0)  # the density there
    [2000.    0.]
    """
    layers = layers_of(body) if isinstance(body, RigidBody) else None
    if layers is None:
        found = f"{body.name}, a {type(body.shape).__name__}" if isinstance(body, RigidBody) else brief(body)
        raise InputError(f"polyhedron_field: expected a body of a Polyhedron, or of a Layered of two, got {found}")
    given = as_quantity(points, "m", "polyhedron_field: points")
    shape = (3,) if given.ndim == 1 else (len(given) if given.ndim else 0, 3)
    floats = to_si(given, "m", "polyhedron_field: points", shape=shape)
    rows = evaluated(table_of(body, layers), floats.reshape(-1, 3), checked_threads(threads, "polyhedron_field"))
    return GravityField(
        potential=quantity(rows[:, 0].reshape(shape[:-1]), "m2 / s2"),
        attraction=quantity(-rows[:, 1:4].reshape(shape), "m / s2"),
        hessian=quantity(rows[:, [4, 5, 6, 5, 7, 8, 6, 8, 9]].reshape(*shape, 3), "1 / s2"),
        laplacian=quantity(rows[:, 10].reshape(shape[:-1]), "1 / s2"),
    )


def checked_threads(threads: Any, where: str) -> int:
    """Return a number of threads, looked at."""
    return whole_number(threads, f"{where}: threads", 1)


def evaluated(table: Floats, points: Floats, threads: int = 1) -> Floats:
    """Return U, dU/dx (3), ddU (6) and its trace at points (P, 3), as rows (P, 11).

    Threads share the points in slices; the kernel lets go of Python's lock, and each point is computed by one of them,
    so that the result does not depend on how many they are.
    """
    from binaryast.kernels.polyhedron_field import fields

    points = np.array(points, order="C")
    result = np.empty((len(points), COLUMNS))
    if threads == 1:
        fields(table, points, result)
        return result
    cuts = np.linspace(0, len(points), threads * SLICES + 1).astype(int)

    def work(i: int) -> None:
        part: Any = slice(cuts[i], cuts[i + 1])
        fields(table, points[part], result[part])

    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(threads * SLICES)))
    return result
