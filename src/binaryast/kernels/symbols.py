"""Numbers that stand for instructions: a formula that Python runs on them is written out as straight-line code.

With a `Symbol` in the place of a float, loops are unrolled, what is known becomes a constant, and what is multiplied by
zero is left out. A symbol may also stand for several numbers side by side, on which the processor works at once. This
is how ``mutual/multipole_kernels.py`` gets a kernel of each degree from one text of the mathematics, without files of
generated source, and soon, in half a second at degree 4, several at 16: numba's own analysis, which would take longest,
does not see the instructions.
"""

from typing import Any, TypeAlias

from llvmlite import ir
from numba import types
from numba.core import cgutils

FLOAT = ir.DoubleType()
PAIR = ir.VectorType(FLOAT, 2)
FUSED = ("contract",)  # a product and a sum may be rounded once, where the processor can

Number: TypeAlias = "Symbol | float"


class Symbol:
    """A number, or several side by side, that is known only when the code runs."""

    def __init__(self, builder: Any, value: Any) -> None:
        self.builder, self.value = builder, value

    def __add__(self, other: Number) -> Number:
        return self if _is(other, 0) else self._result("fadd", self, other)

    __radd__ = __add__

    def __sub__(self, other: Number) -> Number:
        return self if _is(other, 0) else self._result("fsub", self, other)

    def __rsub__(self, other: Number) -> Number:
        return -self if _is(other, 0) else self._result("fsub", other, self)

    def __neg__(self) -> "Symbol":
        return Symbol(self.builder, self.builder.fneg(self.value))

    def __mul__(self, other: Number) -> Number:
        if _is(other, 0):
            return 0.0
        if _is(other, 1):
            return self
        return -self if _is(other, -1) else self._result("fmul", self, other)

    __rmul__ = __mul__

    def __truediv__(self, other: Number) -> Number:
        return self._result("fdiv", self, other)

    def __rtruediv__(self, other: Number) -> Number:
        return self._result("fdiv", other, self)

    def _result(self, instruction: str, one: Number, two: Number) -> "Symbol":
        """Return the result of an instruction; beside several numbers, a single one counts for each."""
        kind = _widest(one, two)
        operands = (as_value(self.builder, number, kind) for number in (one, two))
        return Symbol(self.builder, getattr(self.builder, instruction)(*operands, flags=FUSED))


class SymbolLanes:
    """What symbols offer besides arithmetic, see `binaryast.kernels.lanes.Lanes`."""

    def __init__(self, builder: Any) -> None:
        self.builder = builder

    def sqrt(self, a: Any) -> Any:
        """Return the square root, an instruction of the processor."""
        kind = _kind(a)
        name = "llvm.sqrt.f64" if kind is FLOAT else "llvm.sqrt.v2f64"
        function = cgutils.get_or_insert_function(self.builder.module, ir.FunctionType(kind, [kind]), name)
        return Symbol(self.builder, self.builder.call(function, [a.value]))

    def pair(self, one: Any, two: Any) -> Any:
        """Return two numbers side by side."""
        value = ir.Constant(PAIR, ir.Undefined)
        for lane, number in enumerate((one, two)):
            value = self.builder.insert_element(value, as_value(self.builder, number, FLOAT), _integer(lane))
        return Symbol(self.builder, value)

    def first(self, pair: Any) -> Any:
        """Return the first of a pair; a constant stands for both."""
        return self._lane(pair, 0)

    def second(self, pair: Any) -> Any:
        """Return the second of a pair; a constant stands for both."""
        return self._lane(pair, 1)

    def _lane(self, pair: Any, lane: int) -> Any:
        if not isinstance(pair, Symbol):
            return pair
        return Symbol(self.builder, self.builder.extract_element(pair.value, _integer(lane)))

    def swapped(self, pair: Any) -> Any:
        """Return a pair the other way round."""
        if not isinstance(pair, Symbol):
            return pair
        order = ir.Constant(ir.VectorType(ir.IntType(32), 2), [_integer(1), _integer(0)])
        return Symbol(self.builder, self.builder.shuffle_vector(pair.value, pair.value, order))

    def where_larger(self, a: Any, b: Any, one: Any, two: Any) -> Any:
        """Return ``one`` where a > b, ``two`` elsewhere."""
        kind = _widest(a, b, one, two)
        a, b, one, two = (as_value(self.builder, number, kind) for number in (a, b, one, two))
        return Symbol(self.builder, self.builder.select(self.builder.fcmp_ordered(">", a, b), one, two))


def written_out(formula: Any, context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """Write out a formula of vectors: the code of an `intrinsic` whose arguments and result are tuples of floats.

    ``formula`` takes the lanes and the vectors, and returns numbers, or tuples of them.
    """
    arguments = [_unpacked(builder, kind, value) for kind, value in zip(signature.args, values, strict=True)]
    result = _flat(formula(SymbolLanes(builder), *arguments))
    return context.make_tuple(builder, signature.return_type, [as_value(builder, number, FLOAT) for number in result])


def written_out_twice(formula: Any, context: Any, builder: Any, signature: Any, values: Any) -> Any:
    """Write out a formula for two side by side: every vector is there twice, the result is two tuples.

    Arguments that are no tuples are there once, and the same for both.
    """
    lanes, arguments = SymbolLanes(builder), []
    given = iter([_unpacked(builder, kind, value) for kind, value in zip(signature.args, values, strict=True)])
    for one in given:
        if isinstance(one, list):
            arguments.append([lanes.pair(*both) for both in zip(one, next(given), strict=True)])
        else:
            arguments.append(one)
    result = _flat(formula(lanes, *arguments))
    tuples = [
        context.make_tuple(builder, kind, [as_value(builder, lane(number), FLOAT) for number in result])
        for lane, kind in zip((lanes.first, lanes.second), signature.return_type, strict=True)
    ]
    return context.make_tuple(builder, signature.return_type, tuples)


def _unpacked(builder: Any, kind: Any, value: Any) -> Any:
    """Return the symbols of a tuple, or of one number."""
    if not isinstance(kind, types.BaseTuple):
        return Symbol(builder, value)
    return [Symbol(builder, part) for part in cgutils.unpack_tuple(builder, value)]


def _flat(result: Any) -> list[Number]:
    """Return the numbers of nested tuples."""
    return [number for part in result for number in _flat(part)] if isinstance(result, (tuple, list)) else [result]


def as_value(builder: Any, number: Number, kind: Any) -> Any:
    """Return a number as a value of LLVM's; as often as there are lanes, where several side by side are wanted."""
    several = isinstance(kind, ir.VectorType)
    if not isinstance(number, Symbol):
        constant = ir.Constant(FLOAT, float(number))
        return ir.Constant(kind, [constant] * kind.count) if several else constant
    if _kind(number) == kind:
        return number.value
    lanes = ir.Constant(ir.VectorType(ir.IntType(32), kind.count), [_integer(0)] * kind.count)
    first = builder.insert_element(ir.Constant(kind, ir.Undefined), number.value, _integer(0))
    return builder.shuffle_vector(first, ir.Constant(kind, ir.Undefined), lanes)


def _kind(number: Number) -> Any:
    return number.value.type if isinstance(number, Symbol) else FLOAT


def _widest(*numbers: Number) -> Any:
    """Return the kind of several numbers side by side if there is one among these."""
    return next((kind for kind in map(_kind, numbers) if isinstance(kind, ir.VectorType)), FLOAT)


def _is(number: Number, constant: float) -> bool:
    return not isinstance(number, Symbol) and number == constant


def _integer(value: int) -> Any:
    return ir.Constant(ir.IntType(32), value)
