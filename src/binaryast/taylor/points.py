"""Two rigid sets of point masses: the sum over all pairs of points, d = X + R rho1 - rho2."""

from collections.abc import Sequence
from typing import TypeAlias

from binaryast.taylor.multipole import Attraction
from binaryast.taylor.vectors import Number, Numbers, added, cross, dot, rotate, scaled, subtracted

Points: TypeAlias = Sequence[tuple[Number, Numbers]]  # fraction of the mass, place in the body frame


def attraction(secondary: Points, primary: Points, x: Numbers, r: Numbers) -> Attraction:
    """Return what all pairs of points exert, from X (3) and R (9, row by row)."""
    energy: Number = 0.0
    gradient: Numbers = [0.0, 0.0, 0.0]
    moment: Numbers = [0.0, 0.0, 0.0]
    for fraction_1, rho_1 in secondary:
        arm = rotate(r, rho_1)  # R rho1
        u: Number = 0.0
        f: Numbers = [0.0, 0.0, 0.0]
        for fraction_2, rho_2 in primary:
            d = subtracted(added(x, arm), rho_2)
            inverse = dot(d, d) ** -0.5
            k = fraction_2 * inverse
            u, f = u + k, added(f, scaled(k * (inverse * inverse), d))
        energy = energy - fraction_1 * u
        gradient = added(gradient, scaled(fraction_1, f))
        moment = added(moment, scaled(fraction_1, cross(arm, f)))  # (54)
    return Attraction(energy, gradient, moment)
