"""The multipole potential against what it is cut from, with nothing in common: sums over pairs of points."""

import os
import subprocess
import sys
import threading
from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import LARGEST_DEGREE
from binaryast.kernels.mutual.multipole_kernels import potential_of

X = np.array([3.1, 1.3, -2.2])
R = Rotation.from_rotvec([0.4, -0.9, 0.7]).as_matrix()


def cloud(seed: int, size: float, count: int = 7) -> ba.RigidBody:
    """Return a body of points, whose moments of all degrees do not vanish."""
    random = np.random.default_rng(seed)
    points = random.normal(size=(count, 3)) * size
    return ba.RigidBody(str(seed), ba.PointCloud(points * u.m, random.uniform(1, 2, count)), gm=1 * u.m**3 / u.s**2)


PRIMARY, SECONDARY = cloud(1, 0.3), cloud(2, 0.25)


def terms(x: np.ndarray, r: np.ndarray, degree: int) -> list:
    """Return the terms of -U/(G m1 m2) of each degree in d = R rho1 - rho2: |d|^n P_n(-cos(X, d))/r^(n + 1), summed.

    Legendre's recurrence, without harmonics, moments or frames; of analytic functions, so that x and r can be complex.
    """
    (p1, f1), (p2, f2) = SECONDARY.points, PRIMARY.points
    d = (p1 @ r.T)[:, None] - p2[None]
    weights, square, distance = np.outer(f1, f2), (d * d).sum(-1), np.sqrt((x * x).sum())
    along = -(d @ x) / distance
    previous, current, result = 0 * square, 0 * square + 1, []
    for n in range(degree + 1):
        result.append((weights * current).sum() / distance ** (n + 1))
        previous, current = current, ((2 * n + 1) * along * current - n * square * previous) / (n + 1)
    return result


def cut(x: np.ndarray, r: np.ndarray, degree: int) -> complex:
    """Return U/(G m1 m2) up to a degree."""
    return -sum(terms(x, r, degree))


def exact(x: np.ndarray, r: np.ndarray = R) -> np.ndarray:
    """Return U, dU/dX and M over G m1 m2: the sum over all pairs."""
    system = ba.System([PRIMARY, SECONDARY], ba.PointPairs())
    return np.array(system.attraction(x, r)) / SECONDARY.si.gm / PRIMARY.si.mass


def found(degree: int, x: np.ndarray = X, r: np.ndarray = R) -> np.ndarray:
    system = ba.System([PRIMARY, SECONDARY], ba.Multipole(degree))
    return np.array(system.attraction(x, r)) / SECONDARY.si.gm / PRIMARY.si.mass


