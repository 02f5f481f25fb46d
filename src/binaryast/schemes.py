"""Symmetric schemes: by which shares of a step kicks and drifts take turns, so that their errors cancel to some order.

A composition is known by the lengths of its second-order steps; each of them is half a kick, a drift, half a kick.
Other schemes have drifts and kicks of their own, and begin with the one or the other. The second half mirrors the
first.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from binaryast.units import Floats


@dataclass(frozen=True)
class Scheme:
    """The shares of a step.

    Attributes
    ----------
    name : str
        What a user calls it.
    order : int
        The power of the step with which the error falls, as the step goes to zero.
    drifts, kicks : tuple of float
        Their shares, in turn, a kick of zero length at both ends where a scheme begins with a drift: so there is one
        kick more.
    source : str
        Where it was published.
    """

    name: str
    order: int
    drifts: tuple[float, ...]
    kicks: tuple[float, ...]
    source: str

    @property
    def stages(self) -> int:
        """How many drifts a step takes, each with an evaluation of gravity at its end."""
        return len(self.drifts)

    @property
    def evaluations(self) -> int:
        """How many evaluations of gravity its kicks need: one less than the drifts where it begins with a drift."""
        return self.stages - (self.kicks[0] == 0.0)

    @property
    def longest(self) -> float:
        """The longest drift, over the step."""
        return max(abs(drift) for drift in self.drifts)

    @property
    def shares(self) -> Floats:
        """The array b0, a1, b1, .. an, bn that the compiled steps take."""
        result = np.zeros(2 * self.stages + 1)
        result[1::2], result[::2] = self.drifts, self.kicks
        return result


def mirrored(half: Sequence[float], *, one_middle: bool) -> tuple[float, ...]:
    """Return a symmetric sequence from its first half, whose last number may be the middle, which is there once."""
    return (*half, *reversed(half[:-1] if one_middle else half))


def composition(name: str, order: int, half: Sequence[float], source: str) -> Scheme:
    """Return the composition of second-order steps of these lengths, the middle one last."""
    steps = mirrored(half, one_middle=True)
    kicks = [(a + b) / 2 for a, b in zip((0.0, *steps), (*steps, 0.0), strict=True)]
    return Scheme(name, order, steps, tuple(kicks), source)


def kick_first(name: str, order: int, drifts: Sequence[float], kicks: Sequence[float], source: str) -> Scheme:
    """Return a scheme that begins and ends with a kick, from first halves; the longer one ends with the middle."""
    all_drifts = mirrored(drifts, one_middle=len(drifts) == len(kicks))
    return Scheme(name, order, all_drifts, mirrored(kicks, one_middle=len(kicks) > len(drifts)), source)


def drift_first(name: str, order: int, drifts: Sequence[float], kicks: Sequence[float], source: str) -> Scheme:
    """Return a scheme that begins and ends with a drift, from first halves; the longer one ends with the middle."""
    all_kicks = mirrored(kicks, one_middle=len(drifts) == len(kicks))
    return Scheme(name, order, mirrored(drifts, one_middle=len(drifts) > len(kicks)), (0.0, *all_kicks, 0.0), source)


_KAHAN_LI = "W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089"
_BLANES_MOAN = "S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313"
_BLANES = "S. Blanes et al., Appl. Numer. Math. 68 (2013) 58"
_CUBE_ROOT = 2.0 ** (1 / 3)
_FIFTH = 4.0 ** (1 / 3)

LEAPFROG = composition("leapfrog", 2, [1.0], "L. Verlet, Phys. Rev. 159 (1967) 98")
YOSHIDA4 = composition(
    "yoshida4", 4, [1 / (2 - _CUBE_ROOT), -_CUBE_ROOT / (2 - _CUBE_ROOT)], "H. Yoshida, Phys. Lett. A 150 (1990) 262"
)
SUZUKI4 = composition(
    "suzuki4",
    4,
    [1 / (4 - _FIFTH), 1 / (4 - _FIFTH), -_FIFTH / (4 - _FIFTH)],
    "M. Suzuki, Phys. Lett. A 146 (1990) 319",
)
KAHAN_LI6 = composition(
    "kl6",
    6,
    [0.3921614440073141, 0.33259913678935943, -0.7062461725576393, 0.0822135962935508, 0.7985439909348301],
    _KAHAN_LI,
)
KAHAN_LI8 = composition(
    "kl8",
    8,
    [
        *(0.13020248308889007, 0.5611629817751084, -0.38947496264484727, 0.1588419065551556, -0.39590389413323757),
        *(0.1845396409783157, 0.25837438768632204, 0.2950117236093103, -0.6055085338300346),
    ],
    _KAHAN_LI,
)
SOFRONIOU_SPALETTA10 = composition(
    "ss10",
    10,
    [
        *(0.07879572252168641, 0.3130961034151085, 0.027918383235078066, -0.22959284159390708, 0.13096206107716488),
        *(-0.2697334056545107, 0.07497334315589144, 0.1119934239998102, 0.36613344954622673, -0.3991056301360359),
        *(0.10308739852747108, 0.41143087395589023, -0.0048663605831352616, -0.3920333537086399, 0.05194250296244965),
        *(0.050665090759924494, 0.049674370639729876, 0.04931773575959464),
    ],
    "M. Sofroniou, G. Spaletta, Optim. Methods Softw. 20 (2005) 597",
)
RKN4 = kick_first(
    "rkn4",
    4,
    [0.245298957184271, 0.60487266571108, -0.350171622895351],
    [0.0829844064174052, 0.396309801498368, -0.0390563049223486, 0.11952419401315084],
    _BLANES_MOAN,
)
RKN6A = drift_first(
    "rkn6a",
    6,
    [
        *(0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447),
        *(-0.130144459517415, 0.106417700369543, -0.00879424312851058, 0.20730506905689539),
    ],
    [
        *(0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854),
        *(0.143761127168358, 0.328567693746804, -0.19641146648645424),
    ],
    _BLANES_MOAN,
)
ABA104 = drift_first(
    "aba104",
    4,
    [0.047067100645972505, 0.1847569354170881, 0.2827060056798362, -0.01453004174289682],
    [0.11888191736819702, 0.24105046055150156, -0.2732866667053238, 0.8267085775712505],
    _BLANES,
)
ABA864 = drift_first(
    "aba864",
    4,
    [0.07113342649822312, 0.2411534279566401, 0.5214117617728148, -0.333698616227678],
    [0.18308368747219722, 0.31078285989857485, -0.0265646185119588, 0.06539614228237342],
    _BLANES,
)
ABA1064 = drift_first(
    "aba1064",
    4,
    [0.038094497422412193, 0.14529871611691375, 0.20762769572554124, 0.43590970365152615, -0.6538612258327867],
    [0.09585888083707521, 0.20444615314299877, 0.2170703479789911, -0.017375381959065093],
    _BLANES,
)


def commutator(name: str, time: float, product: float, source: str) -> Scheme:
    """Return kicks and drifts that lead back, but for a term of second order in the strength of the kicks.

    With B(t) for a kick at a time t, it is the commutator of B(0) with B(t) after B(-t): its logarithm is -``product``
    t^2 [B, [A, [A, B]]] h^4, higher powers of h, and what is of third order in B.
    """
    kick = abs(product) ** 0.5
    first, other = kick, kick if product > 0 else -kick
    drifts = (time, -2 * time, time, -time, 2 * time, -time)
    return Scheme(name, 2, drifts, (first, other, other, -first, -other, -other, 0.0), source)


def named(*schemes: Scheme) -> dict[str, Scheme]:
    """Return schemes by their names."""
    return {scheme.name: scheme for scheme in schemes}


COMPOSITIONS = named(LEAPFROG, SUZUKI4, YOSHIDA4, KAHAN_LI6, KAHAN_LI8, SOFRONIOU_SPALETTA10)
SPLITTINGS = named(LEAPFROG, RKN4, RKN6A, SOFRONIOU_SPALETTA10)
KEPLER_SPLITTINGS = named(ABA104, ABA864, ABA1064)

# The errors of ABA(10, 4) of second order in the kicks are -5.723e-5 [B, [A, [A, [A, B]]]] - 6.011e-5 [[A, B], [A, [A,
# B]]] h^4, as its shares say. A change of variables adds the same to both, so all but a twentieth of them can be taken
# away. ABA(8, 6, 4) and ABA(10, 6, 4) have no such errors.
CORRECTORS = {"aba104": commutator("corrector of aba104", 0.1, -5.867e-3, "R. I. McLachlan, ANZIAM J. 38 (1996) 84")}
