"""Motions of polyhedra converge with the degree of their gravity: ``python -m validation.degrees``."""

from pathlib import Path

import astropy.units as u
import numpy as np
import pytest
from validation import degrees

import binaryast as ba
from tests.solids import icosphere

SHAPES = Path(__file__).parents[2] / "shared" / "shapes"


def falls(rows: list[degrees.Row], factor: float) -> bool:
    """Whether position and attitudes come nearer to the reference by a factor with every two degrees."""
    values = np.array([row[1:4] for row in rows])
    return bool(np.all(values[1:] * factor < values[:-1]))


def test_two_bumpy_bodies() -> None:
    vertices, faces = icosphere(2)
    bumps = 1 + 0.15 * np.sin(3 * vertices @ [1.0, 0.4, -0.2]) * np.cos(2 * vertices[:, 2] + 1)
    rough = vertices * bumps[:, None] * [1.2, 1.0, 0.8]
    bodies = [
        ba.RigidBody(name, ba.Polyhedron(size * rough * u.m, faces), density=2000 * u.kg / u.m**3)
        for name, size in (("one", 300.0), ("two", 100.0))
    ]
    system = ba.System(bodies, gravity=ba.Multipole(degrees.REFERENCE))
    start = ba.State.circular_orbit(system, separation=900 * u.m, spins=[3 * u.h, "synchronous"])
    assert falls(degrees.dependence(bodies, start, 1 * u.day), 4)


@pytest.mark.skipif(not SHAPES.is_dir(), reason="the shape models are not here")
def test_1999_kw4() -> None:
    files = [SHAPES / f"a66391_1999kw4_{name}.obj" for name in ("primary", "secondary")]
    rows = degrees.dependence(*degrees.kw4(*files, u.km), 1 * u.day)
    assert falls(rows, 5)
    assert [row.degree for row in rows] == [2, 4, 6, 8]
