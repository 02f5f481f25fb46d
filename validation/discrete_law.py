"""How far the attitude of a free spin runs ahead in a year: ``python -m validation.discrete_law``.

For a spin about a principal axis (128) says sin(theta) = h Omega: the attitude is ahead by t (asin(h Omega)/h - Omega),
which is about Omega t (h Omega)^2/6.
"""

import astropy.units as u
import numpy as np

import binaryast as ba

YEAR = 365.25 * 86400
RATE = 2 * np.pi / (2.26 * 3600)  # rad/s


def year_ahead(step: float) -> tuple[float, float]:
    """Return by how much [rad] a 2.26 h spin is ahead after a year, modulo a turn: in a run, and by the law."""
    bodies = [ba.RigidBody(name, ba.Sphere(1 * u.m), mass=1e-3 * u.kg) for name in ("far", "turning")]
    zero = np.zeros((2, 3))
    start = ba.State(
        [[0, 0, 0], [1e12, 0, 0]] * u.m, zero * u.m / u.s, [np.eye(3)] * 2, [[0, 0, 0], [0, 0, RATE]] * u.rad / u.s
    )
    system = ba.System(bodies, gravity=ba.PointMass())
    run = ba.propagate(system, start, duration=YEAR * u.s, integrator=ba.LGVI(step * u.s))
    h = run.step.value
    turned = np.arctan2(run.attitude[-1, 1, 1, 0], run.attitude[-1, 1, 0, 0])
    ahead = YEAR * (np.arcsin(h * RATE) / h - RATE)
    return float((turned - RATE * YEAR + np.pi - ahead) % (2 * np.pi) - np.pi + ahead), float(ahead)


def main() -> None:
    """Print both for a few steps."""
    for step in (60.0, 30.0, 15.0):
        run, law = year_ahead(step)
        print(f"step {step:4g} s: ahead by {run:.7f} rad in a year, by the law {law:.7f} rad")


if __name__ == "__main__":
    main()
