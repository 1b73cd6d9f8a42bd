"""The contents of an Intel GPU's disassembly: the kinds of its instructions, and its jumps.

The number of lanes that an instruction works on is in its parentheses: "mad(16)". Mesa's own count leaves out
`nop`; some versions of Mesa also leave out `sync nop`, which only waits, and others count it
(brw_fs_generator.cpp).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

# The columns that add up to the count; Radeons have others.
KINDS = ("other_alu", "conversion", "transcendental", "scalar", "memory", "control_flow", "waiting")

_CONTROL_FLOW = {"if", "else", "endif", "while", "do", "break", "cont", "halt", "jmpi", "brd", "brc", "call", "ret"}
_SENDS = {"send", "sendc", "sends", "sendsc"}
_WAITING = {"sync", "wait"}
_CONVERSIONS = {"f16to32", "f32to16"}
_ALU = {
    *("mov", "sel", "csel", "not", "and", "or", "xor", "shr", "shl", "asr", "ror", "rol", "cmp", "cmpn", "bfrev"),
    *("bfe", "bfi1", "bfi2", "add", "add3", "mul", "avg", "frc", "rndu", "rndd", "rnde", "rndz", "mac", "mach"),
    *("lzd", "fbh", "fbl", "cbit", "addc", "subb", "dp4", "dph", "dp3", "dp2", "dp4a", "line", "pln", "mad", "lrp"),
    *("madm", "movi", "smov", "pln"),
}
# (predicate) name.modifiers function(lanes): "(+f0.0) sel(16)", "cmp.g.f0.0(16)", "math rsq(16)", "sync nop(1)".
_INSTRUCTION = re.compile(r"^(\([^)]*\)\s*)?([a-z][a-z0-9]*)(?:\.[a-z0-9.]+)?(?: ([a-z]\w*)(?:\.\w+)?)?\((\d+)\)(.*)")
_LABEL, _TARGET = re.compile(r"^(LABEL\d+):"), re.compile(r"JIP:\s+(LABEL\d+)")
_TYPE = re.compile(r"(?:>|[0-9a-f])(HF|DF|F|UD|D|UW|W|UB|B|UQ|Q)\b")
_FLOATS = {"HF", "F", "DF"}


class Instruction(NamedTuple):
    """An instruction in a listing: whether it has a predicate, its name, its second word ("rsq" in "math rsq"), its
    number of lanes and its operands."""

    is_predicated: bool
    name: str
    function: str
    lanes: int
    operands: str


def instructions(assembly: str) -> Iterator[Instruction]:
    """Yield the instructions of a listing, in order, without `nop`, labels and the second line of a message."""
    for line in assembly.splitlines():
        if (match := _INSTRUCTION.match(line)) and match[2] != "nop":
            yield Instruction(bool(match[1]), match[2], match[3] or "", int(match[4]), match[5])


def names(assembly: str) -> list[str]:
    """Return the name of each instruction except `nop`, in order."""
    return [instruction.name for instruction in instructions(assembly)]


@cache
def kind(instruction: Instruction) -> str:
    """Return the kind of an instruction, one of KINDS. Raises ValueError if its name is unknown."""
    if instruction.name in _SENDS:
        return "memory"
    if instruction.name in _CONTROL_FLOW:
        return "control_flow"
    if instruction.name in _WAITING:
        return "waiting"
    if instruction.name == "math":
        # The quotient and the rest of integers are not transcendental, but the same unit computes them.
        return "transcendental"
    if instruction.name not in _ALU | _CONVERSIONS:
        raise ValueError(f"unknown instruction {instruction.name}")
    if instruction.lanes == 1:
        return "scalar"
    return "conversion" if instruction.name in _CONVERSIONS or _is_conversion(instruction) else "other_alu"


def _is_conversion(instruction: Instruction) -> bool:
    """Whether an instruction is a `mov` between floats and integers, or between floats of different sizes."""
    types = _TYPE.findall(instruction.operands.split("{")[0])
    if instruction.name != "mov" or len(types) < 2:
        return False
    return types[0] != types[1] and bool(_FLOATS & {*types[:2]})


def kinds(assembly: str, total: int, _: str = "") -> dict[str, int] | None:
    """Return the number of instructions of each kind, 0 included; None unless the text lists `total` known
    instructions, with or without `sync nop`."""
    every = list(instructions(assembly))
    without = [instruction for instruction in every if (instruction.name, instruction.function) != ("sync", "nop")]
    listed = next((some for some in (every, without) if len(some) == total), None)
    try:
        counts = Counter(kind(instruction) for instruction in listed or ())
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if listed else None


def issue_slots(_: Mapping[str, int], __: str) -> None:
    """Return None: rates depend on the unit's width and on operands; the driver's model reports only cycles."""
    return


def packed(_: str) -> None:
    """Return None: instructions process as many lanes with 16-bit numbers as with 32-bit numbers."""
    return


def rates(family: str) -> Mapping[str, int]:
    """Return the issue slots per instruction, by kind, from Mesa's model of the units (brw_ir_performance.cpp): from
    generation 8 on, 8 lanes keep the `math` unit busy for 4 cycles and other units for 2; before, all for 2."""
    return {**dict.fromkeys(KINDS, 1), "waiting": 0, "transcendental": 1 if family == "hsw" else 2}


def kinds_in_order(assembly: str, _: str) -> list[str]:
    """Return the kind of each instruction of a listing, in order. Raises ValueError if one of them is unknown."""
    return [kind(instruction) for instruction in instructions(assembly)]


def loops(assembly: str) -> list[range]:
    """Return each loop's range of instruction indices: from the label that a `while` jumps to, to the `while`."""
    begins: dict[str, int] = {}
    spans: list[range] = []
    place = 0
    for line in assembly.splitlines():
        if label := _LABEL.match(line):
            begins[label[1]] = place
        for instruction in instructions(line):
            place += 1
            target = _TARGET.search(instruction.operands)
            if instruction.name == "while" and target and target[1] in begins:
                spans.append(range(begins[target[1]], place))
    return spans


def jumps(assembly: str) -> tuple[int, int]:
    """Return (branches, loops): the number of conditional forward jumps, including `if`, and of backward jumps."""
    listed = list(instructions(assembly))
    loops = sum(instruction.name == "while" for instruction in listed)
    return sum(
        instruction.name == "if" or (instruction.name == "jmpi" and instruction.is_predicated) for instruction in listed
    ), loops
