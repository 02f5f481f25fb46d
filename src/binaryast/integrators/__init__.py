"""How a motion is followed: each integrator is a frozen value that says what it can do.

Those that step by compiled code name their step; `RungeKutta` goes through SciPy, `Taylor` through heyoka.
"""

from binaryast.integrators.base import Integrator, Stepping
from binaryast.integrators.lgvi import LGVI
from binaryast.integrators.references import RungeKutta, Taylor
from binaryast.integrators.splittings import KeplerSplitting, Splitting

KINDS: dict[str, type[Integrator]] = {
    kind.__name__: kind for kind in (LGVI, Splitting, KeplerSplitting, RungeKutta, Taylor)
}

__all__ = [
    "KINDS",
    "LGVI",
    "Integrator",
    "KeplerSplitting",
    "RungeKutta",
    "Splitting",
    "Stepping",
    "Taylor",
]
