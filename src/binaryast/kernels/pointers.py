"""Tables of pointers to compiled functions, so that one compilation serves any number of them.

One holds a pair potential for each pair of bodies, others what acts from outside and what events watch. A table is also
the quick way to hand functions over from Python, which takes a tenth of a millisecond for each of them otherwise.
numba's typed list could hold them, but reading it needs reference counting, which the steps do without. Here the
pointers lie, as they are, in an array of whole numbers.
"""

from collections.abc import Callable, Sequence
from functools import cache
from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from binaryast.kernels.jit import PAIR_POINTER, PAIR_POINTERS, jit

WORDS = 4  # room for one pointer in the table, in numbers of 8 bytes; numba's has 3


def _place(context: Any, builder: Any, kind: Any, table_type: Any, table: Any, k: Any) -> Any:
    """Return the address of the k-th pointer, typed as what numba passes for one of this kind."""
    pointer = context.get_value_type(kind)
    if context.get_abi_sizeof(pointer) > 8 * WORDS:
        raise NotImplementedError(f"a pointer to a function of this numba needs more than {WORDS} words")
    data = context.make_array(table_type)(context, builder, table).data
    at = builder.mul(k, ir.Constant(k.type, WORDS))
    return builder.bitcast(cgutils.gep(builder, data, at), pointer.as_pointer())


@intrinsic  # type: ignore[untyped-decorator]
def _put(_: Any, table: Any, k: Any, function: Any) -> Any:
    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        place = _place(context, builder, signature.args[2], signature.args[0], values[0], values[1])
        builder.store(values[2], place)
        return context.get_dummy_value()

    return types.void(table, types.int64, function), code


def reader(kind: Any) -> Any:
    """Return what reads the k-th pointer of a table, for pointers to functions of one kind."""

    @intrinsic  # type: ignore[untyped-decorator]
    def read(_: Any, table: Any, k: Any) -> Any:
        def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
            return builder.load(_place(context, builder, kind, signature.args[0], values[0], values[1]))

        return kind(table, types.int64), code

    return read


pointer_at = reader(PAIR_POINTER)


def _put_pointer(table: Any, k: int, function: Callable[..., Any]) -> None:
    _put(table, k, function)


@cache
def putter(kind: Any) -> Callable[..., None]:
    """Return what puts a compiled function of one kind at the k-th place of a table."""
    return jit(types.void(PAIR_POINTERS, types.int64, kind))(_put_pointer)


def table_of(functions: Sequence[Callable[..., Any]], kind: Any = PAIR_POINTER) -> Any:
    """Return the table of compiled functions; it is good as long as these are, in this process."""
    table = np.zeros(WORDS * len(functions), dtype=np.int64)
    for k, function in enumerate(functions):
        putter(kind)(table, k, function)
    return table
