"""The geometry of a body: what it encloses, how mass is spread in it, and where its surface is.

A shape has a frame of its own; `binaryast.RigidBody` finds the mass centre and the principal axes in it.
"""

import warnings
from abc import ABC, abstractmethod
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from astropy.units import Quantity

from binaryast.errors import DensityWarning, InputError
from binaryast.kernels.moments import moved, of_ellipsoid, of_points
from binaryast.units import Floats, as_quantity, checked, numbers, quantity, to_si
from binaryast.values import Value

DENSITIES = (100.0, 20000.0)  # kg / m3: what small bodies are made of lies between


class Shape(Value, ABC):
    """What every shape says about itself, as plain SI floats in the shape's own frame.

    Attributes
    ----------
    volume : float or None
        Volume [m3]; None where there is none to speak of.
    mass : float or None
        Mass [kg], of a shape that has one of its own.
    centre : ndarray
        Mass centre (3,) [m].
    specific_inertia : ndarray
        Inertia matrix about the mass centre over the mass (3, 3) [m2].
    trace_is_known : bool
        Whether its trace is known too; where it is not, the matrix has none.
    points : tuple of ndarray or None
        Positions (k, 3) [m] and fractions of the mass (k,) of point masses with the same gravity, where there are some.
    pieces : list of tuple of ndarray
        The surface as ellipsoids: centre (3,) and semi-axes [m] of each, along the axes of the shape's frame (3,) or as
        the columns of a matrix (3, 3); empty for what never touches.
    corners : ndarray or None
        Vertices (k, 3) [m] of a surface of faces, None where there are none: its picture, and what a sphere must hold.
    """

    volume: float | None = None
    mass: float | None = None
    points: tuple[Floats, Floats] | None = None
    corners: Floats | None = None
    centre: Floats
    specific_inertia: Floats
    trace_is_known: bool = True

    @property
    @abstractmethod
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids."""

    @abstractmethod
    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the integrals of x^i y^j z^k dm over the mass, up to i + j + k = degree, in another frame.

        Parameters
        ----------
        degree : int
            The largest total degree.
        origin : ndarray
            Origin (3,) of that frame in the shape's [m].
        turn : ndarray
            Its axes in the shape's frame, as columns (3, 3): p' = turn^T (p - origin).

        Returns
        -------
        ndarray
            Flat, ordered by total degree, then by falling powers of x, then of y: 1, x, y, z, x^2, xy, xz, y^2, ..
            [m^(i + j + k)].
        """

    def completed_inertia(self, given: Floats, mass: float, where: str) -> Floats:  # noqa: ARG002
        """Return the inertia matrix (3, 3) [kg m2] that the user gave, as this shape takes it."""
        return given


@dataclass(frozen=True, eq=False)
class Ellipsoid(Shape):
    """A homogeneous ellipsoid.

    Parameters
    ----------
    a, b, c : Quantity
        Semi-axes along x, y and z (length). They need not be sorted.

    Raises
    ------
    UnitError, InputError
        For a value that is not a positive length.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.Ellipsoid(425.5 * u.m, 424.5 * u.m, 310 * u.m)
    Ellipsoid(a=<Quantity 425.5 m>, b=<Quantity 424.5 m>, c=<Quantity 310. m>)
    """

    a: Quantity
    b: Quantity
    c: Quantity

    def __post_init__(self) -> None:
        name = type(self).__name__
        axes = np.array([to_si(getattr(self, axis), "m", f"{name}: {axis}", sign="positive") for axis in "abc"])
        squares = axes**2
        self._set(
            a=quantity(axes[0], "m"),
            b=quantity(axes[1], "m"),
            c=quantity(axes[2], "m"),
            volume=4 / 3 * pi * float(np.prod(axes)),
            centre=np.zeros(3),
            specific_inertia=np.diag(squares.sum() - squares) / 5,
        )

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids."""
        return [(self.centre, self._axes)]

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`: Dirichlet's integral."""
        return moved(of_ellipsoid(self._axes, degree), degree, origin, turn)

    @property
    def _axes(self) -> Floats:
        return np.array([self.a.value, self.b.value, self.c.value])


@dataclass(frozen=True, eq=False)
class Sphere(Shape):
    """A homogeneous sphere.

    Parameters
    ----------
    radius : Quantity
        Radius (length).

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.Sphere(1 * u.km).radius
    <Quantity 1000. m>
    """

    radius: Quantity

    def __post_init__(self) -> None:
        radius = float(to_si(self.radius, "m", "Sphere: radius", sign="positive"))
        self._set(
            radius=quantity(radius, "m"),
            volume=4 / 3 * pi * radius**3,
            centre=np.zeros(3),
            specific_inertia=np.eye(3) * (2 / 5 * radius**2),
            points=(np.zeros((1, 3)), np.ones(1)),
        )

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids."""
        return [(self.centre, np.full(3, self.radius.value))]

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`."""
        return moved(of_ellipsoid(np.full(3, self.radius.value), degree), degree, origin, turn)


@dataclass(frozen=True, eq=False)
class Point(Shape):
    """A mass without extent: a body of this shape has a place and a velocity, and no attitude.

    Its attitude in a `binaryast.State` stays as it is given, its spin must be zero. It attracts and is attracted, and
    a run ends where it enters another body's surface. The figures of a run are those of the whole system: the error of
    a body as light as a spacecraft is not seen in them. Compare a run of half the step.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.RigidBody("Milani", ba.Point(), mass=12 * u.kg).is_point
    True
    """

    def __post_init__(self) -> None:
        self._set(centre=np.zeros(3), specific_inertia=np.zeros((3, 3)), points=(np.zeros((1, 3)), np.ones(1)))

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids: one without size."""
        return [(self.centre, np.zeros(3))]

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`."""
        return of_points(-(origin @ turn)[None], np.ones(1), degree)


