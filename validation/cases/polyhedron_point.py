"""A polyhedron and points in it, on it and off it: another code, closed forms, the law of round-off far away."""

from collections.abc import Callable
from functools import cache
from time import perf_counter
from typing import NamedTuple

import astropy.units as u
import numpy as np
import trimesh

import binaryast as ba
from validation import drawing
from validation.case import Case, Check, Effort, Findings, Picture
from validation.oracles import polyhedra, potentials
from validation.oracles.polyhedra import Field

DENSITY = 2000.0  # kg/m3; everything is compared for G rho = 1
PLACES = ("inside", "on faces", "on edges", "at vertices", "above faces")
EACH = 100  # points of every kind, on each of two meshes
HALF = np.array([3.0, 2.0, 1.5])  # m, of the prism
FAR = np.geomspace(1e3, 1e6, 7)  # radii
SPHERES = (2, 3, 4, 5)  # divisions of icospheres
AXES = np.array([600.0, 450.0, 350.0])  # m, of the ellipsoid with slopes
FASTER = 0.6  # its spin, over the one at which a sphere's equator is weightless


class Sample(NamedTuple):
    """A mesh in the body frame, its body, points of every kind (kind, P, 3), and what the oracle says of them."""

    name: str
    vertices: np.ndarray
    body: ba.RigidBody
    points: np.ndarray
    oracle: list[Field]


def body_of(mesh: trimesh.Trimesh) -> ba.RigidBody:
    """Return a mesh in metres as a body."""
    shape = ba.Polyhedron(np.array(mesh.vertices) * u.m, np.array(mesh.faces))
    return ba.RigidBody("rock", shape, density=DENSITY * u.kg / u.m**3)


def computed(body: ba.RigidBody, points: np.ndarray) -> Field:
    """Return what the package says, over G rho."""
    found, scale = ba.polyhedron_field(body, points * u.m), ba.constants.G * DENSITY
    return Field(found.potential.value / scale, -found.attraction.value / scale, found.hessian.value / scale)


def meshes() -> dict[str, trimesh.Trimesh]:
    """Return a bumpy ball of 5120 faces, and a ring of 2048 that is not star-shaped."""
    ball = trimesh.creation.icosphere(subdivisions=4, radius=1.0)
    v = np.array(ball.vertices)
    ball.vertices = v * (1 + 0.1 * np.sin(3 * v[:, :1] + 1) + 0.05 * np.cos(7 * v[:, 1:2]) * v[:, 2:])
    ring = trimesh.creation.torus(major_radius=1.0, minor_radius=0.4, major_sections=32, minor_sections=32)
    return {"ball": ball, "ring": ring}


@cache
def samples() -> list[Sample]:
    """Return both meshes with their points."""
    result = []
    random = np.random.default_rng(1996)
    for name, mesh in meshes().items():
        body = body_of(mesh)
        vertices = (body.shape.vertices.value - body.offset.value) @ body.turn
        triangles = vertices[body.shape.faces][random.choice(len(mesh.faces), EACH, replace=False)]
        centres = triangles.mean(axis=1)
        normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
        normals /= np.linalg.norm(normals, axis=1)[:, None]
        depth, height = random.uniform(0.05, 0.3, (EACH, 1)), 10 ** random.uniform(-6, 0, (EACH, 1))
        points = np.array(
            [
                centres - depth * normals,
                centres,
                triangles[:, :2].mean(axis=1),
                triangles[:, 0],
                centres + height * normals,
            ]
        )
        found = [polyhedra.by_polyhedral_gravity(vertices, body.shape.faces, kind) for kind in points]
        result.append(Sample(name, vertices, body, points, [field for field, _ in found]))
    return result


def apart(one: Field, two: Field) -> np.ndarray:
    """Return the largest relative differences of U and dU/dx."""
    sizes = np.linalg.norm(two.gradient, axis=1)
    return np.array(
        [
            np.abs(one.energy / two.energy - 1).max(),
            (np.linalg.norm(one.gradient - two.gradient, axis=1) / sizes).max(),
        ]
    )


def checks_against_the_code() -> list[Check]:
    """Compare with polyhedral-gravity, which adds up other integrals."""
    checks = []
    for k, place in enumerate(PLACES):
        worst = np.max([apart(computed(s.body, s.points[k]), s.oracle[k]) for s in samples()], axis=0).max()
        checks.append(
            Check(
                f"{2 * EACH} points {place}: U and dU/dx minus polyhedral-gravity's, the largest",
                worst,
                5e-13,
                "rounding, most of it the oracle's: with 30 digits the worst are 5e-15 from ours, 9e-14 from it",
                headline=place == "on edges",
                roundoff=True,
            )
        )
    return checks


def check_of_the_time() -> Check:
    """Return the check of the time for a face beside the oracle's; it is left out of quick runs, as the tests are."""
    ours, theirs = times()
    return Check(
        "time for a face, one thread, over polyhedral-gravity's in the same run",
        ours / theirs,
        0.25,
        "the edges of two faces are worked on once, in vector lanes, and by series where a logarithm can be spared",
        shown=f"{1e9 * ours:.0f} ns and {1e9 * theirs:.0f} ns",
    )


