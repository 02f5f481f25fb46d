"""A homogeneous body whose surface is a closed mesh of triangles."""

import warnings
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from astropy.units import Quantity, UnitBase
from numpy.typing import NDArray

from binaryast.errors import InputError, MeshWarning
from binaryast.meshes import Mesh, as_faces
from binaryast.shapes import Shape
from binaryast.units import Floats, Indices, as_quantity, as_unit, quantity, to_si

LARGEST_SIZE = 1e20  # m: its twelfth power times a volume still is a number


@dataclass(frozen=True, eq=False, repr=False)
class Polyhedron(Shape):
    """A homogeneous polyhedron: volume, mass centre, inertia and all moments are exact, by signed sums over its faces.

    It need be neither convex nor star-shaped, and its frame may lie anywhere. The mesh is checked here: closed, every
    face outward, in one piece, nowhere in contact with itself, every vertex used and once only.

    For contact in a run its surface is taken to be that of the ellipsoid with its volume and its axes of inertia, which
    lies partly inside and partly outside of it: contact is found to within the relief. Pictures show the outline of the
    faces.

    Parameters
    ----------
    vertices : Quantity
        Vertices (V, 3) in the shape's own frame (length).
    faces : array-like
        For each face (F, 3) the indices of its vertices, from 0, anticlockwise as seen from outside.

    Raises
    ------
    UnitError
        For vertices without a unit of length.
    MeshError
        For a mesh with defects: each is named with its count and what mends it.
    InputError
        For arrays of other shapes, values that are not finite, a vertex that does not exist.

    References
    ----------
    Moments: see ``kernels/polyhedron.py``. For degree 2 they are those of A. R. Dobrovolskis, Icarus 124 (1996) 698.

    Examples
    --------
    A tetrahedron with three edges of 1 km along the axes:

    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] * u.km
    >>> shape = ba.Polyhedron(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
    >>> shape
    Polyhedron(4 vertices, 4 faces)
    >>> round(shape.volume)  # m3
    166666667
    >>> print(ba.RigidBody("rock", shape, density=2000 * u.kg / u.m**3).offset)
    [250. 250. 250.] m
    """

    vertices: Quantity
    faces: Any

    def __post_init__(self) -> None:
        from binaryast.kernels.polyhedron import volume_moments
        from binaryast.meshes.checks import refuse

        vertices, faces = _arrays(self.vertices, self.faces)
        refuse(Mesh(vertices, faces), "Polyhedron")
        centre = vertices.mean(axis=0)
        for _ in range(2):  # about any point, then about the mass centre, where round-off is least
            volume, *first = volume_moments(vertices - centre, faces, 1)
            centre = centre + np.array(first) / volume
        self._set(
            vertices=quantity(vertices, "m"),
            faces=faces,
            corners=vertices,
            volume=float(volume),
            centre=centre,
        )
        xx, xy, xz, yy, yz, zz = self.moments(2, centre, np.eye(3))[4:]
        second = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        self._set(specific_inertia=np.trace(second) * np.eye(3) - second)

    @classmethod
    def read(cls, path: Any, unit: UnitBase, *, facets: Any = None, mend: bool = False) -> "Polyhedron":
        r"""Read a mesh from a file.

        Parameters
        ----------
        path : path
            OBJ, PLY or STL; a ``.tab`` of the Planetary Data System, in either layout; or a ``.csv`` of vertices (any
            number, x, y, z), which needs ``facets`` too. The vertices of STL are merged, others are taken as they are.
        unit : Unit
            The file's unit of length, such as ``u.km``: files do not say it.
        facets : path, optional
            A ``.csv`` of faces (v1, v2, v3, counted from 1) that goes with the vertices.
        mend : bool
            Whether to mend what can be mended; see `mended`.

        Returns
        -------
        Polyhedron

        Raises
        ------
        StorageError
            Where there is no such file.
        MeshError
            Where it is not understood, or the mesh has defects.
        UnitError
            For a unit that is not one of length.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> lines = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     file = pathlib.Path(folder, "rock.obj")
        ...     _ = file.write_text(lines)
        ...     ba.Polyhedron.read(file, unit=u.km)
        Polyhedron(4 vertices, 4 faces)
        """
        from binaryast.meshes.files import as_file, read_mesh

        unit = as_unit(unit, "m", "Polyhedron.read: unit")
        path = as_file(path, "Polyhedron.read")
        mesh = read_mesh(path, None if facets is None else as_file(facets, "Polyhedron.read: facets"))
        try:
            shape, done = _build(cls, Quantity(mesh.vertices, unit), mesh.faces, mend=mend)
        except InputError as error:
            raise type(error)(f"{path}: {error}") from None
        if done:
            warnings.warn(f"{path}: mended: {', '.join(done)}", MeshWarning, stacklevel=2)
        return shape

    @classmethod
    def mended(cls, vertices: Quantity, faces: Any) -> "Polyhedron":
        """Return a polyhedron of a mesh with mendable defects, and say in a warning what was done.

        Vertices in one place are merged, vertices without a face removed, so are faces that stand twice or have a
        vertex twice, and faces are turned outward. Holes, crossings and separate surfaces remain errors.

        Parameters
        ----------
        vertices, faces
            As for the class.

        Returns
        -------
        Polyhedron

        Warns
        -----
        MeshWarning
            What was done; nothing where there was nothing to do.

        Examples
        --------
        >>> import warnings
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [5, 5, 5]] * u.km
        >>> with warnings.catch_warnings(record=True) as caught:
        ...     warnings.simplefilter("always")
        ...     shape = ba.Polyhedron.mended(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> print(caught[0].message)
        Polyhedron: mended: 1 vertex removed that no face uses
        """
        shape, done = _build(cls, vertices, faces, mend=True)
        if done:
            warnings.warn(f"Polyhedron: mended: {', '.join(done)}", MeshWarning, stacklevel=2)
        return shape

    def moments(self, degree: int, origin: Floats, turn: Floats) -> Floats:
        """Return the specific moments up to a total degree in a frame with that origin [m] and axes, its columns.

        They are computed anew from the vertices in that frame, so nothing cancels.
        """
        from binaryast.kernels.polyhedron import volume_moments

        vertices = np.ascontiguousarray((self.vertices.value - origin) @ turn)
        result = volume_moments(vertices, self.faces, degree)
        return np.asarray(result / result[0])

    def contains(self, points: Quantity) -> NDArray[np.bool_]:
        """Return whether points are inside; on the surface itself round-off decides.

        Parameters
        ----------
        points : Quantity
            Positions (k, 3) in the shape's own frame (length).

        Returns
        -------
        ndarray
            Truth values (k,).

        Examples
        --------
        >>> import astropy.units as u
        >>> import binaryast as ba
        >>> corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]] * u.km
        >>> shape = ba.Polyhedron(corners, [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])
        >>> shape.contains([[100, 100, 100], [500, 500, 500]] * u.m)
        array([ True, False])
        """
        given = as_quantity(points, "m", "Polyhedron.contains: points")
        if given.ndim != 2 or given.shape[1] != 3:
            raise InputError(f"Polyhedron.contains: points: expected an array of shape (k, 3), got shape {given.shape}")
        return self.holds(to_si(given, "m", "Polyhedron.contains: points", shape=given.shape))

    def holds(self, points: Floats) -> NDArray[np.bool_]:
        """Return whether points (k, 3) [m] are inside, as `contains` does, without units."""
        from binaryast.kernels.inside import windings

        return np.asarray(windings(np.ascontiguousarray(points), self.vertices.value, self.faces) > 0)

    @property
    def pieces(self) -> list[tuple[Floats, Floats]]:
        """The surface as an ellipsoid: with the volume, and with semi-axes in the ratio that the inertia says."""
        inertia = self.specific_inertia
        squares, axes = np.linalg.eigh(np.trace(inertia) / 2 * np.eye(3) - inertia)  # a^2/5, b^2/5, c^2/5
        sizes = np.sqrt(squares)
        assert self.volume is not None
        scale = np.cbrt(self.volume / (4 / 3 * pi * np.prod(sizes)))
        return [(self.centre, axes * (scale * sizes))]

    def __repr__(self) -> str:
        return f"{type(self).__name__}({len(self.vertices)} vertices, {len(self.faces)} faces)"