def hat(a: np.ndarray) -> np.ndarray:
    return np.array([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


@pytest.mark.parametrize("degree", [2, 3, 4, 5, 6, 8, 11, LARGEST_DEGREE])
def test_energy_force_and_moment_are_those_of_the_cut_sum(degree: int) -> None:
    """Force and moment by steps into the complex plane, which lose no digits."""
    for x, r in ((X, R), (np.array([0, 0, 4.0]), R), (np.array([0, -4.0, 0]), np.eye(3)), (X, np.diag([1.0, -1, -1]))):
        ours = found(degree, x, r)
        assert ours[0] == pytest.approx(cut(x, r, degree), rel=1e-14)
        h = 1e-30
        gradient = [cut(x + 1j * h * e, r, degree).imag / h for e in np.eye(3)]
        np.testing.assert_allclose(ours[1:4], gradient, atol=1e-13 * np.linalg.norm(gradient))
        moment = [cut(x, r + 1j * h * hat(e) @ r, degree).imag / h for e in np.eye(3)]
        size, force = np.linalg.norm(moment), np.linalg.norm(gradient)
        if size < 1e-12 * force:  # it vanishes, along principal axes
            size = force
        np.testing.assert_allclose(ours[4:], moment, atol=1e-13 * size)


def test_the_error_falls_with_every_degree() -> None:
    """As (size/r)^(N + 1) in U and force, as (size/r)^(N - 1) in M beside its size, which falls as (size/r)^2."""
    directions = Rotation.random(8, random_state=5).apply(X)
    parts = (slice(0, 1), slice(1, 4), slice(4, 7))
    for degree in (2, 3, 4, 5, 6):
        sizes = []
        for scale in (3.0, 6.0):
            truth = np.array([exact(scale * x) for x in directions])
            ours = np.array([found(degree, scale * x) for x in directions])
            sizes.append([np.linalg.norm((ours - truth)[:, part]) / np.linalg.norm(truth[:, part]) for part in parts])
        orders = np.log2(np.array(sizes[0]) / sizes[1])
        np.testing.assert_allclose(orders, [degree + 1, degree + 1, degree - 1], atol=0.15)


def test_it_converges_to_the_sum_over_pairs() -> None:
    truth, ours = exact(3 * X, R), found(LARGEST_DEGREE, 3 * X)
    np.testing.assert_allclose(ours[:4], truth[:4], rtol=2e-14)
    np.testing.assert_allclose(ours[4:], truth[4:], atol=1e-11 * np.linalg.norm(truth[4:]))


@pytest.mark.parametrize("degree", [3, 6])
def test_homogeneity(degree: int) -> None:
    """Sizes and distance twice as large: U half of it, the force a quarter, M half."""
    bodies = [
        ba.RigidBody(body.name, ba.PointCloud(body.shape.positions * 2, body.shape.weights), gm=body.gm)
        for body in (PRIMARY, SECONDARY)
    ]
    larger = np.array(ba.System(bodies, ba.Multipole(degree)).attraction(2 * X, R)) / SECONDARY.si.gm / PRIMARY.si.mass
    np.testing.assert_allclose(larger * [2, 4, 4, 4, 2, 2, 2], found(degree), rtol=1e-13)


EXACT_PAIRS = {  # U/(G m1 m2) of two ellipsoids by quadrature, and what remains at each degree
    ((400, 395, 340), (85, 73, 63), (1195, 0, 0), (0, 0, 0)): (
        -8.39992172639902e-4,
        {2: 4.2e-5, 4: 7.1e-7, 6: 1.5e-8, 8: 3.7e-10, 10: 1.0e-11, 12: 2.9e-13},
    ),
    ((1, 0.5, 0.3), (0.7, 0.4, 0.25), (6, 2, 1), (30, 20, 10)): (
        -1.56938569657589e-1,
        {2: 5.8e-5, 4: 9.2e-7, 6: 1.6e-8, 8: 2.7e-10, 10: 2.4e-12},
    ),
}


@pytest.mark.parametrize("pair", EXACT_PAIRS)
def test_exact_pairs_of_ellipsoids(pair: tuple) -> None:
    a, b, x, angles = pair
    energy, errors = EXACT_PAIRS[pair]
    bodies = [ba.RigidBody(n, ba.Ellipsoid(*(axes * u.m)), mass=1 * u.kg) for n, axes in (("A", a * 1), ("B", b * 1))]
    turn = Rotation.from_euler("ZXZ", angles, degrees=True)
    for degree, error in errors.items():
        ours = ba.System(bodies, ba.Multipole(degree)).mutual_gravity(x * u.m, turn).energy.value
        assert abs(ours / (bodies[0].si.gm * energy) - 1) == pytest.approx(error, rel=0.05)
    most = ba.System(bodies, ba.Multipole(LARGEST_DEGREE)).mutual_gravity(x * u.m, turn).energy.value
    assert most == pytest.approx(bodies[0].si.gm * energy, rel=1e-13)


def test_degree_2_is_second_degree(didymos: ba.System) -> None:
    for bodies in (didymos.bodies, (PRIMARY, SECONDARY)):
        scale = bodies[0].bounding_radius * 3 or 1
        two, second = (ba.System(bodies, gravity).attraction(scale * X, R) for gravity in GRAVITIES)
        np.testing.assert_allclose(two[:4], second[:4], rtol=1e-14)
        np.testing.assert_allclose(two[4:], second[4:], rtol=1e-12)


GRAVITIES = (ba.Multipole(2), ba.SecondDegree())


def test_dumbbells_attract_like_pairs_of_points() -> None:
    """Their moments are those of two spheres."""
    bodies = [ba.RigidBody(n, ba.Dumbbell(0.5 * u.m, 0.2 * u.m), mass=1 * u.kg) for n in "AB"]
    one, two = (ba.System(bodies, gravity).attraction(2 * X, R) for gravity in (ba.Multipole(12), ba.PointPairs()))
    np.testing.assert_allclose(one[:4], two[:4], rtol=1e-13)
    np.testing.assert_allclose(one[4:], two[4:], rtol=1e-8)


@pytest.mark.parametrize("degree", [2, 4, 7, 8])
def test_the_kernel_of_even_moments_is_the_general_one_without_zeros(didymos: ba.System, degree: int) -> None:
    parameters = ba.Multipole(degree).parameters(*didymos.bodies)
    arguments = (parameters, *(500 * X), *R.ravel())
    even, general = potential_of(degree, even=True)(*arguments), potential_of(degree, even=False)(*arguments)
    np.testing.assert_allclose(even, general, rtol=1e-12)
    assert ba.System(didymos.bodies, ba.Multipole(degree)).pairs[0].potential is potential_of(degree, even=True)
    of_clouds = ba.System([PRIMARY, SECONDARY], ba.Multipole(degree)).pairs[0].potential
    assert of_clouds is potential_of(degree, even=degree == 2)  # principal axes leave only even moments of degree 2


def test_kernels_kept_by_different_processes_do_not_meet(tmp_path: Path) -> None:
    """numba finds a kept function by its name: each degree has one of its own."""
    code = (
        "import sys, binaryast as ba; system, state = ba.catalogue.load('didymos'); relative = state.relative()\n"
        "for degree in sys.argv[1:]:\n"
        "    import astropy.units as u\n"
        "    pair = ba.System(system.bodies, ba.Multipole(int(degree)))\n"
        "    run = ba.propagate(pair, state, duration=80 * u.s, integrator=ba.LGVI(40 * u.s))\n"
        "    print(run.potential_energy[-1].value / pair.mutual_gravity(relative.X, relative.R).energy.value - 1)\n"
    )
    for degrees in (("3",), ("2",), ("2", "3", "5")):
        result = subprocess.run(
            [sys.executable, "-c", code, *degrees],
            capture_output=True,
            text=True,
            check=True,
            env=os.environ | {"BINARYAST_CACHE_DIR": str(tmp_path)},
        )
        assert all(abs(float(line)) < 1e-5 for line in result.stdout.split())


def test_threads_do_not_disturb_each_other() -> None:
    potential = potential_of(8, even=False)
    p = ba.Multipole(8).parameters(SECONDARY, PRIMARY)
    places = [X * (1 + 0.1 * k) for k in range(4)]
    expected = [potential(p, *x, *R.ravel()) for x in places]
    wrong = []

    def evaluate(k: int) -> None:
        if any(potential(p, *places[k], *R.ravel()) != expected[k] for _ in range(3000)):
            wrong.append(k)

    threads = [threading.Thread(target=evaluate, args=(k,)) for k in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong


@pytest.mark.parametrize("degree", [1, 0, -2, 17, 40, 4.0, 2.5, True, "4", None, np.nan])
def test_degrees_that_are_refused(degree: object) -> None:
    with pytest.raises(ba.errors.InputError, match=r"Multipole: degree: expected a whole number from 2 to 16, got"):
        ba.Multipole(degree)


def test_sizes_beyond_what_can_be_computed_with() -> None:
    bodies = [ba.RigidBody(n, ba.Ellipsoid(1e20 * u.m, 2e20 * u.m, 2e20 * u.m), mass=1e30 * u.kg) for n in "AB"]
    with pytest.raises(ba.errors.InputError, match="sizes are beyond"):
        ba.System(bodies, ba.Multipole(16))


def test_the_next_terms_are_what_the_next_two_degrees_add() -> None:
    for degree in (2, 3, 6):
        (size,) = ba.Multipole(degree).next_terms(SECONDARY, PRIMARY, X[None], R[None])
        both = np.abs(terms(X, R, degree + 2)[-2:]).sum() * np.linalg.norm(X)
        assert size == pytest.approx(both, rel=1e-12)
    (size,) = ba.Multipole(2).next_terms(SECONDARY, PRIMARY, np.array([[0, 0, 4.0]]), R[None])
    assert size == pytest.approx(4 * np.abs(terms(np.array([0, 0, 4.0]), R, 4)[-2:]).sum(), rel=1e-12)
    assert ba.PointPairs().next_terms(SECONDARY, PRIMARY, X[None], R[None]) is None
    large = [ba.RigidBody(n, ba.Ellipsoid(1e80 * u.m, 2e80 * u.m, 2e80 * u.m), mass=1e30 * u.kg) for n in "AB"]
    assert ba.Multipole(2).next_terms(*large, X[None], R[None]) is None