@dataclass(frozen=True, eq=False)
class Dumbbell(Shape):
    """Two equal homogeneous spheres on a massless rod along x: the body of section 5 of the paper.

    Its surface is the two spheres; the rod stops nothing. Its moments are those of the spheres; as spheres attract like
    points, so does the pair of points at their centres.

    Parameters
    ----------
    length : Quantity
        Distance between the centres of the spheres (length).
    radius : Quantity
        Radius of each sphere (length), at most half of ``length``. The paper's is a tenth of it.

    References
    ----------
    T. Lee, M. Leok, N. H. McClamroch, CMAME 196 (2007) 2907-2924, section 5.1 and Fig. 3.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> body = ba.RigidBody("first", ba.Dumbbell(0.25 * u.m, 0.025 * u.m), mass=1.5 * u.kg)
    >>> print(body.inertia.value)  # kg m2
    [0.000375  0.0238125 0.0238125]
    """

    length: Quantity
    radius: Quantity

    def __post_init__(self) -> None:
        length = float(to_si(self.length, "m", "Dumbbell: length", sign="positive"))
        radius = float(to_si(self.radius, "m", "Dumbbell: radius", sign="positive"))
        if 2 * radius > length:
            raise InputError(
                f"Dumbbell: radius {radius:g} m is more than half the length {length:g} m: the spheres would overlap"
            )
        along, across = 2 / 5 * radius**2, 2 / 5 * radius**2 + length**2 / 4
        self._set(
            length=quantity(length, "m"),
            radius=quantity(radius, "m"),
            volume=8 / 3 * pi * radius**3,
            centre=np.zeros(3),
            specific_inertia=np.diag([along, across, across]),
            points=(np.array([[length / 2, 0, 0], [-length / 2, 0, 0]]), np.array([0.5, 0.5])),
        )

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids."""
        half = self.length.value / 2
        return [(np.array([x, 0.0, 0.0]), np.full(3, self.radius.value)) for x in (half, -half)]

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`."""
        sphere = of_ellipsoid(np.full(3, self.radius.value), degree)
        return np.asarray(np.mean([moved(sphere, degree, origin - centre, turn) for centre, _ in self.pieces], axis=0))


@dataclass(frozen=True, eq=False)
class PointCloud(Shape):
    """Point masses held together rigidly. A cloud has no surface: it never touches anything.

    Parameters
    ----------
    positions : Quantity
        Positions (k, 3) in the shape's own frame (length). Neither centred nor turned: the body does that.
    weights : array-like, optional
        Mass of each point (k,), relative to the others; equal by default. The mass itself is the body's.

    Raises
    ------
    InputError
        For fewer than one point, a weight that is not positive, or values that are not finite.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> cloud = ba.PointCloud([[1, 0, 0], [-1, 0, 0], [0, 2, 0], [0, -2, 0]] * u.m)
    >>> print(ba.RigidBody("cross", cloud, mass=4 * u.kg).inertia.value)  # kg m2
    [ 8.  2. 10.]
    """

    positions: Quantity
    weights: Any = None

    def __post_init__(self) -> None:
        given = as_quantity(self.positions, "m", "PointCloud: positions")
        count = len(given) if given.ndim else 0
        if count == 0:
            raise InputError(f"PointCloud: positions: expected an array of shape (k, 3), got shape {given.shape}")
        positions = to_si(given, "m", "PointCloud: positions", shape=(count, 3))
        weights = np.ones(count) if self.weights is None else numbers(self.weights, "PointCloud: weights", (count,))
        checked(weights, "PointCloud: weights", (count,), "positive")
        fractions = weights / weights.sum()
        centre = fractions @ positions
        arms = positions - centre
        second = (arms * fractions[:, None]).T @ arms
        self._set(
            positions=quantity(positions, "m"),
            weights=weights,
            centre=centre,
            specific_inertia=np.trace(second) * np.eye(3) - second,
            points=(positions, fractions),
        )

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids: none."""
        return []

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`: sums over the points."""
        fractions = self.weights / self.weights.sum()
        return of_points((self.positions.value - origin) @ turn, fractions, degree)

    def __repr__(self) -> str:
        count = len(self.positions)
        return f"{type(self).__name__}({count} point{'s' if count > 1 else ''})"


def look_at_density(shape: Shape, mass: float, name: str, *, stacklevel: int) -> None:
    """Warn where the length unit of a mesh cannot be right for a mass given [kg]."""
    if shape.corners is None or shape.volume is None:
        return
    (lowest, highest), density = DENSITIES, mass / shape.volume
    if lowest <= density <= highest:
        return
    factor = np.cbrt(density / 2000)
    change = f"{factor:.3g} times longer" if factor > 1 else f"{1 / factor:.3g} times shorter"
    warnings.warn(
        f"{name}: {mass:g} kg in this mesh's volume make {density:.3g} kg/m3, "
        f"expected {lowest:g} to {highest:g}: is its unit right? Lengths {change} would make 2000 kg/m3",
        DensityWarning,
        stacklevel=stacklevel,
    )
