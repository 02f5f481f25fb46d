"""A table of pair potentials: one pointer for each pair of bodies, so that one compilation serves any number of them.

numba's typed list could hold them, but reading it needs reference counting, which the steps do without. Here the
pointers lie, as they are, in an array of whole numbers.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from binaryast.kernels.jit import PAIR_POINTER, PAIR_POINTERS, PairPotential, jit

WORDS = 4  # room for one pointer in the table, in numbers of 8 bytes; numba's has 3


def _place(context: Any, builder: Any, table_type: Any, table: Any, k: Any) -> Any:
    """Return the address of the k-th pointer, typed as what numba passes for one."""
    pointer = context.get_value_type(PAIR_POINTER)
    if context.get_abi_sizeof(pointer) > 8 * WORDS:
        raise NotImplementedError(f"a pointer to a function of this numba needs more than {WORDS} words")
    data = context.make_array(table_type)(context, builder, table).data
    at = builder.mul(k, ir.Constant(k.type, WORDS))
    return builder.bitcast(cgutils.gep(builder, data, at), pointer.as_pointer())


@intrinsic  # type: ignore[untyped-decorator]
def _put(_: Any, table: Any, k: Any, potential: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args[0], values[0], values[1])
        builder.store(values[2], place)
        return context.get_dummy_value()

    return types.void(table, types.int64, potential), code


@intrinsic  # type: ignore[untyped-decorator]
def pointer_at(_: Any, table: Any, k: Any) -> Any:
    """Return the k-th potential of a table."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        return builder.load(_place(context, builder, signature.args[0], values[0], values[1]))

    return PAIR_POINTER(table, types.int64), code


@jit(types.void(PAIR_POINTERS, types.int64, PAIR_POINTER))
def put_pointer(table: Any, k: int, potential: PairPotential) -> None:
    """Put a compiled potential at the k-th place of a table."""
    _put(table, k, potential)


def table_of(potentials: Sequence[PairPotential]) -> Any:
    """Return the table of compiled potentials; it is good as long as these functions are, in this process."""
    table = np.zeros(WORDS * len(potentials), dtype=np.int64)
    for k, potential in enumerate(potentials):
        put_pointer(table, k, potential)
    return table