def times() -> tuple[float, float]:
    """Return the time that a face of the ball takes, ours and the oracle's, each the best of five in turns [s].

    The points are outside, within two radii, where the oracle writes no warnings.
    """
    body, vertices = samples()[0].body, samples()[0].vertices
    points = 2 * samples()[0].points[1]
    ours = theirs = np.inf
    for _ in range(5):
        start = perf_counter()
        ba.polyhedron_field(body, points * u.m)
        ours = min(ours, perf_counter() - start)
        theirs = min(theirs, polyhedra.by_polyhedral_gravity(vertices, body.shape.faces, points)[1])
    return ours / len(points) / len(body.shape.faces), theirs / len(points) / len(body.shape.faces)


def checks_of_the_laplacian() -> list[Check]:
    """Look at the density that the Laplacian says."""
    scale = ba.constants.G * DENSITY
    inside, above = (
        np.concatenate([ba.polyhedron_field(s.body, s.points[k] * u.m).laplacian.value / scale for s in samples()])
        for k in (0, -1)
    )
    why = "rounding of the sum of some thousand solid angles"
    return [
        Check(
            "Laplacian inside, minus 4 pi G rho, over G rho",
            np.abs(inside - 4 * np.pi).max(),
            3e-13,
            why,
            roundoff=True,
        ),
        Check("Laplacian above faces, over G rho", np.abs(above).max(), 5e-14, why, roundoff=True),
    ]


def checks_of_the_prism() -> list[Check]:
    """Compare with the closed form of a box."""
    points = np.random.default_rng(1930).uniform(-2, 2, (1000, 3)) * HALF
    found, exact = computed(body_of(trimesh.creation.box(2 * HALF)), points), polyhedra.of_prism(HALF, points)
    second = np.abs(found.hessian - exact.hessian).max()
    why = "rounding, most of it the oracle's, whose terms cancel: with 30 digits the worst differ from ours by 1e-14"
    return [
        Check("prism, in and out: U and dU/dx", apart(found, exact).max(), 2e-13, why, headline=True, roundoff=True),
        Check("prism, in and out: second derivatives over G rho", second, 2e-12, why, roundoff=True),
    ]


