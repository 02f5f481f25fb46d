"""The gravity of a polyhedron and a point, exact up to the surface."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.gravity import Gravity
from binaryast.polyhedron_table import layers_of, table_of
from binaryast.shapes import Point, Sphere
from binaryast.units import Floats


@dataclass(frozen=True, eq=False)
class PolyhedronPoint(Gravity):
    """A homogeneous polyhedron and a point or a sphere, exact at every distance; either may be the primary.

    The polyhedron may be a `binaryast.Layered` of two. Its field is that of its faces, also where an ``inertia`` was
    given to the body. A sphere attracts like a point as long as it stays outside. Each evaluation takes a time that is
    proportional to the number of faces, some 20 to 60 ns for each.

    Raises
    ------
    InputError
        From `System`, for other bodies; where the point is inside the polyhedron.

    References
    ----------
    R. A. Werner, D. J. Scheeres, Celest. Mech. Dyn. Astron. 65 (1996) 313-344.

    Examples
    --------
    A cube attracts more strongly at the middle of a face than at a corner:

    >>> import astropy.units as u, numpy as np
    >>> import binaryast as ba
    >>> corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]) * u.m
    >>> faces = [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6]]
    >>> faces += [[0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
    >>> cube = ba.RigidBody("cube", ba.Polyhedron(corners, faces), density=2000 * u.kg / u.m**3)
    >>> grain = ba.RigidBody("grain", ba.Point(), mass=1 * u.kg)
    >>> system = ba.System([cube, grain], gravity=ba.PolyhedronPoint())
    >>> for place in ([1, 0, 0], [1, 1, 1]):
    ...     print(np.linalg.norm(system.mutual_gravity(place * u.m).gradient).to("uN").round(4))
    0.6933 uN
    0.4483 uN
    """

    limits = "the point is inside the polyhedron, or too far away"

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        from binaryast.kernels.mutual.polyhedron_point import potential

        return potential

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return which body is the point, its mass, and the table of the polyhedron's edges and faces."""
        for point, other, is_primary in ((secondary, primary, 0.0), (primary, secondary, 1.0)):
            layers = layers_of(other)
            if isinstance(point.shape, (Point, Sphere)) and layers is not None:
                return np.concatenate([[is_primary, point.si.mass], table_of(other, layers)])
        raise InputError(
            "PolyhedronPoint: expected a Polyhedron, or a Layered of two, and a Point or Sphere, got "
            f"{primary.name}, a {type(primary.shape).__name__}, and {secondary.name}, a "
            f"{type(secondary.shape).__name__}: for others there is such as ba.Multipole(8)"
        )
