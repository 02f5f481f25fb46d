"""Pairs of points, eight at a time, against the plain sum of them in long doubles, and when a system takes which."""

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.kernels.mutual import point_octets, points

ATTITUDE = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()


def clouds(count1: int, count2: int, size: float) -> tuple[np.ndarray, np.ndarray]:
    """Points x, y, z and mass (4, n) of both bodies."""
    random = np.random.default_rng(count1 + 7 * count2)
    return tuple(
        np.vstack([width * size * random.normal(size=(3, n)), random.uniform(0.5, 2.0, n)])
        for n, width in ((count1, 80.0), (count2, 300.0))
    )


def packed(one: np.ndarray, two: np.ndarray) -> np.ndarray:
    """The parameters of the kernels."""
    return np.concatenate([[one.shape[1], two.shape[1]], one.ravel(), two.ravel()])


def plain(one: np.ndarray, two: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """U, dU/dX and M, and the sums of the sizes of their terms, to which round-off is relative."""
    one, two, x = (array.astype(np.longdouble) for array in (one, two, x))
    arm = ATTITUDE @ one[:3]
    d = x[:, None, None] + arm[:, :, None] - two[:3, None, :]
    distance = np.sqrt((d * d).sum(axis=0))
    k = one[3][:, None] * two[3] / distance
    force = k * d / distance**2
    moment = np.cross(np.broadcast_to(arm[:, :, None], force.shape), force, axis=0)
    terms = np.concatenate([-k[None], force, moment])
    return terms.sum(axis=(1, 2)), np.abs(terms).sum(axis=(1, 2))


@pytest.mark.parametrize("size", [1e-15, 1.0, 1e15])
@pytest.mark.parametrize(("count1", "count2"), [(8, 1), (8, 8), (16, 16), (9, 3), (31, 64), (200, 300)])
def test_eight_at_a_time_give_the_sum_of_all(count1: int, count2: int, size: float) -> None:
    one, two = clouds(count1, count2, size)
    x = np.array([1190.0, 130.0, -220.0]) * size
    found = point_octets.potential(packed(one, two), *x, *ATTITUDE.ravel())
    expected, terms = plain(one, two, x)
    np.testing.assert_array_less(np.abs(found - expected) / terms, 1e-15)


def test_one_cloud_about_the_other() -> None:
    """At X = 0, where the size of the configuration is that of the clouds."""
    one, two = clouds(16, 9, 1.0)
    zero = np.zeros(3)
    found = point_octets.potential(packed(one, two), *zero, *ATTITUDE.ravel())
    expected, terms = plain(one, two, zero)
    np.testing.assert_array_less(np.abs(found - expected) / terms, 1e-15)


def test_points_in_one_place_give_no_number() -> None:
    one, two = clouds(8, 3, 1.0)
    two[:3, 1] = np.array([500.0, 0, 0]) + ATTITUDE @ one[:3, 4]
    values = point_octets.potential(packed(one, two), 500.0, 0.0, 0.0, *ATTITUDE.ravel())
    assert not np.isfinite(values[1])


def test_a_system_takes_eight_at_a_time_where_there_are_so_many() -> None:
    for count, kernel in ((7, points.potential), (8, point_octets.potential)):
        cloud = ba.PointCloud(clouds(count, 1, 1.0)[0][:3].T * u.m)
        bodies = [ba.RigidBody(name, cloud, mass=1e9 * u.kg) for name in "ab"]
        assert ba.System(bodies, gravity=ba.PointPairs()).pairs[0].potential is kernel
