"""The signature that all compiled steps have."""

from typing import Any

from numba import types

from binaryast.kernels.external.arguments import EXTERNAL
from binaryast.kernels.jit import ARRAY


def step_signature(attraction: Any) -> Any:
    """Return the signature of one step of h.

    It gives a status from the state, the constants, the scheme, the potential or a table of them, their parameters,
    what acts from outside, and h.
    """
    return types.int64(ARRAY, ARRAY, ARRAY, attraction, ARRAY, EXTERNAL, types.float64)
