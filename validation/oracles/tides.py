"""Tides from their potential: a bulge that stands where the other body was a moment ago, seen from the body's surface.

A body of radius R and Love number k2, raised by a mass m at r*, attracts the mass at r by the potential energy
-k2 G m^2 R^5 (3 (r.r*)^2 - r^2 r*^2)/(2 r^5 r*^5). With a lag in time tau, r* is r less tau times its rate in the frame
that turns with the body. heyoka takes the derivatives, by r for the force and by r* for the first order in tau.
"""

import heyoka as hy
import numpy as np

import binaryast as ba
from validation.oracles.mutual_potentials import norm
from validation.oracles.outside import Force, Symbols
from validation.oracles.sunlight import real
from validation.oracles.taylor import Array, variables


def time_lag(raised: int, by: int, love_number: float, lag: float, radius: float, mass: float) -> Force:
    """Return the force of a constant lag in time [s] on both, and the torque on the one that is raised."""

    def force(at: Symbols) -> tuple[Array, Array]:
        length, time, of_mass = at.units
        strength = real(love_number * ba.constants.G * mass**2 * radius**5 / (of_mass * length**8 / time**2))
        r, bulge, place, rate = (variables(name, 3) for name in ("r", "bulge", "place", "rate"))
        turn = r @ bulge
        U = -0.5 * strength * (3.0 * turn * turn - (r @ r) * (bulge @ bulge)) / (norm(r) ** 5.0 * norm(bulge) ** 5.0)
        lagging = [
            real(lag / time) * sum(hy.diff(hy.diff(U, r[i]), bulge[j]) * rate[j] for j in range(3)) for i in range(3)
        ]
        R, x = at.R[raised], at.x[by] - at.x[raised]
        moves = at.v[by] - at.v[raised] - np.cross(R @ at.Omega[raised], x)
        values = {**dict(zip(map(str, r), place, strict=True)), **dict(zip(map(str, bulge), place, strict=True))}
        final = dict(zip(map(str, [*place, *rate]), [*x, *moves], strict=True))
        pull = np.array([hy.subs(hy.subs(element, values), final) for element in lagging], dtype=object)
        F, N = np.full((len(at.x), 3), hy.expression(0.0)), np.full((len(at.x), 3), hy.expression(0.0))
        F[by], F[raised] = pull, -pull
        N[raised] = -(R.T @ np.cross(x, pull))
        return F, N

    return force
