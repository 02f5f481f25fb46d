"""The mutual gravity of two polyhedra at any separation without contact."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from binaryast.bodies import RigidBody
from binaryast.errors import InputError
from binaryast.gravity import Gravity
from binaryast.polyhedron import Polyhedron
from binaryast.polyhedron_table import Layer, layers_of
from binaryast.units import Floats, brief, numbers

SMALLEST, LARGEST = 1e-12, 0.01  # accuracies


@dataclass(frozen=True, eq=False)
class PolyhedronPair(Gravity):
    """Two homogeneous polyhedra, or bodies layered of such, at any separation without contact: no series is cut.

    The double integral over both surfaces is summed by rules for clusters of faces, for faces, and for parts of faces,
    the finer the nearer the two are to each other. As many as are needed are used, so that no mesh is too coarse for an
    accuracy: it is the polyhedra as they are that attract. Rules give way to finer ones gradually, and the force and
    the moment are the derivatives of the sum itself, so that a run conserves its energy whatever the accuracy.

    An evaluation takes about a millisecond, less far away and more near contact. `Multipole` takes microseconds where
    it converges, and `Adaptive` joins the two: ``ba.Adaptive(near=ba.PolyhedronPair())``. Round-off grows, relative to
    U, as the square of the distance over the sizes: from 1e-15 near contact to 1e-9 at some hundred times the sizes.
    The faces alone say how mass is spread: an ``inertia`` given to a body changes how it turns, and not this.

    Parameters
    ----------
    accuracy : float
        The error of dU/dX over its size, and of M over |X| |dU/dX|, that is aimed at; that of U is smaller. From 1e-12
        to 0.01.
    parallel : bool
        Whether each evaluation is shared out to the cores, with the same sum but for its round-off. Such a system
        must not be run from several threads at once, for which not every machine's threads are made.

    Raises
    ------
    InputError
        For another accuracy; from `System`, for bodies of other shapes; from `System.mutual_gravity`, where the bodies
        touch or lie in each other.

    References
    ----------
    The surface integral is Gauss's theorem used twice on 1/d = Laplacian of d/2: see ``kernels/mutual/polyhedra.py``.

    Examples
    --------
    Two cubes with a gap of a tenth of their edge, where the series of the multipole is slow:

    >>> import astropy.units as u
    >>> import binaryast as ba
    >>> corners = [[x, y, z] for x in (-5, 5) for y in (-5, 5) for z in (-5, 5)] * u.m
    >>> sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    >>> cube = ba.Polyhedron(corners, [t for a, b, c, d in sides for t in ((a, b, c), (a, c, d))])
    >>> bodies = [ba.RigidBody(name, cube, density=2000 * u.kg / u.m**3) for name in "AB"]
    >>> for gravity in (ba.Multipole(4), ba.Multipole(8), ba.PolyhedronPair(accuracy=1e-9)):
    ...     print(ba.System(bodies, gravity).mutual_gravity([11, 0, 0] * u.m).energy.round(4))
    -23.7867 J
    -24.0221 J
    -23.9215 J
    """

    accuracy: float = 1e-6
    parallel: bool = False

    def __post_init__(self) -> None:
        accuracy = float(numbers(self.accuracy, "PolyhedronPair: accuracy", ()))
        if not SMALLEST <= accuracy <= LARGEST:
            raise InputError(
                f"PolyhedronPair: accuracy: expected a relative error from {SMALLEST:g} to {LARGEST:g}, "
                f"got {accuracy:g}"
            )
        if not isinstance(self.parallel, (bool, np.bool_)):
            raise InputError(f"PolyhedronPair: parallel: expected True or False, got {brief(repr(self.parallel))}")
        self._set(accuracy=accuracy, parallel=bool(self.parallel))

    @property
    def potential(self) -> Callable[..., Any]:
        """The compiled pair potential."""
        if self.parallel:
            from binaryast.kernels.mutual import polyhedra_parallel

            return polyhedra_parallel.potential
        from binaryast.kernels.mutual import polyhedra

        return polyhedra.potential

    def parameters(self, secondary: RigidBody, primary: RigidBody) -> Floats:
        """Return the trees of both bodies, whose size is some hundreds of numbers for each face."""
        from binaryast.clusters import Surface, parameters_of

        surfaces = [Surface(*_surface(body)) for body in (secondary, primary)]
        gravity = secondary.si.gm * primary.si.mass
        return parameters_of(*surfaces, gravity=gravity, accuracy=self.accuracy)

    def check_place(self, secondary: RigidBody, primary: RigidBody, x: Floats, r: Floats) -> None:
        """Raise where the bodies touch or lie in each other, see `Gravity.check_place`."""
        if np.linalg.norm(x) > secondary.bounding_radius + primary.bounding_radius:
            return
        from binaryast.kernels.face_contact import contacts
        from binaryast.kernels.inside import windings

        first, second = _layers(secondary)[0].shape, _layers(primary)[0].shape
        two = _vertices(primary, second)
        one = np.ascontiguousarray(x + _vertices(secondary, first) @ r.T)
        within = windings(one[:1], two, second.faces)[0] > 0 or windings(two[:1], one, first.faces)[0] > 0
        both = np.concatenate([two, one]), np.concatenate([second.faces, first.faces + len(two)])
        if within or len(contacts(*both)):
            raise InputError(
                f"PolyhedronPair: at X = {brief(x)} m the surfaces of {primary.name} and {secondary.name} meet: "
                "expected bodies that are apart"
            )


def _layers(body: RigidBody) -> list[Layer]:
    """Return the polyhedra that make a body, or say that it is not made of such."""
    layers = layers_of(body)
    if layers is None:
        raise InputError(
            f"PolyhedronPair: {body.name} is not made of polyhedra but of a {type(body.shape).__name__}: expected "
            "ba.Polyhedron, or ba.Layered of two; use gravity=ba.Multipole(...) for other shapes"
        )
    return layers


def _surface(body: RigidBody) -> tuple[Floats, Floats]:
    """Return the triangles (F, 3, 3) of all a body's surfaces in its frame, and the step of density (F,) at each."""
    triangles, densities = [], []
    for shape, share in _layers(body):
        assert shape.volume is not None
        triangles.append(_vertices(body, shape)[shape.faces])
        densities.append(np.full(len(shape.faces), share / shape.volume))
    return np.concatenate(triangles), np.concatenate(densities)


def _vertices(body: RigidBody, shape: Polyhedron) -> Floats:
    """Return the vertices (V, 3) of one of a body's layers in the body frame [m]."""
    return np.ascontiguousarray((shape.vertices.value - body.shape.centre) @ body.turn)
