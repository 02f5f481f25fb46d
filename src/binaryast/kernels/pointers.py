"""Tables of pointers to compiled functions, so that one compilation serves any number of them.

A table is also the quick way to hand functions over from Python, which takes a tenth of a millisecond for each of them
otherwise.

One holds the pair potentials, one pointer for each pair of bodies, another what events watch. numba's typed list could
hold them, but reading it needs reference counting, which the steps do without. Here the pointers lie, as they are, in
an array of whole numbers.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from binaryast.kernels.jit import EVENT_POINTER, PAIR_POINTER, PAIR_POINTERS, PairPotential, jit

WORDS = 4  # room for one pointer in the table, in numbers of 8 bytes; numba's has 3


def _place(kind: Any, context: Any, builder: Any, table_type: Any, table: Any, k: Any) -> Any:
    """Return the address of the k-th pointer, typed as what numba passes for one."""
    pointer = context.get_value_type(kind)
    if context.get_abi_sizeof(pointer) > 8 * WORDS:
        raise NotImplementedError(f"a pointer to a function of this numba needs more than {WORDS} words")
    data = context.make_array(table_type)(context, builder, table).data
    at = builder.mul(k, ir.Constant(k.type, WORDS))
    return builder.bitcast(cgutils.gep(builder, data, at), pointer.as_pointer())


def access(kind: Any) -> tuple[Any, Any]:
    """Return what puts a pointer of a kind into a table, and what takes it out."""

    @intrinsic  # type: ignore[untyped-decorator]
    def put(_: Any, table: Any, k: Any, function: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            place = _place(kind, context, builder, signature.args[0], values[0], values[1])
            builder.store(values[2], place)
            return context.get_dummy_value()

        return types.void(table, types.int64, function), code

    @intrinsic  # type: ignore[untyped-decorator]
    def take(_: Any, table: Any, k: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return builder.load(_place(kind, context, builder, signature.args[0], values[0], values[1]))

        return kind(table, types.int64), code

    return put, take


_put, pointer_at = access(PAIR_POINTER)
_put_event, event_at = access(EVENT_POINTER)


@jit(types.void(PAIR_POINTERS, types.int64, PAIR_POINTER))
def put_pointer(table: Any, k: int, potential: PairPotential) -> None:
    """Put a compiled potential at the k-th place of a table."""
    _put(table, k, potential)


@jit(types.void(PAIR_POINTERS, types.int64, EVENT_POINTER))
def put_event(table: Any, k: int, function: Callable[..., float]) -> None:
    """Put what an event watches at the k-th place of a table."""
    _put_event(table, k, function)


def table_of(functions: Sequence[Callable[..., Any]], put: Callable[..., None] = put_pointer) -> Any:
    """Return the table of compiled functions; it is good as long as these are, in this process."""
    table = np.zeros(WORDS * len(functions), dtype=np.int64)
    for k, function in enumerate(functions):
        put(table, k, function)
    return table
