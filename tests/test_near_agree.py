"""Models that share nothing agree near contact: two ellipsoids, exactly and as polyhedra with more and more faces."""

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import Gravity
from tests.solids import icosphere

AXES = {"A": (420.0, 400.0, 330.0), "B": (100.0, 80.0, 60.0)}  # m
DENSITY = 2000 * u.kg / u.m**3
PLACE = np.array([510.0, 60.0, -40.0]) * u.m  # some ten metres from contact
ATTITUDE = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()


def attraction(shapes: list, gravity: Gravity) -> np.ndarray:
    """Return U and dU/dX, each over its size at the first body's mass."""
    bodies = [ba.RigidBody(name, shape, density=DENSITY) for name, shape in zip(AXES, shapes, strict=True)]
    found = ba.System(bodies, gravity=gravity).mutual_gravity(PLACE, ATTITUDE)
    return np.concatenate([[found.energy.value], found.gradient.value])


def test_polyhedra_converge_to_the_ellipsoids_at_the_order_of_the_mesh() -> None:
    exact = attraction([ba.Ellipsoid(*(axes * u.m)) for axes in AXES.values()], ba.EllipsoidPair())
    errors = []
    for divisions in (1, 2, 3):
        vertices, faces = icosphere(divisions)
        meshes = [ba.Polyhedron(vertices * axes * u.m, faces) for axes in AXES.values()]
        found = attraction(meshes, ba.PolyhedronPair(1e-8))
        errors.append(np.abs(found / exact - 1)[:2])  # U, and the force along the line of centres
    orders = np.log2(np.divide(errors[:-1], errors[1:]))
    np.testing.assert_allclose(orders[-1], 2, atol=0.15)
    assert np.max(errors[-1]) < 0.02
