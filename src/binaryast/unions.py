"""Shapes put together from others: contact binaries, boulders, cores."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from astropy.units import Quantity

from binaryast.errors import InputError
from binaryast.kernels.moments import second_degree, specific_inertia
from binaryast.rotations import rotation
from binaryast.shapes import Shape, look_at_density
from binaryast.units import Floats, brief, quantity, to_si
from binaryast.values import Value


class PartFloats(NamedTuple):
    """A part as plain SI floats."""

    mass: float
    offset: Floats
    turn: Floats


@dataclass(frozen=True, eq=False)
class Part(Value):
    """A shape with a mass and a place in a `Union`.

    Parameters
    ----------
    shape : Shape
        Its geometry.
    mass, density : Quantity
        One of the two. A negative one takes mass away: a hollow, or what a part lying inside another has less. Such a
        part has no surface: what it cuts out of the surface of another counts as filled where bodies touch.
    offset : Quantity, optional
        Origin (3,) of its frame in the union's (length); zero by default.
    turn : array-like or Rotation, optional
        Rotation matrix (3, 3), its frame -> the union's; the identity by default.

    Raises
    ------
    InputError
        For none or both of mass and density, zero, a shape without volume given a density, one without inertia, or a
        turn that is no rotation.

    Warns
    -----
    DensityWarning
        Where a mesh of faces and its mass make a density that no small body has: its unit of length may be wrong.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> ba.Part(ba.Sphere(10 * u.m), mass=1e7 * u.kg, offset=[0, 0, 60] * u.m).si.mass
    10000000.0
    """

    shape: Shape
    mass: Quantity | None = None
    density: Quantity | None = None
    offset: Quantity | None = None
    turn: Any = None
    si: PartFloats = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if not isinstance(self.shape, Shape):
            raise InputError(f"Part: shape: expected a shape such as ba.Ellipsoid(...), got {brief(self.shape)}")
        if not self.shape.trace_is_known:
            raise InputError(f"Part: {type(self.shape).__name__} has no inertia of its own: it cannot be a part")
        if (self.mass is None) == (self.density is None):
            raise InputError("Part: give one of mass= and density=")
        if self.density is None:
            mass = float(to_si(self.mass, "kg", "Part: mass"))
        elif self.shape.volume is None:
            raise InputError(f"Part: {type(self.shape).__name__} has no volume: give mass=, not density=")
        else:
            mass = float(to_si(self.density, "kg / m3", "Part: density")) * self.shape.volume
        if mass == 0:
            raise InputError("Part: its mass is zero: leave it out")
        offset = np.zeros(3) if self.offset is None else to_si(self.offset, "m", "Part: offset", shape=(3,))
        turn = np.eye(3) if self.turn is None else rotation(self.turn, "Part: turn", ())
        self._set(offset=quantity(offset, "m"), turn=turn, si=PartFloats(mass, offset, turn))
        if mass > 0 and self.density is None:
            look_at_density(self.shape, mass, "Part", stacklevel=4)


@dataclass(frozen=True, eq=False)
class Union(Shape):
    """Parts held together rigidly, each with a mass and a place of its own.

    Masses are added up: parts that overlap count twice where they do. The union has a mass, the sum of theirs, which a
    `RigidBody` takes where no other is given; another one scales them all. It has no volume of its own.

    Parameters
    ----------
    parts : sequence of Part
        One or more.

    Attributes
    ----------
    fractions : ndarray
        The parts' shares of the mass.

    Raises
    ------
    InputError
        For no parts, or a mass that is not positive.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> rock = 2000 * u.kg / u.m**3
    >>> body = ba.Part(ba.Ellipsoid(90 * u.m, 60 * u.m, 50 * u.m), density=rock)
    >>> head = ba.Part(ba.Sphere(40 * u.m), density=rock, offset=[110, 0, 0] * u.m)
    >>> print(ba.RigidBody("contact binary", ba.Union([body, head])).offset.value.round(1))  # m
    [21.1  0.   0. ]
    """

    parts: Sequence[Part]
    fractions: Floats = field(init=False, repr=False)

    def __post_init__(self) -> None:
        parts = tuple(self.parts) if isinstance(self.parts, Sequence) else ()
        if not parts or not all(isinstance(part, Part) for part in parts):
            raise InputError(f"Union: parts: expected a list of ba.Part(...), got {brief(self.parts)}")
        masses = np.array([part.si.mass for part in parts])
        mass = float(masses.sum())
        if mass <= 0:
            raise InputError(f"Union: the masses of its parts add up to {mass:g} kg: expected a positive mass")
        self._set(parts=parts, mass=mass, fractions=masses / mass)
        self._set(centre=self.moments(1, np.zeros(3), np.eye(3))[1:4].copy())
        about = self.moments(2, self.centre, np.eye(3))
        self._set(specific_inertia=specific_inertia(second_degree(about)))
        self._set(points=self._points(), corners=self._corners())

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments in another frame, see `Shape.moments`: each part's, taken there at once."""
        pieces = [
            part.shape.moments(degree, part.si.turn.T @ (origin - part.si.offset), part.si.turn.T @ turn)
            for part in self.parts
        ]
        return np.asarray(self.fractions @ np.array(pieces))

    def _points(self) -> tuple[Floats, Floats] | None:
        """Return the points of all parts, None where one has none."""
        positions, fractions = [], []
        for part, fraction in zip(self.parts, self.fractions, strict=True):
            if part.shape.points is None:
                return None
            positions.append(part.si.offset + part.shape.points[0] @ part.si.turn.T)
            fractions.append(part.shape.points[1] * fraction)
        return np.concatenate(positions), np.concatenate(fractions)

    def _corners(self) -> Floats | None:
        """Return the vertices of all parts with a surface, None where one is no mesh."""
        solid = self._solid
        corners = [
            part.si.offset + part.shape.corners @ part.si.turn.T for part in solid if part.shape.corners is not None
        ]
        return np.concatenate(corners) if len(corners) == len(solid) else None

    @property
    def _solid(self) -> list[Part]:
        """The parts with a surface: not those that take mass away."""
        return [part for part in self.parts if part.si.mass > 0]

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids: that of every part but those of negative mass."""
        return [
            (part.si.offset + part.si.turn @ centre, part.si.turn @ (axes if axes.ndim == 2 else np.diag(axes)))
            for part in self._solid
            for centre, axes in part.shape.pieces
        ]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self.parts)} part{'s' if len(self.parts) > 1 else ''})"
