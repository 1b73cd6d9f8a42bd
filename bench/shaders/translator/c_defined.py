"""Integer operations that are undefined in C: functions that define them, and ranges that make these unnecessary."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from .tree import Assign, Binary, Declare, For, Literal, Name, inside
from .writer import base_of

# What a number is at least and at most.
Range = tuple[int, int]
INT = (-(2**31), 2**31 - 1)
# Functions of the file's own: what C leaves undefined, or has for no such type.
HELPERS: Mapping[str, str] = MappingProxyType(
    {
        "min": "float {0}(float a, float b) {{ return a < b ? a : b; }}",
        "max": "float {0}(float a, float b) {{ return a > b ? a : b; }}",
        "imin": "int32_t {0}(int32_t a, int32_t b) {{ return a < b ? a : b; }}",
        "imax": "int32_t {0}(int32_t a, int32_t b) {{ return a > b ? a : b; }}",
        "umin": "uint32_t {0}(uint32_t a, uint32_t b) {{ return a < b ? a : b; }}",
        "umax": "uint32_t {0}(uint32_t a, uint32_t b) {{ return a > b ? a : b; }}",
        "iabs": "int32_t {0}(int32_t a) {{ return a < 0 && a != INT32_MIN ? -a : a; }}",
        "isign": "int32_t {0}(int32_t a) {{ return (a > 0) - (a < 0); }}",
        "floatBitsToInt": "int32_t {0}(float x) {{ int32_t y = "
        "0x7FC00000; if (x == x) memcpy(&y, &x, sizeof y); return y; }}",
        "floatBitsToUint": "uint32_t {0}(float x) {{ uint32_t y = "
        "0x7FC00000u; if (x == x) memcpy(&y, &x, sizeof y); return y; }}",
        "intBitsToFloat": "float {0}(int32_t x) {{ float y; memcpy(&y, &x, sizeof y); return y; }}",
        "uintBitsToFloat": "float {0}(uint32_t x) {{ float y; memcpy(&y, &x, sizeof y); return y; }}",
        "to_int": "int32_t {0}(float x) {{ return x >= 2147483648.0f ? INT32_MAX : x >= -2147483648.0f ? (int32_t)x"
        " : x < 0.0f ? INT32_MIN : 0; }}",
        "to_uint": "uint32_t {0}(float x) {{ return x >= 4294967296.0f ? UINT32_MAX : x >= 0.0f ? (uint32_t)x : 0; }}",
        "at": "int32_t {0}(int32_t i, int32_t count) {{ return i < 0 ? 0 : i < count ? i : count - 1; }}",
        "add": "int32_t {0}(int32_t a, int32_t b) {{ return (int32_t)((uint32_t)a + (uint32_t)b); }}",
        "subtract": "int32_t {0}(int32_t a, int32_t b) {{ return (int32_t)((uint32_t)a - (uint32_t)b); }}",
        "multiply": "int32_t {0}(int32_t a, int32_t b) {{ return (int32_t)((uint32_t)a * (uint32_t)b); }}",
        "divide": "int32_t {0}(int32_t a, int32_t b) {{ return !b || (b == -1 && a == INT32_MIN) ? a : a / b; }}",
        "remainder": "int32_t {0}(int32_t a, int32_t b) {{ return !b || b == -1 ? 0 : a % b; }}",
        "udivide": "uint32_t {0}(uint32_t a, uint32_t b) {{ return b ? a / b : a; }}",
        "uremainder": "uint32_t {0}(uint32_t a, uint32_t b) {{ return b ? a % b : 0; }}",
        "left": "int32_t {0}(int32_t a, uint32_t b) {{ return (int32_t)((uint32_t)a << (b & 31)); }}",
        "right": "int32_t {0}(int32_t a, uint32_t b) {{ return a >> (b & 31); }}",
        "uleft": "uint32_t {0}(uint32_t a, uint32_t b) {{ return a << (b & 31); }}",
        "uright": "uint32_t {0}(uint32_t a, uint32_t b) {{ return a >> (b & 31); }}",
    }
)
OPERATIONS: Mapping[str, str] = MappingProxyType(
    {"+": "add", "-": "subtract", "*": "multiply", "/": "divide", "%": "remainder", "<<": "left", ">>": "right"}
)


def counted(loop: For) -> dict[str, Range]:
    """Return the range, first and last value, of a loop's counter, by the counter's name, if the loop counts up
    between two numbers; empty for other loops, and if the loop's body changes the counter."""
    match loop:
        case For(
            Declare("int" | "uint", name, Literal(_, first)),
            Binary(_, "<" | "<=" as mark, Name(_, same), Literal(_, end)),
            Assign(Name(_, counted), "+=", Literal(_, by)),
        ) if name == same == counted and int(by, 0) > 0:
            changed = [node for node in inside(loop.body) if isinstance(node, Assign) and base_of(node) == name]
            # The counter goes one step beyond.
            last = int(end, 0) - (mark == "<")
            return {} if changed or last + int(by, 0) > INT[1] else {name: (int(first, 0), last)}
    return {}


def range_of(mark: str, left: Range | None, right: Range | None) -> Range | None:
    """Return the range of an operation's result from its operands' ranges; None if it is unknown or too large."""
    if mark == "&":
        known = [most for operand in (left, right) if operand and operand[0] >= 0 for most in operand[1:]]
        return (0, min(known)) if known else None
    if not left or not right:
        return None
    match mark:
        case "+":
            bounds = left[0] + right[0], left[1] + right[1]
        case "-":
            bounds = left[0] - right[1], left[1] - right[0]
        case "*":
            corners = [a * b for a in left for b in right]
            bounds = min(corners), max(corners)
        case "<<" if left[0] >= 0 and right[0] >= 0 and right[1] < 32:
            bounds = left[0] << right[0], left[1] << right[1]
        case ">>" if left[0] >= 0 and right[0] >= 0:
            bounds = left[0] >> right[1], left[1] >> right[0]
        case _:
            return None
    return bounds if INT[0] <= bounds[0] and bounds[1] <= INT[1] else None
