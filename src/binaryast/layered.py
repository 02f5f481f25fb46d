"""A body of two densities: a core, or a hollow, inside a shape."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from binaryast.errors import InputError
from binaryast.polyhedron import Polyhedron
from binaryast.shapes import Ellipsoid, Shape, Sphere
from binaryast.units import Floats, brief, checked, numbers

Solid = Ellipsoid | Sphere | Polyhedron


@dataclass(frozen=True, eq=False)
class Layered(Shape):
    """A homogeneous shape with another one inside, of another density: a core, or a hollow.

    Its surface is that of the outer shape, and so is its volume: a `binaryast.RigidBody` of a given ``density`` has
    that density in the mean over all of it, the hollow included.

    Parameters
    ----------
    outer, inner : Ellipsoid, Sphere or Polyhedron
        Both in one frame, ellipsoids and spheres about its origin; the inner one wholly inside.
    density_ratio : float
        Density of the inner shape over that of what surrounds it: 0 for a hollow, above 1 for a denser core.

    Raises
    ------
    InputError
        For other shapes, an inner one that reaches out of the outer one or touches it, a negative ratio.

    Examples
    --------
    A sphere of 1 km with a hollow of half its radius has 7/8 of the mass:

    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> shell = ba.Layered(ba.Sphere(1 * u.km), ba.Sphere(500 * u.m), density_ratio=0)
    >>> body = ba.RigidBody("shell", shell, mass=7e12 * u.kg)
    >>> print((body.inertia[0] / body.mass).to("km2").round(6))  # 2/5 (1 - 1/32)/(1 - 1/8)
    0.442857 km2
    """

    outer: Shape
    inner: Shape
    density_ratio: Any

    def __post_init__(self) -> None:
        outer, inner = _solid(self.outer, "outer"), _solid(self.inner, "inner")
        ratio = checked(
            numbers(self.density_ratio, "Layered: density_ratio", ()), "Layered: density_ratio", (), "non-negative"
        )
        if not surrounds(outer, inner):
            raise InputError(
                f"Layered: inner: the {type(inner).__name__} reaches out of the {type(outer).__name__} or touches it: "
                "expected it inside; both are in one frame"
            )
        assert outer.volume is not None
        self._set(density_ratio=float(ratio), volume=outer.volume, corners=outer.corners)
        one, two = self.shares
        centre = one * outer.centre + two * inner.centre
        inertia = np.zeros((3, 3))
        for share, shape in ((one, outer), (two, inner)):
            arm = shape.centre - centre
            inertia += share * (shape.specific_inertia + arm @ arm * np.eye(3) - np.outer(arm, arm))
        self._set(centre=centre, specific_inertia=inertia)

    @property
    def shares(self) -> tuple[float, float]:
        """Fractions of the mass: the outer shape, filled; and what the inner one has more than that, or less."""
        assert self.outer.volume is not None
        assert self.inner.volume is not None
        filled, excess = self.outer.volume, (self.density_ratio - 1) * self.inner.volume
        return filled / (filled + excess), excess / (filled + excess)

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments up to a total degree in a frame with that origin [m] and axes, its columns."""
        one, two = self.shares
        return np.asarray(
            one * self.outer.moments(degree, origin, turn) + two * self.inner.moments(degree, origin, turn)
        )

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as ellipsoids: that of the outer shape."""
        return self.outer.pieces


def _solid(shape: Any, name: str) -> Solid:
    """Return a shape that can be a layer."""
    if not isinstance(shape, Solid):
        raise InputError(f"Layered: {name}: expected a ba.Ellipsoid, ba.Sphere or ba.Polyhedron, got {brief(shape)}")
    return shape


def surrounds(outer: Solid, inner: Solid) -> bool:
    """Whether a shape is wholly inside another, without touching it.

    An ellipsoid is made a unit sphere by stretching the axes, which keeps faces plane.
    """
    if not isinstance(outer, Polyhedron):
        if not isinstance(inner, Polyhedron):
            return bool(np.all(inner.pieces[0][1] < outer.pieces[0][1]))
        return bool(np.all(np.linalg.norm(inner.vertices.value / outer.pieces[0][1], axis=1) < 1))  # it is convex
    if not isinstance(inner, Polyhedron):
        stretched = outer.vertices.value / inner.pieces[0][1]
        return bool(outer.holds(np.zeros((1, 3)))[0]) and distance_from_origin(stretched[outer.faces]) > 1
    from binaryast.kernels.face_contact import contacts

    one, two = outer.vertices.value, inner.vertices.value
    both = np.concatenate([one, two]), np.concatenate([outer.faces, inner.faces + len(one)])
    return bool(np.all(outer.holds(two))) and not len(contacts(*both))


def distance_from_origin(triangles: Floats) -> float:
    """Return the distance of the origin from the nearest of triangles (F, 3, 3)."""
    a, b, c = np.moveaxis(triangles, 1, 0)
    normal = np.cross(b - a, c - a)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    height = np.sum(normal * a, axis=1)
    foot = normal * height[:, None]  # of the perpendicular onto the plane, which counts where it is in the triangle
    within = np.ones(len(a), dtype=bool)
    nearest = np.full(len(a), np.inf)
    for p, q in ((a, b), (b, c), (c, a)):
        within &= np.sum(np.cross(q - p, foot - p) * normal, axis=1) >= 0
        along = np.clip(-np.sum(p * (q - p), axis=1) / np.sum((q - p) ** 2, axis=1), 0, 1)
        nearest = np.minimum(nearest, np.linalg.norm(p + along[:, None] * (q - p), axis=1))
    return float(np.min(np.where(within, np.abs(height), nearest)))
