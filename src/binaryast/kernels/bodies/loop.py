"""The loop of steps for several bodies."""

from binaryast.kernels import loop
from binaryast.kernels.jit import PAIR_POINTERS, jit

advance = jit(loop.loop_signature(PAIR_POINTERS))(loop.advance)
