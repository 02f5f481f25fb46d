"""What acts from outside: that it is balanced, and what is said where it cannot be."""

import astropy.units as u
import numpy as np

import binaryast as ba


def test_a_table_is_as_good_as_the_ellipse_it_is_of(tumbling: tuple[ba.System, ba.State]) -> None:
    given, state = tumbling
    radius, gm = 3e8, 4e14  # m, m3/s2
    times = np.linspace(-1.0, 3.0, 161) * u.day
    turned = np.sqrt((gm + sum(body.si.gm for body in given.bodies)) / radius**3) * times.to_value("s")
    places = -radius * np.stack([np.cos(turned), np.sin(turned), np.zeros_like(turned)], axis=1)
    ends = []
    for mass in (
        ba.ThirdBody(gm * u.m**3 / u.s**2, times, places * u.m),
        ba.Planet(gm * u.m**3 / u.s**2, ba.Orbit(radius * u.m)),
    ):
        system = ba.System(given.bodies, perturbations=[mass])
        ends.append(ba.propagate(system, state, duration=1 * u.day, integrator=ba.Splitting(10 * u.min))[-1])
    alone = ba.propagate(given, state, duration=1 * u.day, integrator=ba.Splitting(10 * u.min))[-1]
    moved = np.abs(ends[0].si.position - alone.si.position).max()
    assert np.abs(ends[0].si.position - ends[1].si.position).max() < 1e-9 * moved
