"""How fast things go round: pairs each other, and bodies themselves."""

from collections.abc import Iterator
from math import sqrt

import numpy as np

from binaryast.state import State
from binaryast.system import Pair, System


def rates(system: System, state: State) -> Iterator[tuple[Pair, float]]:
    """Yield how fast each pair goes, or would fall, round each other now [rad/s]."""
    position, velocity, _, _ = state.si
    for pair in system.pairs:
        x, v = (array[pair.secondary] - array[pair.primary] for array in (position, velocity))
        distance = float(np.linalg.norm(x))
        if distance > 0:
            gm = system.bodies[pair.primary].si.gm + system.bodies[pair.secondary].si.gm
            yield pair, max(sqrt(gm / distance**3), float(np.linalg.norm(np.cross(x, v))) / distance**2)
