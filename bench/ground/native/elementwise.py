"""Translation of elementwise JAX functions to C.

Only functions that treat each element of their arrays alike can be translated. JAX traces the functions, and each
operation becomes one line of C. Numbers have the same types as in JAX, and the elements are not in arrays.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

import jax
import numpy as np
from jax.extend import core

TYPES: Mapping[str, str] = MappingProxyType(
    {
        "bool": "_Bool",
        "uint8": "uint8_t",
        "uint16": "uint16_t",
        "int32": "int32_t",
        "uint32": "uint32_t",
        "int64": "int64_t",
        "uint64": "uint64_t",
        "float16": "_Float16",
        "float32": "float",
        "float64": "double",
    }
)
INFIX: Mapping[str, str] = MappingProxyType(
    {
        "add": "+",
        "sub": "-",
        "mul": "*",
        "div": "/",
        "gt": ">",
        "ge": ">=",
        "lt": "<",
        "le": "<=",
        "eq": "==",
        "ne": "!=",
        "and": "&",
        "or": "|",
    }
)
# Functions of <tgmath.h>, which chooses by type.
CALLS: Mapping[str, str] = MappingProxyType({"abs": "fabs", "ceil": "ceil", "floor": "floor", "sqrt": "sqrt"})
# What gives its argument as it is.
SAME = ("broadcast_in_dim", "optimization_barrier", "squeeze")
# What a traced array holds; any number will do.
LANES = 8


class NotElementwiseError(Exception):
    """A JAX function cannot be translated to C; the message names the operation."""


def c_function(name: str, function: Callable[..., Any], *arguments: Any) -> str:
    """Return C source for a JAX function: `void name(arguments..., *results)`, for one element.

    Args:
        name: the name of the function in C.
        function: a function of arrays, one pytree per argument; its results are a pytree of arrays. Python numbers
            in it have 64 bits, as when rows are measured.
        arguments: the function's arguments, with a NumPy type in place of each array.

    Raises:
        NotElementwiseError: an operation cannot be written in C, or mixes elements.
    """
    shaped = jax.tree.map(lambda dtype: jax.ShapeDtypeStruct((LANES,), dtype), arguments)
    with jax.enable_x64(True):
        traced = jax.make_jaxpr(function)(*shaped)
    if any(aval.shape != (LANES,) for aval in traced.out_avals):
        raise NotElementwiseError("a result of the wrong shape")
    writer = _Writer()
    taken = [f"a{i}" for i in range(len(traced.in_avals))]
    results = writer.results(traced, taken)
    given = [f"{_type(aval)} {name}" for aval, name in zip(traced.in_avals, taken, strict=True)]
    given += [f"{_type(aval)} *r{i}" for i, aval in enumerate(traced.out_avals)]
    stores = [f"*r{i} = {result};" for i, result in enumerate(results)]
    lines = "".join(f"    {line}\n" for line in (*writer.lines, *stores))
    return f"INLINED void {name}({', '.join(given)}) {{\n{lines}}}\n"


def _type(aval: Any) -> str:
    return c_type(aval.dtype)


def c_type(dtype: Any) -> str:
    """Return the C type for a NumPy type. Raises NotElementwiseError if C has no such type."""
    name = np.dtype(dtype).name
    if name not in TYPES:
        raise NotElementwiseError(f"numbers of type {name}")
    return TYPES[name]


class _Constant(str):
    """A constant as C text, with its value."""

    value: float


def _literal(value: Any) -> _Constant:
    """Return a NumPy number as a C literal with a cast to its type; its `value` is the number. Raises
    NotElementwiseError for an array."""
    value = np.asarray(value)
    if value.ndim:
        raise NotElementwiseError("an array of constants")
    if value.dtype.kind == "f" and np.isfinite(value):
        literal = float(value).hex()
    elif value.dtype.kind == "f":
        literal = "NAN" if np.isnan(value) else "-INFINITY" if value < 0 else "INFINITY"
    else:
        literal = str(int(value))
    written = _Constant(f"(({c_type(value.dtype)}){literal})")
    written.value = value.item()
    return written


class _Writer:
    """The lines of C for a traced function, written operation by operation."""

    def __init__(self) -> None:
        self.lines: list[str] = []

    def results(self, traced: core.ClosedJaxpr, arguments: Sequence[str]) -> list[str]:
        """Return C expressions for a traced function's results, given expressions for its arguments. Add the
        statements that the results need to `lines`."""
        names: dict[Any, str] = dict(zip(traced.jaxpr.invars, arguments, strict=True))
        names |= {var: _literal(value) for var, value in zip(traced.jaxpr.constvars, traced.consts, strict=True)}

        def named(atom: Any) -> str:
            return _literal(atom.val) if isinstance(atom, core.Literal) else names[atom]

        for equation in traced.jaxpr.eqns:
            outputs = self._of(equation, [*map(named, equation.invars)])
            names |= dict(zip(equation.outvars, outputs, strict=True))
        return [*map(named, traced.jaxpr.outvars)]

    def _of(self, equation: Any, given: list[str]) -> Iterable[str]:
        operation = equation.primitive.name
        if operation == "jit":
            return self.results(equation.params["jaxpr"], given)
        if operation in SAME:
            return given[:1] if len(equation.outvars) == 1 else given
        _check_types(equation)
        return [self._kept(_type(equation.outvars[0].aval), _expression(equation, given))]

    def _kept(self, kind: str, expression: str) -> str:
        if isinstance(expression, _Constant):
            return expression
        name = f"t{len(self.lines)}"
        self.lines.append(f"const {kind} {name} = {expression};")
        return name


def _check_types(equation: Any) -> None:
    """Raise NotElementwiseError for an operation on half floats other than a conversion, because C may compute it in
    higher precision."""
    if equation.primitive.name != "convert_element_type" and any(
        var.aval.dtype == np.float16 for var in (*equation.invars, *equation.outvars)
    ):
        raise NotElementwiseError(f"{equation.primitive.name} of half floats")


def _expression(equation: Any, given: Sequence[str]) -> str:
    operation = equation.primitive.name
    if operation == "div" and equation.outvars[0].aval.dtype.kind != "f":
        raise NotElementwiseError("a quotient of integers")  # by 0 it ends the process
    if operation in INFIX:
        return f"{given[0]} {INFIX[operation]} {given[1]}"
    if operation in CALLS and equation.outvars[0].aval.dtype.kind == "f":
        return f"{CALLS[operation]}({given[0]})"
    if operation not in OTHERS:
        raise NotElementwiseError(operation)
    return OTHERS[operation](equation, *given)


def _converted(equation: Any, value: str) -> str:
    """Return a conversion as a C expression. Integers are clamped to their range and NaN becomes 0, as in JAX; C
    leaves both undefined."""
    source, target = equation.invars[0].aval.dtype, equation.outvars[0].aval.dtype
    if isinstance(value, _Constant) and target.kind != "b" and abs(value.value) < 2**31:
        return _literal(np.asarray(value.value, source).astype(target))
    if source.kind == "f" and target.kind in "iu":
        bounds = np.iinfo(target).min, np.iinfo(target).max
        (low, least), (high, most) = ((_literal(source.type(b)), _literal(target.type(b))) for b in bounds)
        within = f"{value} <= {low} ? {least} : {value} >= {high} ? {most} : ({c_type(target)}){value}"
        return f"{value} != {value} ? 0 : {within}"
    if source.kind in "iu" and target.kind == "f" and not isinstance(value, _Constant):
        return f"({c_type(target)})({value} | ({c_type(source)})NOTHING)"
    return f"({c_type(target)}){value}"


def _choice_text(_: Any, which: str, *cases: str) -> str:
    if len(cases) != 2:
        raise NotElementwiseError("a choice between more than two values")
    return f"{which} ? {cases[1]} : {cases[0]}"


def _rounded(equation: Any, value: str) -> str:
    if equation.params["rounding_method"] != jax.lax.RoundingMethod.TO_NEAREST_EVEN:
        raise NotElementwiseError("rounding away from zero")
    return f"nearbyint({value})"


def _limited(sign: str, equation: Any, value: str, other: str) -> str:
    """Return the smaller (`sign` "<") or the larger (">") of two integers as a C expression. Raises
    NotElementwiseError for floats, for which JAX's choice depends on NaN."""
    if equation.outvars[0].aval.dtype.kind == "f":
        raise NotElementwiseError(equation.primitive.name)
    return f"{value} {sign} {other} ? {value} : {other}"


