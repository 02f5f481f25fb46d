"""The compiled kernels of the multipole potential: one for each degree, and one more for bodies of even moments.

Each is ``multipole.py`` written out for its degree, without what is zero: at degree 8 some 4000 instructions on both
bodies at once. They are compiled when they are first asked for and kept like every kernel.
"""

from collections.abc import Callable
from functools import cache
from threading import Lock
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit
from binaryast.kernels.moments import Floats
from binaryast.kernels.mutual.multipole import Moments, Numbers, evaluated
from binaryast.kernels.mutual.multipole_parameters import C_1, C_2, S_1, S_2, are_even, place_of
from binaryast.kernels.symbols import Symbol, SymbolLanes

COMPILING = Lock()  # without it, threads that ask for one kernel at once would each compile it


def moments_of(lanes: SymbolLanes, at: Callable[[int], Symbol], degree: int, *, even: bool) -> Moments:
    """Return the moments of both bodies from their parameters, zero where they vanish.

    They vanish at degree 1, for l = 2 at c_21, s_21 and s_22 by the choice of axes, and for even moments at all but
    even degrees and orders of c.
    """
    c: list[Numbers] = [[1.0], [0.0, 0.0]]
    s: list[Numbers] = [[0.0], [0.0, 0.0]]
    for l in range(2, degree + 1):
        c.append([0.0] * (l + 1))
        s.append([0.0] * (l + 1))
        for m in range(l + 1):
            if (even or l == 2) and (l % 2 or m % 2):
                continue
            place = place_of(l, m)
            c[l][m] = lanes.pair(at(place + C_1), at(place + C_2))
            if m > 0 and l > 2 and not even:
                s[l][m] = lanes.pair(at(place + S_1), at(place + S_2))
    return Moments(c, s)


@intrinsic  # type: ignore[untyped-decorator]
def written_out(_: Any, degree: Any, even: Any, p: Any, configuration: Any) -> Any:
    """Return U, dU/dX and M from parameters and X, R, for a degree that is known to the compiler."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        data = context.make_array(p)(context, builder, values[2]).data

        def at(place: int) -> Symbol:
            return Symbol(builder, builder.load(cgutils.gep(builder, data, ir.Constant(ir.IntType(64), place))))

        lanes = SymbolLanes(builder)
        x_and_r = [Symbol(builder, value) for value in cgutils.unpack_tuple(builder, values[3])]
        moments = moments_of(lanes, at, degree.literal_value, even=bool(even.literal_value))
        result = evaluated(lanes, at(0), moments, degree.literal_value, x_and_r[:3], x_and_r[3:])
        return context.make_tuple(builder, PAIR_POTENTIAL.return_type, [number.value for number in result])

    if not isinstance(degree, types.IntegerLiteral) or not isinstance(even, types.IntegerLiteral):
        return None
    return PAIR_POTENTIAL.return_type(degree, even, p, configuration), code


def potential_of(degree: int, *, even: bool) -> Callable[..., PairGravity]:
    """Return the kernel of a degree, for all bodies or for those of even moments."""
    with COMPILING:
        return _compiled(degree, even)


@cache
def _compiled(degree: int, even: bool) -> Callable[..., PairGravity]:
    """Compile a kernel, or find it among those kept."""
    also = int(even)  # the compiler knows whole numbers as such

    def potential(
        p: Array, x: float, y: float, z: float,
        r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
    ) -> PairGravity:  # fmt: skip
        """Return U, dU/dX and M; p is laid out in ``multipole_parameters.py``."""
        return written_out(degree, also, p, (x, y, z, r11, r12, r13, r21, r22, r23, r31, r32, r33))  # type: ignore[no-any-return]

    # a compiled function is found by its name: kept ones of several degrees must not share it
    potential.__qualname__ = f"potential_of_degree_{degree}{'_even' if even else ''}"
    return jit(PAIR_POTENTIAL)(potential)


def kernel_for(parameters: Floats, degree: int) -> Callable[..., PairGravity]:
    """Return the fastest kernel that takes these parameters."""
    return potential_of(degree, even=are_even(parameters, degree))
