"""Tides that lag: the classical rates of spin and orbit, the motion beside heyoka's, and where the energy goes."""

from collections.abc import Callable

import astropy.units as u
import numpy as np
from scipy.integrate import simpson

import binaryast as ba
from binaryast.integrators import Stepping
from validation import methods
from validation.case import Case, Check, Effort, Findings
from validation.differences import difference, snapshot_of

DAY = 86400.0
G = ba.constants.G
RADIUS, LOVE, QUALITY, LAG = 400.0, 0.1, 10.0, 100.0  # m, 1, 1, s
AXIS, FAST, SLOW = 1600.0, 8e-4, 3e-5  # m, rad/s: above and below the mean motion, 1.2e-4
BY_ANGLE = ba.TidalTorque("A", "B", LOVE, quality_factor=QUALITY)
BY_TIME = ba.TidalTorque("A", "B", LOVE, time_lag=LAG * u.s)
Torque = Callable[[float, float], float]  # on the first [N m], of the mass of the other [kg] and n - spin [rad/s]


def spheres(tide: ba.TidalTorque | None, spin: list[float], eccentricity: float = 0.0) -> tuple[ba.System, ba.State]:
    """Return two spheres, of which the first is raised and turns with a spin [rad/s]."""
    bodies = [
        ba.RigidBody(name, ba.Sphere(radius * u.m), density=2400 * u.kg / u.m**3)
        for name, radius in (("A", RADIUS), ("B", 150.0))
    ]
    system = ba.System(bodies, gravity=ba.PointMass(), perturbations=[tide] if tide else [])
    spins = [np.array(spin) * u.rad / u.s, [0.0, 0.0, 1e-4] * u.rad / u.s]
    state = ba.State.from_elements(
        system, semi_major_axis=AXIS * u.m, eccentricity=eccentricity, inclination=0 * u.deg, spins=spins
    )
    return system, state


def mean_motion(system: ba.System) -> float:
    """Return n of the circle that the spheres start on [rad/s]."""
    return float(np.sqrt(sum(body.si.gm for body in system.bodies) / AXIS**3))


def torque_by_angle(mass: float, slip: float) -> float:
    """Return 3/2 k2/Q G m^2 R^5/a^6 (Murray and Dermott, section 4.9), which brings the spin nearer to n."""
    return float(np.sign(slip) * 1.5 * LOVE / QUALITY * G * mass**2 * RADIUS**5 / AXIS**6)


def torque_by_time(mass: float, slip: float) -> float:
    """Return 3 k2 G m^2 R^5/a^6 tau (n - Omega): the same with an angle of tau (n - Omega)."""
    return 3 * LOVE * G * mass**2 * RADIUS**5 / AXIS**6 * LAG * slip


def of_rates(name: str, tide: ba.TidalTorque, torque: Torque, rate: float, tolerance: float) -> list[Check]:
    """Compare the rates of spin and semi-major axis in five days with the classical ones."""
    system, state = spheres(tide, [0.0, 0.0, rate])
    run = ba.propagate(system, state, duration=5 * u.day, integrator=ba.Splitting(300 * u.s))
    one, two = (body.si for body in system.bodies)
    n = mean_motion(system)
    N = torque(two.mass, n - rate)
    x, v = (array[:, 1] - array[:, 0] for array in (run.si.position, run.si.velocity))
    a = 1 / (2 / np.linalg.norm(x, axis=1) - np.sum(v**2, axis=1) / (one.gm + two.gm))
    reduced = one.mass * two.mass / (one.mass + two.mass)
    grown, spun = (a[-1] - a[0]) / (5 * DAY), (run.si.spin[-1, 0, 2] - rate) / (5 * DAY)
    classical = -2 * N / (reduced * n * AXIS)
    why = "the orbit changes meanwhile, and with it the rates"
    says = f"{'faster' if rate > n else 'slower'} than the orbit, lag of constant {name}"
    return [
        Check(f"{says}: da/dt over the classical one, minus 1", grown / classical - 1, tolerance, why, headline=True),
        Check(f"{says}: spin's rate over the classical one, minus 1", spun / (N / one.moments[2]) - 1, tolerance, why),
    ]


def of_motion() -> Check:
    """Compare spheres on an eccentric orbit, the spin tilted, with heyoka's motion under the lagging potential."""
    from validation.oracles import outside, tides

    system, state = spheres(BY_TIME, [2e-4, -3e-4, 6e-4], 0.1)
    mass = system.bodies[1].si.mass
    force = tides.time_lag(0, 1, LOVE, LAG, RADIUS, mass)
    exact = outside.OutsideMotion(system, state, forces=[force]).at(3 * DAY)
    end = ba.propagate(system, state, duration=3 * u.day, integrator=ba.Splitting(150 * u.s, scheme="ss10"))[-1]
    return Check(
        "e = 0.1, spin tilted, lag of constant time, 3 d: all quantities minus heyoka's",
        difference(snapshot_of(end), exact).largest,
        1e-13,
        "rounding",
        headline=True,
        roundoff=True,
    )


