"""The loop of steps for a pair."""

from binaryast.kernels import loop
from binaryast.kernels.jit import PAIR_POINTER, jit

advance = jit(loop.loop_signature(PAIR_POINTER))(loop.advance)
