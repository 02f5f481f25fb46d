"""The case in F2BPtoolkit's documentation: ``python -m validation.f2bptoolkit``.

Two aligned ellipsoids at second degree for 10 days, G = 6.674e-11. An independent code ends at 1178.444910 m.
"""

from math import pi

import astropy.units as u
import numpy as np

import binaryast as ba

FINAL_SEPARATION = 1178.444910  # m
OTHER_G = 6.674e-11  # reproduced through gm


def case() -> tuple[ba.System, ba.State]:
    """Return the system and its start."""

    def body(name: str, a: float, b: float, c: float) -> ba.RigidBody:
        gm = OTHER_G * 2400 * 4 / 3 * pi * a * b * c
        return ba.RigidBody(name, ba.Ellipsoid(a * u.m, b * u.m, c * u.m), gm=gm * u.m**3 / u.s**2)

    system = ba.System([body("primary", 400, 395, 340), body("secondary", 85, 73, 63)], gravity=ba.SecondDegree())
    start = ba.RelativeState(
        X=[1195, 0, 0] * u.m,
        V=[0, 0.17430165586245883, 0] * u.m / u.s,
        R=np.eye(3),
        Omega=[0, 0, 1.4585912624473542e-4] * u.rad / u.s,
        Omega2=[0, 0, 2 * pi / (2.26 * 3600)] * u.rad / u.s,
    )
    return system, start.to_state(system)


def difference(step: float) -> float:
    """Return the final separation minus that of the other code [m]."""
    run = ba.propagate(*case(), duration=10 * u.day, integrator=ba.LGVI(step * u.s))
    return float(run.separation[-1].value - FINAL_SEPARATION)


def main() -> None:
    """Print the differences and their slope."""
    previous = None
    for step in (80.0, 40.0, 20.0, 10.0, 5.0):
        error = difference(step)
        slope = "" if previous is None else f"   slope {np.log2(previous / error):.3f}"
        print(f"step {step:4g} s: {error * 1000:+.4f} mm{slope}")
        previous = error


if __name__ == "__main__":
    main()
