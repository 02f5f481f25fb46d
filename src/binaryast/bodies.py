"""Rigid bodies: a shape with mass, brought to its mass centre and principal axes."""

from copy import deepcopy
from dataclasses import dataclass, field
from itertools import permutations, product
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast import markup
from binaryast.constants import G
from binaryast.errors import InputError
from binaryast.kernels.moments import from_inertia
from binaryast.shapes import Point, Shape, look_at_density
from binaryast.units import LARGEST, Floats, as_quantity, brief, quantity, to_si
from binaryast.values import Value

LONGEST_NAME = 64
EQUAL_MOMENTS = 1e-12  # relative difference below which two principal axes may be chosen freely


class BodyFloats(NamedTuple):
    """A body as plain SI floats."""

    mass: float
    gm: float
    moments: Floats


@dataclass(frozen=True, eq=False, init=False)
class RigidBody(Value):
    """A rigid body. Its frame has the mass centre as origin and the principal axes nearest to the shape's own.

    Axes are never sorted by size: an ellipsoid's x stays x.

    Parameters
    ----------
    name : str
        A name, unique in a system.
    shape : Shape
        Its geometry.
    mass, density, gm : Quantity
        Exactly one of the three: mass, bulk density, or G times mass; none for a shape that has a mass of its own.
    inertia : Quantity, optional
        Overrides the shape's: three principal moments about the shape's axes, or the inertia matrix (3, 3) about the
        mass centre in the shape's frame. Needed where the shape has none, such as `StokesCoefficients`. The body's
        moments of mass of second degree follow it, those of higher degree remain the shape's.
    pulls : bool
        Whether it pulls others. One that does not still feels them: a spacecraft, a grain of dust. It has no part in
        the energy, the momenta and the barycentre of a system.

    Attributes
    ----------
    inertia : Quantity
        Principal moments (3,) about the axes of the body frame [kg m2].
    turn : ndarray
        Rotation matrix (3, 3), body frame -> shape's frame.
    offset : Quantity
        Mass centre (3,) in the shape's frame [m]; a point p of the body frame is offset + turn p in the shape's.
    si : BodyFloats
        mass [kg], gm [m3/s2] and principal moments [kg m2] as floats.

    Raises
    ------
    InputError
        For none or several of mass, density and gm; a shape without volume given a density; a shape without inertia
        given none; moments that no mass can have: negative, zero, or one larger than the sum of the other two.

    Warns
    -----
    DensityWarning
        Where a mesh of faces and its mass make a density that no small body has: its unit of length may be wrong.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> body = ba.RigidBody("Dimorphos", ba.Ellipsoid(89.8 * u.m, 84.7 * u.m, 57.6 * u.m), mass=4.47e9 * u.kg)
    >>> print(body.density.round(1))
    2435.8 kg / m3
    """

    name: str
    shape: Shape
    mass: Quantity
    density: Quantity | None
    gm: Quantity
    inertia: Quantity
    turn: Floats = field(repr=False)
    offset: Quantity = field(repr=False)
    si: BodyFloats = field(repr=False)
    given: MappingProxyType[str, Quantity] = field(repr=False)
    pulls: bool

    def __init__(
        self,
        name: str,
        shape: Shape,
        *,
        mass: Quantity | None = None,
        density: Quantity | None = None,
        gm: Quantity | None = None,
        inertia: Quantity | None = None,
        pulls: bool = True,
    ) -> None:
        if not isinstance(name, str) or not name.isprintable() or not name.strip() or len(name) > LONGEST_NAME:
            raise InputError(
                f"RigidBody: name: expected a printable text up to {LONGEST_NAME} characters, got {brief(repr(name))}"
            )
        if not isinstance(shape, Shape):
            raise InputError(f"RigidBody {name}: shape: expected a shape such as ba.Ellipsoid(...), got {brief(shape)}")
        if not isinstance(pulls, bool):
            raise InputError(f"RigidBody {name}: pulls: expected True or False, got {brief(repr(pulls))}")
        given = {"mass": mass, "density": density, "gm": gm}
        given = {key: deepcopy(value) for key, value in given.items() if value is not None}
        if len(given) != 1 and (given or shape.mass is None):
            found = " and ".join(given) or "none"
            raise InputError(f"RigidBody {name}: give exactly one of mass=, density= and gm=, got {found}")
        also = {} if inertia is None else {"inertia": deepcopy(inertia)}
        self._set(name=name, shape=shape, pulls=pulls, given=MappingProxyType(given | also))
        mass_si, gm_si = self._masses(**given)
        if not 1 / LARGEST < mass_si < LARGEST:
            raise InputError(f"RigidBody {name}: a mass of {mass_si:g} kg is beyond what can be computed with")
        matrix = self._inertia_matrix(inertia, mass_si)
        moments, turn = principal_axes(matrix, f"RigidBody {name}: inertia")
        if not isinstance(shape, Point) or inertia is not None:
            self._check_moments(moments)
        moments.flags.writeable = False
        self._set(
            mass=quantity(mass_si, "kg"),
            gm=quantity(gm_si, "m3 / s2"),
            density=None if shape.volume is None else quantity(mass_si / shape.volume, "kg / m3"),
            inertia=quantity(moments, "kg m2"),
            turn=turn,
            offset=quantity(shape.centre, "m"),
            si=BodyFloats(mass_si, gm_si, moments),
        )
        if density is None:
            look_at_density(shape, mass_si, f"RigidBody {name}", stacklevel=3)

    @property
    def is_point(self) -> bool:
        """Whether it has no attitude: a `binaryast.Point` without inertia."""
        return not np.any(self.si.moments)

    def arguments(self) -> dict[str, Any]:
        """Return the arguments that make this body again, as they were given."""
        return {"name": self.name, "shape": self.shape, **self.given} | ({} if self.pulls else {"pulls": False})

    def _masses(
        self, mass: Quantity | None = None, density: Quantity | None = None, gm: Quantity | None = None
    ) -> tuple[float, float]:
        """Return the mass and G m from the one that was given."""
        where = f"RigidBody {self.name}"
        if gm is not None:
            value = float(to_si(gm, "m3 / s2", f"{where}: gm", sign="positive"))
            return value / G, value
        if density is not None:
            if self.shape.volume is None:
                raise InputError(f"{where}: {type(self.shape).__name__} has no volume: give mass= or gm=, not density=")
            value = float(to_si(density, "kg / m3", f"{where}: density", sign="positive")) * self.shape.volume
        elif mass is None and self.shape.mass is not None:
            value = self.shape.mass
        else:
            value = float(to_si(mass, "kg", f"{where}: mass", sign="positive"))
        return value, G * value

    def _inertia_matrix(self, given: Quantity | None, mass: float) -> Floats:
        """Return the inertia matrix in the shape's frame: the shape's, or what the user gave in its place."""
        where = f"RigidBody {self.name}: inertia"
        if given is None:
            if not self.shape.trace_is_known:
                raise InputError(
                    f"{where}: coefficients of degree 2 do not fix its trace: give inertia=, three principal "
                    "moments or a matrix (3, 3)"
                )
            return self.shape.specific_inertia * mass
        given = as_quantity(given, "kg m2", where)
        if given.shape == (3,):
            matrix = np.diag(to_si(given, "kg m2", where, shape=(3,), sign="positive"))
        else:
            matrix = to_si(given, "kg m2", where, shape=(3, 3))
        return self.shape.completed_inertia(matrix, mass, where)

    def _check_moments(self, moments: Floats) -> None:
        """Raise where no rigid mass has these principal moments."""
        where = f"RigidBody {self.name}: inertia"
        shown = ", ".join(f"{moment:.6g}" for moment in moments)
        largest = moments.max()
        if moments.min() <= 1e-12 * largest:
            cause = "a point or a line of points has none about itself; give inertia=, or the shape ba.Point()"
            if self.shape.mass is not None and moments.min() < -1e-12 * abs(largest):  # a union
                cause = "its negative parts take away more than there is"
            raise InputError(f"{where}: principal moments {shown} kg m2 must all be positive: {cause}")
        if 2 * largest > moments.sum() * (1 + 1e-9):
            raise InputError(
                f"{where}: principal moments {shown} kg m2 break the triangle inequality: "
                "the largest can be at most the sum of the other two"
            )

    def _repr_html_(self) -> str:
        """Return what a notebook shows."""
        return markup.body(self)

    def moments(self, degree: int) -> Floats:
        """Return the integrals of x^i y^j z^k dm over the mass, up to i + j + k = degree, in the body frame.

        Those of first degree are zero, for the origin is the mass centre. Those of second degree are what the principal
        moments of inertia say, so they follow an ``inertia`` that was given. Of `StokesCoefficients`, those from degree
        3 on stand for the field only: a field does not say the moments themselves.

        Parameters
        ----------
        degree : int
            The largest total degree, 0 or more.

        Returns
        -------
        ndarray
            Flat, ordered by total degree, then by falling powers of x, then of y: 1, x, y, z, x^2, xy, xz, y^2, ..
            [m^(i + j + k)].

        Raises
        ------
        InputError
            For another degree, or where the shape's moments are not known up to it.

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> body = ba.RigidBody("B", ba.Ellipsoid(5 * u.m, 4 * u.m, 3 * u.m), mass=1 * u.kg)
        >>> print(body.moments(2))
        [1.  0.  0.  0.  5.  0.  0.  3.2 0.  1.8]
        """
        if isinstance(degree, bool) or not isinstance(degree, (int, np.integer)) or degree < 0:
            raise InputError(
                f"RigidBody {self.name}: moments: degree: expected a whole number, 0 or more, got {brief(degree)}"
            )
        try:
            result = self.shape.moments(int(degree), self.shape.centre, self.turn).copy()
        except InputError as error:
            raise InputError(f"RigidBody {self.name}: {error}") from None
        result[1:4] = 0.0
        if degree >= 2:
            result[4:10] = from_inertia(np.diag(self.si.moments / self.si.mass))[np.triu_indices(3)]
        return result

    @property
    def points(self) -> tuple[Floats, Floats] | None:
        """Point masses in the body frame: positions (k, 3) [m] and fractions of the mass (k,); None without them."""
        if self.shape.points is None:
            return None
        positions, fractions = self.shape.points
        return (positions - self.shape.centre) @ self.turn, fractions

    @property
    def surface(self) -> list[tuple[Floats, Floats]]:
        """Ellipsoids that make the surface, in the body frame: centre (3,) and matrix (3, 3) of each [m, m2].

        A point p is on the surface where (p - centre) . matrix^-1 (p - centre) = 1.
        """
        surface: list[tuple[Floats, Floats]] = []
        for centre, axes in self.shape.pieces:
            columns = self.turn.T @ (axes if axes.ndim == 2 else np.diag(axes))
            surface.append(((centre - self.shape.centre) @ self.turn, columns @ columns.T))
        return surface

    @property
    def corners(self) -> Floats | None:
        """Vertices (k, 3) of a surface of faces in the body frame [m]; None without them."""
        return None if self.shape.corners is None else (self.shape.corners - self.shape.centre) @ self.turn

    @property
    def bounding_radius(self) -> float:
        """Radius of a sphere about the mass centre that holds the surface [m]; 0 without a surface."""
        reach = [np.linalg.norm(c) + np.sqrt(max(np.linalg.eigvalsh(m)[-1], 0.0)) for c, m in self.surface]
        if self.corners is not None:
            reach.append(np.linalg.norm(self.corners, axis=1).max())
        return float(max(reach, default=0.0))


