"""How the motion of two polyhedra depends on the degree of their gravity.

    python -m validation.degrees PRIMARY SECONDARY --unit km

The files are shapes of (66391) Moshup and Squannit, 1999 KW4, or others; masses, spin and period are those of that
pair (catalogue entry moshup). All degrees have the same start and step; a row says how far its motion comes from that
of the highest degree.
"""

import argparse
import warnings
from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import astropy.units as u
import numpy as np

import binaryast as ba
from validation.differences import turns

DEGREES = (2, 4, 6, 8)
REFERENCE = 10
STEP = 20 * u.s


class Row(NamedTuple):
    """The largest differences of a run from that of the reference: position [m], attitudes [rad], and the next term."""

    degree: int
    position: float
    primary: float
    secondary: float
    next_term: float


def dependence(
    bodies: Sequence[ba.RigidBody], start: ba.State, duration: u.Quantity, degrees: Sequence[int] = DEGREES
) -> list[Row]:
    """Return how far runs at these degrees come from that at `REFERENCE`."""
    runs = {degree: follow(bodies, start, duration, degree) for degree in (*degrees, REFERENCE)}
    reference = runs.pop(REFERENCE)
    rows = []
    for degree, run in runs.items():
        position = np.linalg.norm(relative(run) - relative(reference), axis=1).max()
        primary, secondary = turns(run.attitude, reference.attitude).max(axis=0)
        rows.append(Row(degree, position, primary, secondary, run.max_next_degree_term))
    return rows


def follow(bodies: Sequence[ba.RigidBody], start: ba.State, duration: u.Quantity, degree: int) -> ba.Trajectory:
    """Return a run at a degree."""
    system = ba.System(bodies, gravity=ba.Multipole(degree))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ba.errors.GravityWarning)  # what a low degree leaves out is what is looked at
        return ba.propagate(system, start, duration=duration, integrator=ba.LGVI(STEP), save_every=duration / 500)


def relative(run: ba.Trajectory) -> np.ndarray:
    """Return the secondary's position from the primary (N, 3) [m]."""
    return run.si.position[:, 1] - run.si.position[:, 0]


def kw4(primary: Path, secondary: Path, unit: u.Unit) -> tuple[list[ba.RigidBody], ba.State]:
    """Return Moshup and Squannit with these shapes, on a circular orbit at the published period."""
    given = ba.catalogue.load("moshup")[0].bodies
    bodies = [
        ba.RigidBody(body.name, ba.Polyhedron.read(path, unit=unit), mass=body.mass)
        for body, path in zip(given, (primary, secondary), strict=True)
    ]
    system = ba.System(bodies, gravity=ba.Multipole(REFERENCE))
    return bodies, ba.State.circular_orbit(system, period=17.42 * u.h, spins=[2.7645 * u.h, "synchronous"])


def main() -> None:
    """Read two shapes and print the table."""
    parser = argparse.ArgumentParser(prog="python -m validation.degrees", description="How a motion depends on N.")
    parser.add_argument("primary", type=Path, metavar="PRIMARY", help="mesh file of the primary")
    parser.add_argument("secondary", type=Path, metavar="SECONDARY", help="mesh file of the secondary")
    parser.add_argument("--unit", default="km", help="length unit of both files")
    parser.add_argument("--days", type=float, default=10.0)
    given = parser.parse_args()
    bodies, start = kw4(given.primary, given.secondary, u.Unit(given.unit))
    faces = " and ".join(str(len(body.shape.faces)) for body in bodies)
    print(
        f"{faces} faces, separation {start.separation:.1f}, {given.days:g} d in steps of {STEP}, beside N = {REFERENCE}"
    )
    print(f"{'N':>3} {'position [m]':>13} {'primary [deg]':>14} {'secondary [deg]':>16} {'next terms':>11}")
    for row in dependence(bodies, start, given.days * u.day):
        angles = np.degrees([row.primary, row.secondary])
        print(f"{row.degree:3} {row.position:13.3g} {angles[0]:14.2g} {angles[1]:16.2g} {row.next_term:11.1e}")


if __name__ == "__main__":
    main()
