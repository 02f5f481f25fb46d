"""Two polyhedra: volume integrals of boxes near contact, spheres, the multipole far away, and a day of 1999 KW4."""

import time
import warnings
from typing import NamedTuple

import astropy.units as u
import numpy as np
from scipy.spatial.transform import Rotation

import binaryast as ba
from binaryast.gravity import Gravity
from validation import drawing, meshes, methods, truncation
from validation.case import Case, Check, Effort, Findings, Picture
from validation.meshes import Mesh
from validation.oracles import boxes
from validation.oracles.potentials import Attraction

ONE, TWO = np.array([1.0, 0.8, 0.6]), np.array([0.5, 0.4, 0.3])  # half-sizes [m]
NEAR = np.array([1.05 * 1.5, 0.25, -0.1])  # m: faces that are 0.075 apart
TURNED = np.array([2.1, 0.6, 0.7])  # m
ATTITUDE = Rotation.from_euler("zxz", [0.4, 0.7, -1.1]).as_matrix()
ACCURACIES = 10.0 ** -np.arange(2, 11)
SPHERES = (80, 320, 1280)  # faces
TURNS = Rotation.random(12, random_state=4).as_matrix()
GAP = 1.05  # times the sum of the radii
DEGREES = (2, 4, 8)
DISTANCES = np.array([2.6, 4.0, 6.0, 9.0])  # m