def _build(kind: type[Polyhedron], vertices: Quantity, faces: Any, *, mend: bool) -> tuple[Polyhedron, list[str]]:
    """Return a polyhedron and what was mended for it."""
    from binaryast.meshes.mending import mended

    if not mend:
        return kind(vertices, faces), []
    mesh, done = mended(Mesh(*_arrays(vertices, faces)))
    return kind(quantity(mesh.vertices, "m"), mesh.faces), done


def _arrays(vertices: Any, faces: Any) -> tuple[Floats, Indices]:
    """Return what the user gave as arrays of vertices [m] and faces, looked at one by one."""
    given = as_quantity(vertices, "m", "Polyhedron: vertices")
    if given.ndim != 2 or given.shape[1] != 3:
        raise InputError(f"Polyhedron: vertices: expected an array of shape (V, 3), got shape {given.shape}")
    floats = to_si(given, "m", "Polyhedron: vertices", shape=given.shape)
    size = float(np.ptp(floats, axis=0).max(initial=0.0)) if len(floats) else 0.0
    if size and not 1 / LARGEST_SIZE < size < LARGEST_SIZE:
        raise InputError(
            f"Polyhedron: vertices: a size of {size:g} m is beyond what can be computed with: "
            f"{1 / LARGEST_SIZE:g} to {LARGEST_SIZE:g} m"
        )
    return floats, as_faces(faces, len(given), "Polyhedron: faces")