def _shifted(operator: str, kind: str, equation: Any, value: str, by: str) -> str:
    """Return a shift by a constant number of bits as a C expression. Raises NotElementwiseError for any other shift,
    because C does not define a shift by all bits or more.

    Args:
        kind: "u" to shift unsigned integers, or "" to shift signed integers; other integers are cast.
    """
    dtype = equation.outvars[0].aval.dtype
    if not isinstance(by, _Constant) or not 0 <= by.value < 8 * dtype.itemsize:
        raise NotElementwiseError("a shift by an unknown number of bits")
    return f"({c_type(dtype)})(({c_type(kind + dtype.name.lstrip('u'))}){value} {operator} {by})"


def _viewed(equation: Any, value: str) -> str:
    source, target = (var.aval.dtype for var in (equation.invars[0], equation.outvars[0]))
    if source.itemsize != target.itemsize:
        raise NotElementwiseError("a view with numbers of a different size")
    return f"VIEWED({c_type(source)}, {c_type(target)}, {value})"


def _inverted(equation: Any, value: str) -> str:
    return f"!{value}" if equation.outvars[0].aval.dtype.kind == "b" else f"~{value}"


OTHERS: Mapping[str, Callable[..., str]] = MappingProxyType(
    {
        "bitcast_convert_type": _viewed,
        "convert_element_type": _converted,
        "is_finite": lambda _, value: f"fabs({value}) < INFINITY",
        "max": partial(_limited, ">"),
        "min": partial(_limited, "<"),
        "neg": lambda _, value: f"-{value}",
        "not": _inverted,
        "round": _rounded,
        "select_n": _choice_text,
        "shift_left": partial(_shifted, "<<", "u"),
        "shift_right_arithmetic": partial(_shifted, ">>", ""),
        "shift_right_logical": partial(_shifted, ">>", "u"),
    }
)
