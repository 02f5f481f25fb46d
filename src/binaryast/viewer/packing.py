"""Arrays as text: base64 of their bytes, the lowest byte of a number first."""

from base64 import b64encode
from typing import Any

import numpy as np


def packed(array: Any, kind: type[np.generic]) -> str:
    """Return the numbers of an array, the last index running fastest, as text."""
    return b64encode(np.ascontiguousarray(array, dtype=np.dtype(kind).newbyteorder("<")).tobytes()).decode()