def far_errors(field: Callable[[np.ndarray], Field], gm: float, radius: float) -> np.ndarray:
    """Return the largest relative errors of U and dU/dx (2, distances) over 20 directions of what has no quadrupole."""
    directions = np.random.default_rng(3).normal(size=(20, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    result = []
    for r in FAR * radius:
        exact = Field(np.full(20, -gm / r), gm / r**2 * directions, np.zeros((20, 3, 3)))
        result.append(apart(field(r * directions), exact))
    return np.array(result).T


@cache
def far_curves() -> tuple[np.ndarray, np.ndarray]:
    """Return the errors far from an icosahedron, whose field is a point's but for (size/r)^6: ours, the oracle's."""
    mesh = trimesh.creation.icosahedron()
    body = body_of(mesh)
    vertices, radius = np.array(mesh.vertices), float(np.linalg.norm(mesh.vertices, axis=1).max())
    gm = body.shape.volume
    return (
        far_errors(lambda x: computed(body, x), gm, radius),
        far_errors(lambda x: polyhedra.by_polyhedral_gravity(vertices, np.array(mesh.faces), x)[0], gm, radius),
    )


def checks_far_away() -> list[Check]:
    """Look at how round-off grows with the distance."""
    ours, _ = far_curves()
    return [
        Check(
            "icosahedron at 1e3 to 1e6 radii: errors of U and dU/dx, over r/radius, the largest",
            (ours / FAR).max(),
            3e-15,
            "rounding of sums that cancel by r/radius, after |e|/r was taken from each edge's logarithm",
            roundoff=True,
        )
    ]


@cache
def sphere_errors() -> np.ndarray:
    """Return the errors of dU/dx of icospheres of one density at 1.2 radii, relative to a sphere's."""
    at = 1.2 * np.array([[0.36, 0.48, 0.8]])
    exact = Field(np.array([0.0]), 4 / 3 * np.pi / 1.2**2 * at / 1.2, np.zeros((1, 3, 3)))
    found = [computed(body_of(trimesh.creation.icosphere(subdivisions=k)), at) for k in SPHERES]
    return np.array([np.linalg.norm(f.gradient - exact.gradient) / np.linalg.norm(exact.gradient) for f in found])


@cache
def slope_errors() -> np.ndarray:
    """Return the errors of the slopes of a spinning ellipsoid, as meshes, in the mean over the faces [deg]."""
    spin = FASTER * np.sqrt(4 / 3 * np.pi * ba.constants.G * DENSITY)
    grain = ba.RigidBody("grain", ba.Point(), mass=1e-6 * u.kg)
    result = []
    for k in SPHERES[:-1]:
        mesh = trimesh.creation.icosphere(subdivisions=k)
        mesh.vertices = np.array(mesh.vertices) * AXES
        body = body_of(mesh)
        state = ba.State(
            position=[[0, 0, 0], [1e4, 0, 0]] * u.km,
            velocity=np.zeros((2, 3)) * u.m / u.s,
            attitude=[body.turn, np.eye(3)],
            spin=[[0, 0, spin], [0, 0, 0]] * u.rad / u.s,
        )
        found = ba.surface(ba.System([body, grain], gravity=ba.PolyhedronPoint()), state)
        exact = ellipsoid_slopes(found.centres.value, spin)
        result.append(np.sqrt(np.mean((found.slope.value - exact) ** 2)))
    return np.array(result)


def ellipsoid_slopes(points: np.ndarray, spin: float) -> np.ndarray:
    """Return the slopes of the ellipsoid's surface where the lines from the centre through points meet it [deg]."""
    on = points / np.sqrt(np.sum((points / AXES) ** 2, axis=1))[:, None]
    gm = ba.constants.G * DENSITY * 4 / 3 * np.pi * np.prod(AXES)
    down = gm * potentials.field_of_ellipsoid(AXES, on)[1] - spin**2 * on * [1, 1, 0]
    normals = on / AXES**2
    across = np.linalg.norm(np.cross(down, normals), axis=1)
    return np.degrees(np.arctan2(across, np.sum(down * normals, axis=1)))


def order(errors: np.ndarray) -> float:
    """Return the power of the length of the edges with which the last errors fall."""
    return float(np.log2(errors[-2] / errors[-1]))


def checks_of_the_order() -> list[Check]:
    """Look at how meshes converge to what they stand for."""
    return [
        Check(
            "icospheres at 1.2 radii: order of the error of dU/dx in the length of the edges, minus 2",
            order(sphere_errors()) - 2,
            0.005,
            "the next power of it",
            shown=f"{order(sphere_errors()):.4f}",
        ),
        Check(
            "slopes of a spinning ellipsoid as a mesh: order of their error in the length of the edges, minus 1",
            order(slope_errors()) - 1,
            0.1,
            "the next power of it; a face is not quite tangent at its centre, hence 1",
            shown=f"{order(slope_errors()):.3f}",
        ),
    ]


def run(effort: Effort) -> Findings:
    """Compare, in and on and off."""
    checks = [
        *checks_against_the_code(),
        *checks_of_the_laplacian(),
        *checks_of_the_prism(),
        *checks_far_away(),
        *checks_of_the_order(),
    ]
    if effort > Effort.QUICK:
        checks.append(check_of_the_time())
    return Findings(checks, [picture()])


def picture() -> Picture:
    """Draw the errors near, far, and of meshes."""
    figure, panels = drawing.axes(3)
    near, far, fine = panels
    for k, sample in enumerate(samples()):
        height = np.linalg.norm(sample.points[-1] - sample.points[1], axis=1)
        found, exact = computed(sample.body, sample.points[-1]), sample.oracle[-1]
        error = np.linalg.norm(found.gradient - exact.gradient, axis=1) / np.linalg.norm(exact.gradient, axis=1)
        near.loglog(height, error, drawing.MARKERS[k], color=drawing.COLOURS[k], ms=3, label=sample.name)
    near.set(xlabel="height above a face [radii]", ylabel="dU/dx minus polyhedral-gravity's", ylim=(1e-16, 1e-11))
    for k, (errors, name) in enumerate(zip(far_curves(), ("binaryast", "polyhedral-gravity"), strict=True)):
        drawing.curve(far, FAR, errors[1], name, k)
    drawing.slope_line(far, FAR, (FAR[-1], far_curves()[0][1, -1]), 1)
    far.set(xlabel="distance [radii]", ylabel="error of dU/dx, icosahedron")
    edges = 2.0 ** -np.array(SPHERES)
    drawing.curve(fine, edges, sphere_errors(), "sphere: dU/dx", 0)
    drawing.slope_line(fine, edges, (edges[-1], sphere_errors()[-1]), 2)
    drawing.curve(fine, edges[:-1], np.radians(slope_errors()), "spinning ellipsoid: slopes [rad]", 1)
    drawing.slope_line(fine, edges, (edges[-2], np.radians(slope_errors()[-1])), 1)
    drawing.ticks(fine, edges)
    fine.set(xlabel="edges, over those of the icosahedron", ylabel="error of the mesh")
    for ax in panels:
        drawing.legend(ax)
    caption = (
        "Left: attraction close above the faces of two meshes, against another code. Middle: far from an icosahedron, "
        "against a point; ours loses digits as the distance, the other code as its cube. "
        "Right: meshes of spheres and of a spinning ellipsoid against closed forms, by the length of their edges."
    )
    return Picture("polyhedron-point", figure, caption)


CASE = Case(
    "polyhedron-point",
    "Is the field of a polyhedron exact in it, on it and off it, and what does it cost?",
    "polyhedral-gravity; closed forms of a prism, of a point, of ellipsoids",
    run,
    needs=("polyhedral_gravity", "scipy", "trimesh"),
)