def system(one: Mesh, two: Mesh, gravity: Gravity) -> ba.System:
    """Return two polyhedra with G m1 m2 = 1, the first as the primary."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.DensityWarning)  # G m1 m2 = 1 weighs what no rock does
        bodies = [
            ba.RigidBody(name, ba.Polyhedron(points * u.m, faces), **mass)
            for name, (points, faces), mass in (
                ("one", one, {"gm": 1 * u.m**3 / u.s**2}),
                ("two", two, {"mass": 1 * u.kg}),
            )
        ]
    return ba.System(bodies, gravity=gravity)


def attraction(of: ba.System, x: np.ndarray, r: np.ndarray) -> Attraction:
    """Return what the package says."""
    found = of.mutual_gravity(x * u.m, r)
    return Attraction(found.energy.value, found.gradient.value, found.moment.value)


def relative(found: Attraction, exact: Attraction, x: np.ndarray) -> np.ndarray:
    """Return the errors of U, of dU/dX, and of M over |X| |dU/dX|, which `PolyhedronPair` promises."""
    force = np.linalg.norm(exact.gradient)
    moment = np.linalg.norm(found.moment - exact.moment) / np.linalg.norm(x) / force
    return np.array(
        [abs(found.energy / exact.energy - 1), np.linalg.norm(found.gradient - exact.gradient) / force, moment]
    )


class Promise(NamedTuple):
    """Errors (accuracy, quantity) for boxes near contact, parallel and turned."""

    parallel: np.ndarray
    turned: np.ndarray


def promise() -> Promise:
    """Return the errors for each accuracy."""
    both = meshes.box(ONE), meshes.box(TWO)
    systems = [system(*both, ba.PolyhedronPair(accuracy)) for accuracy in ACCURACIES]
    exact = boxes.parallel(ONE, TWO, NEAR, 32)
    also = boxes.turned(ONE, TWO, TURNED, ATTITUDE, 12)
    return Promise(
        np.array([relative(attraction(one, NEAR, np.eye(3)), exact, NEAR) for one in systems]),
        np.array([relative(attraction(one, TURNED, ATTITUDE), also, TURNED) for one in systems]),
    )


def box_checks(found: Promise) -> list[Check]:
    """Return the checks of boxes."""
    kept = (found.parallel.max(axis=1) / ACCURACIES).max()
    return [
        Check(
            "boxes 5 % from contact: largest error of U, dU/dX and M with an accuracy of 1e-10",
            found.parallel[-1].max(),
            1e-10,
            "what the rules of the surfaces leave",
            headline=True,
        ),
        Check(
            "boxes 5 % from contact: the largest error over the accuracy asked, from 1e-2 to 1e-10",
            kept,
            1.0,
            "the factor of the estimate is that of the worst of other pairs",
        ),
        Check(
            "boxes turned: largest error of U, dU/dX and M with an accuracy of 1e-10",
            found.turned[-1].max(),
            1e-10,
            "what the oracle's 12 nodes for each edge leave; what the rules of the surfaces leave",
        ),
    ]


def sphere_errors() -> np.ndarray:
    """Return errors (faces, 2) of dU/dX of spheres of so many faces near contact, of equal density and of equal mass.

    They are root mean squares over turns of both.
    """
    errors = []
    for faces in SPHERES:
        points, triangles = meshes.directions(faces)
        pair = system((points, triangles), (0.5 * points, triangles), ba.PolyhedronPair(1e-5))
        share = (meshes.volume((points, triangles)) / (4 / 3 * np.pi)) ** 2  # of both masses in those of spheres
        found = []
        for turn, also in zip(TURNS, TURNS[::-1], strict=True):
            x = GAP * 1.5 * turn[0]
            gradient = attraction(pair, x, also).gradient * np.dot(x, x)
            found.append([np.linalg.norm(factor * gradient - turn[0]) for factor in (share, 1.0)])
        errors.append(np.sqrt(np.mean(np.square(found), axis=0)))
    return np.array(errors)


def lumps(seed: int, size: float) -> Mesh:
    """Return a body with moments of every degree."""
    points, triangles = meshes.directions(120)
    x, y, z = points.T
    rough = np.random.default_rng(seed).normal(size=len(points))
    return size * (points * (1 + 0.2 * x + 0.15 * y * z + 0.05 * rough)[:, None]) * [1.0, 0.8, 0.7], triangles


def far_errors() -> np.ndarray:
    """Return by how much dU/dX differs (degree, distance) between the multipole and the surfaces."""
    both = lumps(1, 1.0), lumps(2, 0.6)
    exact = system(*both, ba.PolyhedronPair(1e-12))
    towards = np.array([0.8, 0.5, -0.33])
    places = np.outer(DISTANCES, towards / np.linalg.norm(towards))
    values = [attraction(exact, x, ATTITUDE) for x in places]
    cut = [system(*both, ba.Multipole(degree)) for degree in DEGREES]
    return np.array(
        [
            [truncation.apart(attraction(one, x, ATTITUDE), v)[1] for x, v in zip(places, values, strict=True)]
            for one in cut
        ]
    )


def far_checks(found: np.ndarray) -> list[Check]:
    """Return the checks of the powers by which the multipole comes near."""
    checks = []
    for degree, errors, tolerance in zip(DEGREES, found, (0.3, 0.4, 1.5), strict=True):
        slopes = -np.diff(np.log(errors)) / np.diff(np.log(DISTANCES))
        checks.append(
            Check(
                f"dU/dX minus that of degree {degree}: falls with distance by the power {degree + 1}",
                slopes[-1] - (degree + 1),
                tolerance,
                "the next degrees add their parts, size/r of it",
                shown=", ".join(f"{slope:.3f}" for slope in slopes),
            )
        )
    return checks


class Day(NamedTuple):
    """A run: where the secondary was at the saved times [m], the largest error of energy, what a step cost [us]."""

    name: str
    where: np.ndarray
    energy: float
    cost: float


def days(duration: u.Quantity) -> tuple[np.ndarray, list[Day]]:
    """Return times [h] and runs of 1999 KW4, with 500 and 200 faces, the last one the most accurate."""
    shapes = [
        ba.Polyhedron(points * u.m, faces)
        for points, faces in (
            meshes.resampled(meshes.asteroid(name), count) for name, count in (("primary", 500), ("secondary", 200))
        )
    ]
    masses = [2.353e12, 1.35e11] * u.kg
    bodies = [ba.RigidBody(n, s, mass=m) for n, s, m in zip(("Alpha", "Beta"), shapes, masses, strict=True)]
    start = ba.State.circular_orbit(
        ba.System(bodies, ba.Multipole(4)), separation=2.54 * u.km, spins=[2.7645 * u.h, "synchronous"]
    )
    runs = []
    for name, gravity in (
        ("degree 4", ba.Multipole(4)),
        ("degree 8", ba.Multipole(8)),
        *((f"surfaces, {a:.0e}", ba.PolyhedronPair(a)) for a in (1e-3, 1e-4, 1e-6, 1e-8)),
    ):
        pair = ba.System(bodies, gravity)
        ba.propagate(pair, start, duration=1 * u.min, integrator=ba.LGVI(30 * u.s))  # so that nothing is compiled below
        began = time.perf_counter()
        run = ba.propagate(pair, start, duration=duration, integrator=ba.LGVI(30 * u.s), save_every=duration / 24)
        cost = (time.perf_counter() - began) / run.steps * 1e6
        runs.append(Day(name, run.si.position[:, 1] - run.si.position[:, 0], run.max_energy_error_over_potential, cost))
    return run.si.time / 3600, runs


def day_checks(runs: list[Day], hours: float) -> list[Check]:
    """Return the checks of the runs."""
    best = runs[-1]
    apart = {day.name: np.linalg.norm(day.where - best.where, axis=1).max() for day in runs[:-1]}
    steps = f"1999 KW4, {hours:g} h in steps of 30 s"
    checks = [
        Check(
            f"{steps}: largest error of energy over |U| of the runs with surfaces, whatever their accuracy",
            max(day.energy for day in runs[2:]),
            2e-6,
            "the integrator's own error: that of degree 8 is the same",
            shown=", ".join(f"{day.energy:.3e}" for day in runs[1:]),
        )
    ]
    checks += [
        Check(
            f"{steps}: distance from the run with 1e-8, of that with {name}, over that of {other}",
            apart[f"surfaces, {name}"] / apart[other],
            tolerance,
            "what the accuracy leaves, beside what the series leaves out",
            shown=f"{apart[f'surfaces, {name}']:.2g} m, {apart[other]:.2g} m",
        )
        for name, other, tolerance in (("1e-06", "degree 8", 0.05), ("1e-03", "degree 4", 0.2))
    ]
    return checks


def run(effort: Effort) -> Findings:
    """Compare with each of the oracles."""
    kept, spheres, far = promise(), sphere_errors(), far_errors()
    slope = methods.slope(1 / np.sqrt(SPHERES), spheres[:, 0])
    checks = [
        *box_checks(kept),
        Check(
            "spheres of faces, of equal density, 5 % from contact: dU/dX tends to that of points by the power 2",
            slope - 2,
            0.15,
            "a face cuts off what is beyond it, by the square of its size; near contact the nearest ones matter more",
            shown=f"{slope:.3f}",
            headline=True,
        ),
        *far_checks(far),
    ]
    pictures = [picture(kept, spheres, far)]
    notes: list[str] = []
    if effort == Effort.QUICK:  # the runs take a minute and more
        return Findings(checks, pictures)
    if meshes.asteroid("primary") is None:
        notes = ["The radar shapes of 1999 KW4 are not here: the run of this pair is left out."]
    else:
        hours = 2.0 if effort == Effort.WHOLE else 24.0
        times, runs = days(hours * u.h)
        checks += day_checks(runs, hours)
        pictures.append(day_picture(times, runs))
        notes = ["Time for a step on this machine: " + ", ".join(f"{d.name} {d.cost:.0f} us" for d in runs) + "."]
    return Findings(checks, pictures, notes)


def picture(kept: Promise, spheres: np.ndarray, far: np.ndarray) -> Picture:
    """Draw errors against accuracy, faces and distance."""
    figure, (left, middle, right) = drawing.axes(3)
    for k, quantity in enumerate(truncation.QUANTITIES):
        drawing.curve(left, ACCURACIES, kept.parallel[:, k], quantity, k)
    drawing.slope_line(left, ACCURACIES, (1e-5, 1e-5), 1, "what is asked")
    left.set(xlabel="accuracy asked", ylabel="error", title="boxes 5 % from contact")
    drawing.curve(middle, SPHERES, spheres[:, 0], "dU/dX, equal density", 0)
    drawing.curve(middle, SPHERES, spheres[:, 1], "dU/dX, equal mass", 1)
    drawing.slope_line(middle, SPHERES, (SPHERES[-1], spheres[-1, 0]), -1, "size of a face squared")
    middle.set(xlabel="faces of each sphere", ylabel="difference from points", title="spheres 5 % from contact")
    for i, (degree, errors) in enumerate(zip(DEGREES, far, strict=True)):
        drawing.curve(right, DISTANCES, errors, f"degree {degree}", i)
        drawing.slope_line(right, DISTANCES, (DISTANCES[-1], errors[-1]), -degree - 1, f"slope {-degree - 1}")
    right.set(xlabel="distance [m]", ylabel="dU/dX: difference from the multipole", title="two lumps of about 1 m")
    drawing.ticks(right, DISTANCES)
    for ax in (left, middle, right):
        drawing.legend(ax)
    caption = (
        "Two polyhedra. Left: boxes 5 % from contact, errors against volume integrals for each accuracy asked. Middle: "
        "spheres of faces beside points: the mesh's own error. Right: the multipole comes near with distance."
    )
    return Picture("polyhedron-pair", figure, caption)


def day_picture(times: np.ndarray, runs: list[Day]) -> Picture:
    """Draw how far runs are from the most accurate one."""
    figure, (ax,) = drawing.axes(1, xlabel="time [h]", ylabel="distance from the run with 1e-8 [m]")
    for i, day in enumerate(runs[:-1]):
        apart = np.linalg.norm(day.where - runs[-1].where, axis=1)
        drawing.curve(ax, times[1:], apart[1:], f"{day.name}: {day.cost:.0f} us a step", i)
    ax.set_ylim(top=30 * ax.get_ylim()[1])
    drawing.legend(ax)
    caption = "1999 KW4 with 500 and 200 faces: what the multipole leaves out, and what the accuracy of surfaces does."
    return Picture("polyhedron-pair-day", figure, caption)


CASE = Case(
    "polyhedron-pair",
    "Is the gravity of two polyhedra right to the accuracy asked, near contact and far away, and is energy conserved?",
    "volume integrals of boxes by Gauss's rules, points for spheres, the multipole far away",
    run,
    needs=("scipy",),
)
