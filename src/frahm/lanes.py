"""Sixteen numbers at once: a vector type for compiled kernels.

Whether a compiler turns a loop over lanes into vector instructions depends on what it can prove about overlapping
arrays. Here nothing is left to be proved: a value of type `Lanes` *is* two vectors of eight doubles, whatever register
width the machine has. There are two because one step of an integration is a long chain of operations, each of which
waits for the one before it: the second chain fills the time. Operations act on every lane by itself, so a lane never
depends on its neighbours.

Inner loops know arrays by their address only: an array argument of numba is seven numbers and a reference count, which
cost more than the arithmetic on the lanes.
"""

from __future__ import annotations

import math
import operator
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba.core import cgutils, types
from numba.core.typing.templates import ConcreteTemplate, infer_global, signature
from numba.extending import intrinsic, lower_builtin, models, overload, register_model
from numpy.typing import NDArray

from frahm.compiled import kernel

_WIDTH, _PARTS = 8, 2  # doubles of a vector, as many as the widest register holds, and vectors
LANES = _WIDTH * _PARTS
_VECTOR = ir.VectorType(ir.DoubleType(), _WIDTH)
_PAIR = ir.LiteralStructType([_VECTOR] * _PARTS)


class _LanesType(types.Type):
    def __init__(self) -> None:
        super().__init__(name=f"Lanes{LANES}")


lanes_type = _LanesType()


@register_model(_LanesType)
class _LanesModel(models.PrimitiveModel):
    def __init__(self, dmm: Any, fe_type: Any):
        super().__init__(dmm, fe_type, _PAIR)


def _joined(builder: Any, parts: list[Any]) -> Any:
    """The vectors as one value."""
    value = ir.Constant(_PAIR, ir.Undefined)
    for k, part in enumerate(parts):
        value = builder.insert_value(value, part, k)
    return value


def _spread(builder: Any, scalar: Any) -> Any:
    """A vector of equal numbers."""
    zero = ir.Constant(ir.IntType(32), 0)
    first = builder.insert_element(ir.Constant(_VECTOR, ir.Undefined), scalar, zero)
    mask = ir.Constant(ir.VectorType(ir.IntType(32), _WIDTH), [0] * _WIDTH)
    return builder.shuffle_vector(first, ir.Constant(_VECTOR, ir.Undefined), mask)


def _parts(builder: Any, kind: Any, value: Any) -> list[Any]:
    """The vectors of a value; those of a number are all alike."""
    if isinstance(kind, _LanesType):
        return [builder.extract_value(value, k) for k in range(_PARTS)]
    return [_spread(builder, value)] * _PARTS


