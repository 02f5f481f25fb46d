"""The loop of steps for several bodies that are looked at for events."""

from binaryast.kernels.bodies.loop import advance
from binaryast.kernels.events import looking
from binaryast.kernels.jit import PAIR_POINTERS, jit

advance_looking = jit(looking.looking_signature(PAIR_POINTERS))(looking.looking(advance))