def principal_axes(matrix: Floats, name: str) -> tuple[Floats, Floats]:
    """Return the principal moments and the rotation body -> given frame that is nearest to the identity.

    Where two moments are equal, the axes in their plane are chosen to be nearest too.
    """
    scale = np.abs(matrix).max()
    if not np.allclose(matrix, matrix.T, rtol=0, atol=1e-9 * scale):
        raise InputError(f"{name}: expected a symmetric matrix, got {brief(matrix.tolist())}")
    off_diagonal = matrix - np.diag(np.diag(matrix))
    if np.abs(off_diagonal).max() <= 1e-15 * scale:
        return np.diag(matrix).copy(), np.eye(3)
    moments, axes = np.linalg.eigh((matrix + matrix.T) / 2)
    if np.ptp(moments) <= EQUAL_MOMENTS * moments.max():
        return moments, np.eye(3)  # a top of equal moments has its axes everywhere
    candidates = (
        (moments[list(order)], axes[:, order] * signs)
        for order in permutations(range(3))
        for signs in product((1.0, -1.0), repeat=3)
    )
    rotations = [
        (m, _nearest_in_equal_planes(m, r, EQUAL_MOMENTS * moments.max()))
        for m, r in candidates
        if np.linalg.det(r) > 0
    ]
    best_moments, best = max(rotations, key=lambda candidate: float(np.trace(candidate[1])))
    return best_moments.copy(), best


def _nearest_in_equal_planes(moments: Floats, rotation: Floats, tolerance: float) -> Floats:
    """Turn the axes of equal moments in their own plane to where the trace is largest."""
    rotation = rotation.copy()
    for i, j in ((0, 1), (1, 2), (2, 0)):
        if abs(moments[i] - moments[j]) <= tolerance:
            angle = np.arctan2(rotation[i, j] - rotation[j, i], rotation[i, i] + rotation[j, j])
            first, second = rotation[:, i].copy(), rotation[:, j].copy()
            rotation[:, i] = np.cos(angle) * first + np.sin(angle) * second
            rotation[:, j] = np.cos(angle) * second - np.sin(angle) * first
    return rotation