def powers(run: ba.Trajectory) -> np.ndarray:
    """Return the power of Mignard's tide at every row, written out for arrays."""
    x, v = (array[:, 1] - array[:, 0] for array in (run.si.position, run.si.velocity))
    spin = np.einsum("nij,nj->ni", run.si.attitude[:, 0], run.si.spin[:, 0])
    r2 = np.sum(x**2, axis=1)[:, None]
    slip = v - np.cross(spin, x)
    size = 3 * LOVE * G * run.system.bodies[1].si.mass ** 2 * RADIUS**5 * LAG
    pull = -size / r2**4 * (2 * np.sum(x * v, axis=1)[:, None] / r2 * x + slip)
    return np.asarray(np.sum(pull * slip, axis=1))


def of_balance() -> list[Check]:
    """Compare the change of energy with the power integrated from the rows, as the step goes to zero."""
    system, state = spheres(BY_TIME, [2e-4, -3e-4, 6e-4], 0.1)
    checks = []
    for name, integrators, order, tolerance in (
        ("LGVI", [ba.LGVI(h * u.s) for h in (120.0, 60.0, 30.0)], 2, 0.01),
        ("LGVI of order 4", [ba.LGVI(h * u.s, order=4) for h in (480.0, 240.0, 120.0)], 4, 0.3),
    ):
        errors = [imbalance(system, state, integrator) for integrator in integrators]
        steps = [integrator.step.value for integrator in integrators]
        checks.append(
            Check(
                f"e = 0.1, {name}: energy minus the power of its rows, integrated: power of the step, minus {order}",
                methods.slope(steps, errors) - order,
                tolerance,
                "the next power of the step",
                shown=f"{errors[-1]:.2g} of the change in steps of {steps[-1]:g} s",
            )
        )
    run = ba.propagate(system, state, duration=2 * u.day, integrator=ba.Splitting(600 * u.s, scheme="ss10"))
    checks.append(
        Check(
            "e = 0.1, order 10: energy less the work done, over |E0|, the largest error",
            run.max_relative_energy_error,
            3e-15,
            f"rounding; the tide takes {abs(float(run.work[-1] / run.energy[0])):.1g} of the energy",
            headline=True,
            roundoff=True,
        )
    )
    return checks


def imbalance(system: ba.System, state: ba.State, integrator: Stepping) -> float:
    """Return the change of energy in two days less the power integrated from the rows, over the change."""
    run = ba.propagate(system, state, duration=2 * u.day, integrator=integrator, save_every=480 * u.s)
    given = simpson(powers(run), x=run.si.time)
    change = float((run.energy[-1] - run.energy[0]).value)
    return abs(change / float(given) - 1)


def without_size(integrator: Stepping) -> tuple[ba.Trajectory, ba.Trajectory]:
    """Return two days with a tide of Love number zero, and without a tide."""
    none = ba.TidalTorque("A", "B", 0.0, time_lag=LAG * u.s)
    one, two = (
        ba.propagate(*spheres(tide, [2e-4, -3e-4, 6e-4], 0.1), duration=2 * u.day, integrator=integrator)
        for tide in (none, None)
    )
    return one, two


def of_nothing() -> list[Check]:
    """Compare a tide without size with none at all."""
    largest = 0.0
    for integrator in (ba.LGVI(40 * u.s), ba.LGVI(40 * u.s, frame="inertial"), ba.Splitting(600 * u.s)):
        one, two = without_size(integrator)
        largest = max(largest, difference(snapshot_of(one[-1]), snapshot_of(two[-1])).largest)
    one, two = without_size(ba.KeplerSplitting(1800 * u.s))
    return [
        Check(
            "a Love number of zero: all quantities at the end minus those of a run without tides",
            largest,
            1e-12,
            "bit for bit, but for sums that the compiler fuses into one rounding where it sees that it can",
            roundoff=True,
            printed=True,
        ),
        Check(
            "the same of KeplerSplitting: all quantities at the end",
            difference(snapshot_of(one[-1]), snapshot_of(two[-1])).largest,
            1e-13,
            "rounding: in another place the compiler joins other products and sums into one instruction",
            roundoff=True,
            printed=True,
        ),
    ]


def run(effort: Effort) -> Findings:
    """Compare rates, motion and balance."""
    checks = [
        check
        for rate, by_time in ((FAST, 1e-3), (SLOW, 2e-4))
        for name, tide, torque, tolerance in (
            ("angle", BY_ANGLE, torque_by_angle, 1e-3),
            ("time", BY_TIME, torque_by_time, by_time),
        )
        for check in of_rates(name, tide, torque, rate, tolerance)
    ]
    return Findings([*checks, of_motion(), *of_balance(), *of_nothing()])


CASE = Case(
    "tides",
    "Do tides that lag change spin and orbit at the classical rates, and does the energy go where they take it?",
    "closed forms (Murray and Dermott, section 4.9); heyoka in quadruple precision on the potential of a lagging bulge",
    run,
    needs=("heyoka",),
)
