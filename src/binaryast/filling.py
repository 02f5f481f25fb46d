"""Shapes filled with point masses (mascons) that have their mass centre and inertia exactly."""

from collections.abc import Callable
from typing import Literal

import numpy as np

from binaryast.errors import InputError
from binaryast.layered import Layered
from binaryast.polyhedron import Polyhedron
from binaryast.shapes import Dumbbell, Ellipsoid, PointCloud, Shape, Sphere
from binaryast.units import Floats, brief, quantity

SOLIDS = (Ellipsoid, Sphere, Dumbbell, Polyhedron, Layered)


def mascons(shape: Shape, *, count: int, arrangement: Literal["grid", "random"] = "grid", seed: int = 0) -> PointCloud:
    """Fill a shape with point masses that have its mass centre and its inertia exactly.

    The points are those inside of a cubic grid about the mass centre, or random ones; their masses are equal, but in a
    core, where they are as much larger as its density is. They are then moved by the affine map nearest to none that
    brings their mass centre and second moments to those of the shape: the masses stay positive however few points there
    are, and a small count moves some points a little outside of the surface.

    Parameters
    ----------
    shape : Ellipsoid, Sphere, Dumbbell, Polyhedron or Layered
        What to fill. A hollow stays empty.
    count : int
        How many points; on a grid about as many. 10^3 have the third and fourth moments to about 1 % on a grid and to
        about 5 % at random.
    arrangement : {"grid", "random"}
        How they lie. A grid is nearer to the shape for as many points.
    seed : int
        Of the random numbers: the same one gives the same points.

    Returns
    -------
    PointCloud
        In the shape's own frame.

    Raises
    ------
    InputError
        For a shape without an inside, another arrangement, or so few points that they lie in a plane.

    References
    ----------
    The map is the one that moves a normal distribution to another one with the least mean square of the ways: I. Olkin,
    F. Pukelsheim, Linear Algebra Appl. 48 (1982) 257.

    Examples
    --------
    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> shape = ba.Ellipsoid(3 * u.km, 2 * u.km, 1 * u.km)
    >>> body = ba.RigidBody("rock", ba.mascons(shape, count=1000), mass=5 * u.kg)
    >>> print(body.inertia.to("kg km2").round(9))
    [ 5. 10. 13.] km2 kg
    """
    if not isinstance(shape, SOLIDS):
        kinds = ", ".join(f"ba.{kind.__name__}" for kind in SOLIDS)
        raise InputError(f"mascons: {brief(shape)} has no inside to fill: expected one of {kinds}")
    if isinstance(count, bool) or not isinstance(count, (int, np.integer)) or count < 4:
        raise InputError(f"mascons: count={count!r}: expected a whole number of points, four or more")
    if not isinstance(arrangement, str) or arrangement not in ARRANGEMENTS:
        raise InputError(f"mascons: arrangement={brief(repr(arrangement))}: expected 'grid' or 'random'")
    if isinstance(seed, bool) or not isinstance(seed, (int, np.integer)) or seed < 0:
        raise InputError(f"mascons: seed={seed!r}: expected a whole number, 0 or more")
    points, densities = ARRANGEMENTS[arrangement](shape, int(count), int(seed))
    return PointCloud(quantity(_matched(points, densities, shape), "m"), densities)


def _grid(shape: Shape, count: int, seed: int) -> tuple[Floats, Floats]:  # noqa: ARG001
    """Return the middles (k, 3) of the cells of a cubic grid that lie inside, and the densities there."""
    low, high = _box(shape)
    cell = np.cbrt(_filled_volume(shape) / count)
    first, last = np.floor((low - shape.centre) / cell), np.ceil((high - shape.centre) / cell)
    axes = [shape.centre[i] + (np.arange(first[i], last[i]) + 0.5) * cell for i in range(3)]
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    densities = density(shape, points)
    return points[densities > 0], densities[densities > 0]


def _random(shape: Shape, count: int, seed: int) -> tuple[Floats, Floats]:
    """Return random points (count, 3) that lie inside, and the densities there."""
    generator = np.random.default_rng(seed)
    low, high = _box(shape)
    share = _filled_volume(shape) / float(np.prod(high - low))
    points, densities = np.empty((0, 3)), np.empty(0)
    while len(points) < count:
        more = generator.uniform(low, high, size=(int(1.1 * (count - len(points)) / share) + 10, 3))
        there = density(shape, more)
        points, densities = np.concatenate([points, more[there > 0]]), np.concatenate([densities, there[there > 0]])
    return points[:count], densities[:count]


ARRANGEMENTS: dict[str, Callable[[Shape, int, int], tuple[Floats, Floats]]] = {"grid": _grid, "random": _random}


def density(shape: Shape, points: Floats) -> Floats:
    """Return the density at points (k, 3) [m] in a shape's frame over that of its outermost layer; 0 outside."""
    if isinstance(shape, Layered):
        core = density(shape.inner, points) > 0
        return np.where(core, shape.density_ratio, density(shape.outer, points))
    if isinstance(shape, Polyhedron):
        return shape.holds(points).astype(np.float64)
    inside = np.zeros(len(points), dtype=bool)
    for centre, axes in shape.pieces:
        inside |= np.sum(((points - centre) / axes) ** 2, axis=1) < 1
    return inside.astype(np.float64)


def _filled_volume(shape: Shape) -> float:
    """Return the volume that points lie in [m3]."""
    assert shape.volume is not None
    hollow = shape.inner.volume if isinstance(shape, Layered) and shape.density_ratio == 0 else 0.0
    assert hollow is not None
    return shape.volume - hollow


def _box(shape: Shape) -> tuple[Floats, Floats]:
    """Return the lowest and highest coordinates (3,) of a shape [m]."""
    if shape.corners is not None:
        return shape.corners.min(axis=0), shape.corners.max(axis=0)
    ends = np.array([[centre - axes, centre + axes] for centre, axes in shape.pieces])
    return ends[:, 0].min(axis=0), ends[:, 1].max(axis=0)


def _matched(points: Floats, weights: Floats, shape: Shape) -> Floats:
    """Return points moved by an affine map so that mass centre and second moments about it are the shape's."""
    fractions = weights / weights.sum()
    wanted = np.trace(shape.specific_inertia) / 2 * np.eye(3) - shape.specific_inertia
    for _ in range(2):  # the second time takes what round-off left
        arms = points - fractions @ points
        found = (arms * fractions[:, None]).T @ arms
        sizes = np.linalg.eigvalsh(found) if len(points) else np.zeros(3)
        if sizes[0] <= 1e-9 * sizes[-1]:
            raise InputError(
                f"mascons: {len(points)} points inside, in a plane or less: expected a larger count, or "
                "arrangement='random'"
            )
        root = _root(found)
        back = np.linalg.inv(root)
        points = shape.centre + arms @ (back @ _root(root @ wanted @ root) @ back)
    return points


def _root(matrix: Floats) -> Floats:
    """Return the square root of a positive definite matrix."""
    squares, axes = np.linalg.eigh(matrix)
    return np.asarray((axes * np.sqrt(squares)) @ axes.T)
