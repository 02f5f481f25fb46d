"""Two rigid sets of point masses, eight points of the secondary at a time.

The sum is that of ``points.py``. A processor divides and takes roots at a fraction of its other pace, and so they would
be most of the time. Here 1/|d| begins with a division and a root of short numbers, good to 2^-23, and one step of third
order, multiplications alone, brings it to the last digits: with e = 1 - d^2 w^2 it is w (1 + e/2 + 3 e^2/8 + ..). The
lanes are points of the secondary, so no lane is added to another before the end.
"""

from math import sqrt
from typing import Any

from llvmlite import ir
from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from binaryast.kernels.jit import PAIR_POTENTIAL, Array, PairGravity, jit
from binaryast.kernels.mutual.points import exerted
from binaryast.kernels.symbols import FLOAT, Symbol, as_value

LANES = 8
WIDE, SHORT = ir.VectorType(FLOAT, LANES), ir.VectorType(ir.FloatType(), LANES)
INTEGER = ir.IntType(64)


class Points:
    """The points of one body among the parameters: ``size`` numbers x, then y, z and the masses."""

    def __init__(self, builder: Any, data: Any, begin: Any, size: Any) -> None:
        self.builder, self.data, self.begin, self.size = builder, data, begin, size

    def _address(self, index: Any, k: int) -> Any:
        row = self.builder.add(self.begin, self.builder.mul(self.size, ir.Constant(INTEGER, k)))
        return self.builder.gep(self.data, [self.builder.add(row, index)])

    def one(self, index: Any) -> list[Symbol]:
        """Return x, y, z and the mass of a point, the same in all lanes."""
        values = [self.builder.load(self._address(index, k)) for k in range(4)]
        return [Symbol(self.builder, as_value(self.builder, Symbol(self.builder, v), WIDE)) for v in values]

    def eight(self, index: Any) -> list[Symbol]:
        """Return x, y, z and the masses of eight points from one on, each in a lane."""
        wide = [self.builder.bitcast(self._address(index, k), WIDE.as_pointer()) for k in range(4)]
        return [Symbol(self.builder, self.builder.load(at, align=8)) for at in wide]


class Sums:
    """Sums that grow in a loop, eight lanes each."""

    def __init__(self, builder: Any, count: int) -> None:
        self.builder = builder
        self.slots = [cgutils.alloca_once(builder, WIDE) for _ in range(count)]

    def clear(self) -> None:
        """Begin again."""
        for slot in self.slots:
            self.builder.store(as_value(self.builder, 0.0, WIDE), slot)

    def add(self, terms: list[Any]) -> None:
        """Add to each."""
        for slot, total, term in zip(self.slots, self.values(), terms, strict=True):
            self.builder.store((total + term).value, slot)

    def values(self) -> list[Any]:
        """Return the sums as they are now."""
        return [Symbol(self.builder, self.builder.load(slot)) for slot in self.slots]


def inverse_root(builder: Any, square: Any) -> Any:
    """Return 1 over the root of eight numbers, from 1e-37 to 1e38."""
    root = cgutils.get_or_insert_function(builder.module, ir.FunctionType(SHORT, [SHORT]), f"llvm.sqrt.v{LANES}f32")
    one = ir.Constant(SHORT, [ir.Constant(ir.FloatType(), 1.0)] * LANES)
    short = builder.fdiv(one, builder.call(root, [builder.fptrunc(square.value, SHORT)]))
    w = Symbol(builder, builder.fpext(short, WIDE))
    e = 1.0 - square * (w * w)
    return w + w * e * (0.375 * e + 0.5)


def over_lanes(builder: Any, several: Any) -> Any:
    """Return the sum of the lanes."""
    kind = ir.FunctionType(FLOAT, [FLOAT, WIDE])
    function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.vector.reduce.fadd.v{LANES}f64")
    return builder.call(function, [ir.Constant(FLOAT, 0.0), several.value], fastmath=("reassoc",))


@intrinsic  # type: ignore[untyped-decorator]
def of_octets(_: Any, p: Any, octets: Any, n1: Any, n2: Any, x: Any, attitude: Any, scale: Any, root: Any) -> Any:
    """Return U, dU/dX and M of the secondary's first points, in groups of eight; root^2 = scale, about 1/|X|^2."""

    def code(context: Any, builder: Any, signature: Any, values: Any) -> Any:
        array, octets, n1, n2, *rest = values
        data = context.make_array(signature.args[0])(context, builder, array).data
        two, four, eight = (ir.Constant(INTEGER, number) for number in (2, 4, LANES))
        secondary = Points(builder, data, two, n1)
        primary = Points(builder, data, builder.add(two, builder.mul(n1, four)), n2)
        x, r = ([Symbol(builder, v) for v in cgutils.unpack_tuple(builder, part)] for part in rest[:2])
        scale, root = (Symbol(builder, as_value(builder, Symbol(builder, v), WIDE)) for v in rest[2:])
        whole, of_eight = Sums(builder, 7), Sums(builder, 4)
        whole.clear()
        with cgutils.for_range(builder, octets) as outer:
            *rho, gm = secondary.eight(builder.mul(outer.index, eight))
            arm = [r[3 * i] * rho[0] + r[3 * i + 1] * rho[1] + r[3 * i + 2] * rho[2] for i in range(3)]  # R rho1
            place = [x[i] + arm[i] for i in range(3)]
            of_eight.clear()
            with cgutils.for_range(builder, n2) as inner:
                *rho, m = primary.one(inner.index)
                d = [place[i] - rho[i] for i in range(3)]
                w = inverse_root(builder, (d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) * scale)
                k = m * w
                cube = k * (w * w)
                of_eight.add([k, *(cube * part for part in d)])
            u, *slopes = of_eight.values()
            of_one: Any = gm * root
            f = [of_one * scale * part for part in slopes]
            moment = [arm[1] * f[2] - arm[2] * f[1], arm[2] * f[0] - arm[0] * f[2], arm[0] * f[1] - arm[1] * f[0]]
            whole.add([-(of_one * u), *f, *moment])  # M = sum of (R rho1) x d/|d|^3, by (54)
        sums = [over_lanes(builder, total) for total in whole.values()]
        return context.make_tuple(builder, signature.return_type, sums)

    kinds = (octets, n1, n2, x, attitude, scale, root)
    return PAIR_POTENTIAL.return_type(p, *(types.int64 if isinstance(k, types.Integer) else k for k in kinds)), code


@jit(PAIR_POTENTIAL)
def potential(
    p: Array, x: float, y: float, z: float,
    r11: float, r12: float, r13: float, r21: float, r22: float, r23: float, r31: float, r32: float, r33: float,
) -> PairGravity:  # fmt: skip
    """Return U, dU/dX and M; p as in ``points.py``.

    Squares are taken over that of a size of the configuration, so that they fit into short numbers whatever the units.
    """
    n1, n2 = int(p[0]), int(p[1])
    octets = n1 // LANES
    last = n1 + 1
    square = x * x + y * y + z * z + p[2] * p[2] + p[last] * p[last] + p[last + n1] * p[last + n1]
    scale = 1.0 / square if square > 0.0 else 1.0
    place, attitude = (x, y, z), (r11, r12, r13, r21, r22, r23, r31, r32, r33)
    u, gx, gy, gz, mx, my, mz = of_octets(p, octets, n1, n2, place, attitude, scale, sqrt(scale))
    v, hx, hy, hz, nx, ny, nz = exerted(p, place, attitude, octets * LANES)
    return u + v, gx + hx, gy + hy, gz + hz, mx + nx, my + ny, mz + nz
