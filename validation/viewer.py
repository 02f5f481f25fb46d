"""How large the page of a run is, and how many frames a second it draws: ``python -m validation.viewer``.

Moshup and Squannit, (66391) 1999 KW4, with their radar shapes of 9168 and 2292 faces, where these are beside the
repository, else with a synthetic one; 10 000 rows. The page is opened in Chromium without a window, whose pictures the
processor draws: a graphics card is many times faster.
"""

import argparse
import os
import tempfile
import time
from pathlib import Path

import astropy.units as u
from tests import pages

import binaryast as ba
from validation.degrees import kw4
from validation.meshes import SHAPES, directions

ROWS, WATCHED = 10_000, 8.0


def bodies_and_start() -> tuple[list[ba.RigidBody], ba.State, str]:
    """Return the pair, its start, and whose shapes it has."""
    files = [SHAPES / f"a66391_1999kw4_{name}.obj" for name in ("primary", "secondary")]
    if all(file.is_file() for file in files):
        return *kw4(*files, u.km), "the radar shapes of 1999 KW4"
    given = ba.catalogue.load("moshup")[0].bodies
    bodies = []
    for body, count in zip(given, (9168, 2292), strict=True):
        points, faces = directions(count)
        axes = [body.shape.a.value, body.shape.b.value, body.shape.c.value]
        bodies.append(ba.RigidBody(body.name, ba.Polyhedron(points * axes * u.m, faces), mass=body.mass))
    system = ba.System(bodies, gravity=ba.Multipole(4))
    spins = [2.7645 * u.h, "synchronous"]
    return bodies, ba.State.circular_orbit(system, period=17.42 * u.h, spins=spins), "synthetic shapes"


def frames_per_second(path: Path) -> tuple[float, float]:
    """Return how long a page takes to be there [s], and how many frames a second it draws while it plays."""
    with pages.browser() as browser:
        begin = time.monotonic()
        with pages.opened(browser, path, 1280, 800) as page:
            ready = time.monotonic() - begin
            page.evaluate("viewer.play(true)")
            page.wait_for_timeout(1000)
            first = page.evaluate("[viewer.state.drawn, performance.now()]")
            page.wait_for_timeout(1000 * WATCHED)
            last = page.evaluate("[viewer.state.drawn, performance.now()]")
    return ready, 1000 * (last[0] - first[0]) / (last[1] - first[1])


def main() -> None:
    """Write the page, open it, print its figures."""
    parser = argparse.ArgumentParser(prog="python -m validation.viewer", description=__doc__)
    parser.add_argument("-o", "--output", type=Path, help="keep the page under this name")
    given = parser.parse_args()
    bodies, start, whose = bodies_and_start()
    sun = ba.Sun(ba.Orbit(0.642 * u.au, eccentricity=0.688))
    system = ba.System(bodies, gravity=ba.Multipole(4), perturbations=[sun])
    every = 4 * u.min
    run = ba.propagate(system, start, duration=(ROWS - 1) * every, integrator=ba.LGVI(60 * u.s), save_every=every)
    with tempfile.TemporaryDirectory() as folder:
        path = (given.output or Path(folder) / "kw4.html").absolute()
        begin = time.monotonic()
        ba.view(run, path, force=given.output is not None)
        wrote = time.monotonic() - begin
        faces = " and ".join(str(len(body.shape.faces)) for body in bodies)
        print(f"{whose}, {faces} faces, {len(run)} rows: {path.stat().st_size / 1e6:.2f} MB, written in {wrote:.2f} s")
        if pages.CHROMIUM is None:
            print("there is no Chromium here: on Debian, apt-get install chromium")
            return
        ready, rate = frames_per_second(path)
        print(
            f"in Chromium, 1280 x 800, drawn by the processor, {os.cpu_count()} cores: "
            f"ready after {ready:.1f} s, {rate:.0f} frames a second"
        )


if __name__ == "__main__":
    main()