def _define_operator(function: Any, instruction: str) -> None:
    pairs = [(lanes_type, lanes_type), (lanes_type, types.float64), (types.float64, lanes_type)]

    class Template(ConcreteTemplate):
        cases = [signature(lanes_type, a, b) for a, b in pairs]  # noqa: RUF012 (numba's own protocol)

    infer_global(function)(Template)

    def lower(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        a, b = (_parts(builder, kind, value) for kind, value in zip(sig.args, args, strict=True))
        return _joined(builder, [getattr(builder, instruction)(x, y) for x, y in zip(a, b, strict=True)])

    for a, b in pairs:
        lower_builtin(function, a, b)(lower)


for _function, _instruction in (
    (operator.add, "fadd"), (operator.iadd, "fadd"), (operator.sub, "fsub"), (operator.isub, "fsub"),
    (operator.mul, "fmul"), (operator.imul, "fmul"), (operator.truediv, "fdiv"),
):  # fmt: skip
    _define_operator(_function, _instruction)


def _pointer(builder: Any, base: Any, index: Any, element: Any, wanted: Any) -> Any:
    first = builder.inttoptr(base, element.as_pointer())
    return builder.bitcast(builder.gep(first, [index]), wanted.as_pointer())


@intrinsic
def load(typingctx: Any, base: Any, index: Any) -> Any:
    """As many doubles as there are lanes, from the `index`-th one on, of those stored at the address `base`."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        first = _pointer(builder, args[0], args[1], ir.DoubleType(), _VECTOR)
        places = [builder.gep(first, [ir.Constant(ir.IntType(32), k)]) for k in range(_PARTS)]
        return _joined(builder, [builder.load(place, align=8) for place in places])

    return lanes_type(types.intp, types.intp), codegen


@intrinsic
def store(typingctx: Any, base: Any, index: Any, value: Any) -> Any:
    """Put lanes where `load` would read them; a number goes into all of them."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        first = _pointer(builder, args[0], args[1], ir.DoubleType(), _VECTOR)
        for k, part in enumerate(_parts(builder, sig.args[2], args[2])):
            builder.store(part, builder.gep(first, [ir.Constant(ir.IntType(32), k)]), align=8)
        return context.get_dummy_value()

    kind = value if isinstance(value, _LanesType) else types.float64
    return types.void(types.intp, types.intp, kind), codegen


@intrinsic
def integer(typingctx: Any, base: Any, index: Any) -> Any:
    """The `index`-th of the integers stored at the address `base`."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return builder.load(_pointer(builder, args[0], args[1], ir.IntType(64), ir.IntType(64)), align=8)

    return types.int64(types.intp, types.intp), codegen


def address(array: NDArray[Any]) -> int:
    """Address of an array for `load`, `store` and `integer`; whoever passes it on keeps the array alive."""
    if not array.flags.c_contiguous or array.dtype.itemsize != 8:
        raise ValueError("a contiguous array of eight-byte numbers is needed")
    return int(array.ctypes.data)


def lane_room(count: int) -> NDArray[np.float64]:
    """Zeros for `count` values of all lanes, placed so that no vector straddles two cache lines."""
    room = np.zeros((count + 1) * LANES)
    skip = (-room.ctypes.data % (8 * LANES)) // 8
    return room[skip : skip + count * LANES]


@intrinsic
def spread(typingctx: Any, number: Any) -> Any:
    """All lanes equal to one number."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        return _joined(builder, [_spread(builder, args[0])] * _PARTS)

    return lanes_type(types.float64), codegen


@intrinsic
def where_at_most(typingctx: Any, a: Any, b: Any, x: Any, y: Any) -> Any:
    """`x` in lanes where a <= b, otherwise `y`; a NaN in the comparison gives `y`."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        parts = zip(*(_parts(builder, kind, value) for kind, value in zip(sig.args, args, strict=True)), strict=True)
        return _joined(builder, [builder.select(builder.fcmp_ordered("<=", a, b), x, y) for a, b, x, y in parts])

    kinds = [kind if isinstance(kind, _LanesType) else types.float64 for kind in (a, b, x, y)]
    return lanes_type(*kinds), codegen


@intrinsic
def any_positive(typingctx: Any, value: Any) -> Any:
    """Whether a lane is > 0."""

    def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
        none, found = ir.Constant(_VECTOR, [0.0] * _WIDTH), ir.Constant(ir.IntType(_WIDTH), 0)
        for part in _parts(builder, sig.args[0], args[0]):
            mask = builder.fcmp_ordered(">", part, none)
            found = builder.or_(found, builder.bitcast(mask, ir.IntType(_WIDTH)))
        return builder.icmp_unsigned("!=", found, ir.Constant(ir.IntType(_WIDTH), 0))

    return types.boolean(value), codegen


def _unary(name: str) -> Any:
    def make(typingctx: Any, value: Any) -> Any:
        def codegen(context: Any, builder: Any, sig: Any, args: Any) -> Any:
            kind = ir.FunctionType(_VECTOR, [_VECTOR])
            function = cgutils.get_or_insert_function(builder.module, kind, f"llvm.{name}.v{_WIDTH}f64")
            return _joined(builder, [builder.call(function, [part]) for part in _parts(builder, sig.args[0], args[0])])

        return lanes_type(lanes_type), codegen

    return intrinsic(make)


square_root = _unary("sqrt")
magnitude = _unary("fabs")
_floor = _unary("floor")


@kernel
def maximum(a, b):
    """Larger of two in every lane."""
    return where_at_most(a, b, b, a)


# sin(pi r) = r sum_k c_k r^2k: the Taylor series is exact to rounding for |r| <= 1/2 with eleven terms.
_S = tuple((-1) ** k * math.pi ** (2 * k + 1) / math.factorial(2 * k + 1) for k in range(11))
_S0, _S1, _S2, _S3, _S4, _S5, _S6, _S7, _S8, _S9, _S10 = _S


@kernel
def cos_turns(turns):
    """cos(2 pi turns) to within 4e-16, from cos = 1 - 2 sin^2 of half the angle reduced to its last turn."""
    r = turns - _floor(turns + 0.5)
    s = r * r
    p = s * (s * (s * (s * (s * _S10 + _S9) + _S8) + _S7) + _S6) + _S5
    p = r * (s * (s * (s * (s * (s * p + _S4) + _S3) + _S2) + _S1) + _S0)
    return 1.0 - 2.0 * (p * p)


def parameter(table, index, like):
    """Entry `index` of a packed table: a number where `like` is a number, one for every lane where it is `Lanes`."""
    raise NotImplementedError


@overload(parameter, inline="always")
def _parameter(table, index, like):
    if isinstance(like, _LanesType):
        return lambda table, index, like: load(table, index * LANES)
    if isinstance(like, numba.types.Float):
        return lambda table, index, like: table[index]
    return None


# Functions of `Lanes` and of numbers alike, for code that is compiled for both.
_E = tuple(1.0 / math.factorial(k) for k in range(16))
_E0, _E1, _E2, _E3, _E4, _E5, _E6, _E7, _E8, _E9, _E10, _E11, _E12, _E13, _E14, _E15 = _E


def root(x):
    """Square root."""
    raise NotImplementedError


@overload(root)
def _root(x):
    if isinstance(x, _LanesType):
        return lambda x: square_root(x)
    return lambda x: math.sqrt(x)


def larger(a, b):
    """Larger of two; `b` must be a number or like `a`."""
    raise NotImplementedError


@overload(larger)
def _larger(a, b):
    if isinstance(a, _LanesType):
        return lambda a, b: where_at_most(a, b, b, a)
    return lambda a, b: b if a <= b else a


def hyperbolic_tangent(x):
    """Hyperbolic tangent, to within 1e-14 in lanes."""
    raise NotImplementedError


@overload(hyperbolic_tangent)
def _hyperbolic_tangent(x):
    if isinstance(x, _LanesType):
        return lambda x: _tanh_of_lanes(x)
    return lambda x: math.tanh(x)


@kernel
def _tanh_of_lanes(x):
    """tanh x = (1 - e)/(1 + e) with e = exp(-2 |x|) as the 64th power of a Taylor series; beyond 20 it is 1."""
    s = magnitude(x)
    s = where_at_most(s, 20.0, s, spread(20.0)) * (-1.0 / 32.0)
    p = s * (s * (s * (s * (s * (s * (s * _E15 + _E14) + _E13) + _E12) + _E11) + _E10) + _E9) + _E8
    p = s * (s * (s * (s * (s * (s * (s * (s * p + _E7) + _E6) + _E5) + _E4) + _E3) + _E2) + _E1) + _E0
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    p = p * p
    t = (1.0 - p) / (1.0 + p)
    return where_at_most(0.0, x, t, -1.0 * t)
