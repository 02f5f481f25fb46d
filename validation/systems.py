"""Systems that nothing is special about: what the checks and the tests run beside those of the catalogue."""

import astropy.units as u
import numpy as np

import binaryast as ba


def two_ellipsoids(
    one: tuple[float, float, float], other: tuple[float, float, float], a: float, e: float, spins: list[list[float]]
) -> tuple[ba.System, ba.State]:
    """Return two ellipsoids of semi-axes [m] on an inclined orbit, of spins [rad/s]."""
    bodies = [
        ba.RigidBody(name, ba.Ellipsoid(*(axes * u.m)), density=2400 * u.kg / u.m**3)
        for name, axes in (("A", np.array(one)), ("B", np.array(other)))
    ]
    system = ba.System(bodies)
    state = ba.State.from_elements(
        system,
        semi_major_axis=a * u.m,
        eccentricity=e,
        inclination=20 * u.deg,
        longitude_of_ascending_node=50 * u.deg,
        argument_of_periapsis=70 * u.deg,
        true_anomaly=30 * u.deg,
        spins=list(spins * u.rad / u.s),
    )
    return system, state


def tumbling_pair() -> tuple[ba.System, ba.State]:
    """Two triaxial bodies in full tumble on an inclined, eccentric orbit; the secondary's motion is chaotic."""
    spins = [[3e-5, -2e-5, 7.5e-4], [-4e-5, 6e-5, 1.5e-4]]
    return two_ellipsoids((420.0, 400.0, 330.0), (100.0, 80.0, 60.0), 1150.0, 0.08, spins)


def coupled_pair() -> tuple[ba.System, ba.State]:
    """Two long bodies in a slow tumble that pass near each other: each turns the other, and no spin is fast."""
    spins = [[1e-4, -1e-4, 2e-4], [-1e-4, 1.5e-4, 2e-4]]
    return two_ellipsoids((500.0, 300.0, 250.0), (300.0, 180.0, 120.0), 1300.0, 0.3, spins)


def nearly_round(share: float) -> tuple[ba.System, ba.State]:
    """Return the tumbling pair with so much of the differences of its moments, about the same means."""
    system, state = tumbling_pair()
    bodies = []
    for body in system.bodies:
        mean = body.si.moments.mean()
        moments = mean + share * (body.si.moments - mean)
        ball = ba.Sphere(np.sqrt(2.5 * mean / body.si.mass) * u.m)
        bodies.append(ba.RigidBody(body.name, ball, mass=body.si.mass * u.kg, inertia=moments * u.kg * u.m**2))
    return ba.System(bodies), state


def wobbling_pair() -> tuple[ba.System, ba.State]:
    """Didymos with its pole tilted by 5 degrees and wobbling, Dimorphos librating and inclined: regular, not planar."""
    system, _ = ba.catalogue.load("didymos")
    rate = 2 * np.pi / (2.26 * 3600)
    spins = [[0.06 * rate, 0.06 * rate, rate], [3e-6, -2e-6, 1.5e-4]] * u.rad / u.s
    state = ba.State.from_elements(
        system, semi_major_axis=1190 * u.m, eccentricity=0.03, inclination=5 * u.deg, spins=list(spins)
    )
    return system, state


def four_bodies(point: float = 1e6) -> tuple[ba.System, ba.State]:
    """Four bodies of three kinds, each pair with its own gravity: two ellipsoids, a dumbbell and a point [kg]."""
    bodies = [
        ba.RigidBody("A", ba.Ellipsoid(420 * u.m, 400 * u.m, 330 * u.m), density=2400 * u.kg / u.m**3),
        ba.RigidBody("B", ba.Ellipsoid(100 * u.m, 80 * u.m, 60 * u.m), density=2400 * u.kg / u.m**3),
        ba.RigidBody("rod", ba.Dumbbell(200 * u.m, 30 * u.m), mass=2e9 * u.kg),
        ba.RigidBody("dust", ba.Point(), mass=point * u.kg),
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
