"""The loop of steps for a pair that are looked at for events."""

from binaryast.kernels.events import looking
from binaryast.kernels.jit import PAIR_POINTER, jit
from binaryast.kernels.pair.loop import advance

advance_looking = jit(looking.looking_signature(PAIR_POINTER))(looking.looking(advance))
