"""What the tests share: a few systems, and a matplotlib that opens no windows."""

import astropy.units as u
import hypothesis
import matplotlib as mpl
import numpy as np
import pytest

import binaryast as ba
from binaryast.outcome import Watch
from binaryast.working import Working

mpl.use("agg")
hypothesis.settings.register_profile("patient", deadline=None)  # the first example may have to compile
hypothesis.settings.load_profile("patient")


@pytest.fixture(scope="session")
def didymos() -> ba.System:
    """The catalogue's pair."""
    return ba.catalogue.load("didymos")[0]


def tumbling_pair() -> tuple[ba.System, ba.State]:
    """Two triaxial bodies in full tumble on an inclined, eccentric orbit: nothing is special about it."""
    primary = ba.RigidBody("A", ba.Ellipsoid(420 * u.m, 400 * u.m, 330 * u.m), density=2400 * u.kg / u.m**3)
    secondary = ba.RigidBody("B", ba.Ellipsoid(100 * u.m, 80 * u.m, 60 * u.m), density=2400 * u.kg / u.m**3)
    system = ba.System([primary, secondary])
    spins = [[3e-5, -2e-5, 7.5e-4], [-4e-5, 6e-5, 1.5e-4]] * u.rad / u.s
    state = ba.State.from_elements(
        system,
        semi_major_axis=1150 * u.m,
        eccentricity=0.08,
        inclination=20 * u.deg,
        longitude_of_ascending_node=50 * u.deg,
        argument_of_periapsis=70 * u.deg,
        true_anomaly=30 * u.deg,
        spins=list(spins),
    )
    return system, state


def wobbling_pair() -> tuple[ba.System, ba.State]:
    """Didymos with its pole tilted by 5 degrees and wobbling, Dimorphos librating and inclined: regular, not planar."""
    system, _ = ba.catalogue.load("didymos")
    rate = 2 * np.pi / (2.26 * 3600)
    spins = [[0.06 * rate, 0.06 * rate, rate], [3e-6, -2e-6, 1.5e-4]] * u.rad / u.s
    state = ba.State.from_elements(
        system, semi_major_axis=1190 * u.m, eccentricity=0.03, inclination=5 * u.deg, spins=list(spins)
    )
    return system, state


@pytest.fixture(scope="session")
def tumbling() -> tuple[ba.System, ba.State]:
    """`tumbling_pair`."""
    return tumbling_pair()


def attitude_angle(one: np.ndarray, two: np.ndarray) -> float:
    """Return the largest angle [rad] between two stacks of attitudes, exact for small ones."""
    return float(np.linalg.norm(one - two, axis=(-2, -1)).max() / np.sqrt(2))


def take_steps(w: Working, h: float, count: int) -> np.ndarray:
    """Take production steps, in place; return what was watched."""
    watch = Watch()
    watch.begin(w.measure(w.state, w.constants), 0.0)
    kernel = ba.LGVI(1 * u.s).kernel(inertial=len(w.before) > 3)
    rows = np.empty((1, w.row_size))
    arrays = (w.attraction, w.parameters, w.constants, np.zeros_like(w.surfaces), w.state, w.before, watch.array)
    status = w.advance(kernel, w.measure, w.touching, *arrays, h, count, count, rows)
    assert status == 0
    return watch.array


def four_bodies() -> tuple[ba.System, ba.State]:
    """Four bodies of three kinds, each pair with its own gravity: two ellipsoids, a dumbbell and a point."""
    bodies = [
        ba.RigidBody("A", ba.Ellipsoid(420 * u.m, 400 * u.m, 330 * u.m), density=2400 * u.kg / u.m**3),
        ba.RigidBody("B", ba.Ellipsoid(100 * u.m, 80 * u.m, 60 * u.m), density=2400 * u.kg / u.m**3),
        ba.RigidBody("rod", ba.Dumbbell(200 * u.m, 30 * u.m), mass=2e9 * u.kg),
        ba.RigidBody("dust", ba.Point(), mass=1e6 * u.kg),
    ]
    gravity = {("rod", "dust"): ba.PointPairs(), ("A", "dust"): ba.PointMass(), "others": ba.SecondDegree()}
    system = ba.System(bodies, gravity=gravity)
    orbits = [
        ba.Orbit(1400 * u.m, 0.05, 15 * u.deg),
        ba.Orbit(4000 * u.m, 0.1, 30 * u.deg, 40 * u.deg, about="inner"),
        ba.Orbit(9000 * u.m, 0.2, 100 * u.deg, mean_anomaly=60 * u.deg, about="inner"),
    ]
    spins = [[3e-5, -2e-5, 7.5e-4], [-4e-5, 6e-5, 1.5e-4], [1e-5, 5e-5, -9e-5]] * u.rad / u.s
    return system, ba.State.from_orbits(system, orbits, spins=[*spins, None])
