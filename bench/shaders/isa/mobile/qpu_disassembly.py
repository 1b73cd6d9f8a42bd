"""What the disassembly of a Broadcom GPU is made of (V3D 4.2, the Raspberry Pi 4).

An instruction holds an operation of the adder, one of the multiplier, and signals that load inputs or end the program:
"fadd rf3, r1, r5 ; fmul r3, r2, rf0 ; ldvary.r4". Names are Mesa's (src/broadcom/qpu/qpu_instr.c, qpu_disasm.c).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple

# The columns that add up to the count.
KINDS = ("other_alu", "conversion", "transcendental", "memory", "control_flow", "waiting")
# What compares or keeps a number within bounds; what chooses is any operation that runs on a condition.
GUARDS = ("fcmp", "fmin", "fmax", "min", "max", "umin", "umax", "xcd")

_TRANSCENDENTAL = {"recip", "rsqrt", "rsqrt2", "exp", "log", "sin"}
_CONVERSIONS = {"ftoin", "ftoiz", "ftouz", "ftoc", "itof", "utof"}
_MEMORY = re.compile(r"ldvpm\w*|stvpm\w*|vpm\w*|tmuwt")
_ALU = re.compile(
    r"v?f?(?:add|sub|mul|min|max|mov|cmp|pack|round|trunc|floor|ceil)|faddnf|fd[xy]|u(?:min|max)|(?:s|u)mul24|multop"
    r"|neg|not|and|or|xor|sh[lr]|asr|ror|clz|[ei]id[x]?|eidx|tidx|lr|f?[xy]cd|rev?f|(?:set)?(?:msf|revf)|sampid"
    r"|barrierid|flpop|fl[ab]push|fl[an]\w*first|v?fl[abn]\w*|vdwwt"
)
# What an operation writes outside of the registers: the tile's buffer and the texture unit.
_WRITES_OUT = re.compile(r"^\S+ (?:tlbu?|tmu\w*|unif\w*|vpm\w*)\b")
_NAME = re.compile(r"^[a-z][a-z0-9_]*")
_JUMP = re.compile(r"^b(u?)(\S*)\s+(?:(-?\d+)|zero_addr|lri|rf)")


class Instruction(NamedTuple):
    """One line: its operations, less those that do nothing, and its signals. A jump is its only operation."""

    operations: tuple[str, ...]
    signals: tuple[str, ...]


def instructions(assembly: str) -> Iterator[Instruction]:
    """Every instruction, in order."""
    for line in filter(str.strip, assembly.splitlines()):
        parts = [part.strip() for part in line.split(";")]
        if _JUMP.match(parts[0]):
            yield Instruction((parts[0],), ())
        elif len(parts) >= 2:
            yield Instruction(tuple(part for part in parts[:2] if part != "nop"), tuple(parts[2:]))


def names(assembly: str) -> list[str]:
    """The name of each operation, in order."""
    return [_operation_name(part) for one in instructions(assembly) for part in one.operations]


def _operation_name(operation: str) -> str:
    """An operation's name, without its conditions; empty for what has none."""
    match = _NAME.match(operation)
    return match[0] if match else ""


def kind(one: Instruction) -> str:
    """The kind of an instruction. Raises ValueError for one with an operation that is of none."""
    if not one.operations:
        return "memory" if any(signal != "thrsw" for signal in one.signals if signal) else "waiting"
    if _JUMP.match(one.operations[0]):
        return "control_flow"
    found = {_operation_name(operation) for operation in one.operations}
    if any(_WRITES_OUT.match(operation) for operation in one.operations) or any(map(_MEMORY.fullmatch, found)):
        return "memory"
    if unknown := {name for name in found - _TRANSCENDENTAL - _CONVERSIONS if not _ALU.fullmatch(name)}:
        raise ValueError(f"unknown operation {min(unknown)}")
    if found & _TRANSCENDENTAL:
        return "transcendental"
    return "conversion" if found & _CONVERSIONS else "other_alu"


def kinds(assembly: str, total: int, _: str = "") -> dict[str, int] | None:
    """How many instructions of each kind; None where the text does not list `total` instructions that are known."""
    try:
        counts = Counter(map(kind, instructions(assembly)))
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if counts.total() == total else None


def issue_slots(counts: Mapping[str, int], _: str) -> int:
    """Instructions: one issues after the other, whatever it holds."""
    return sum(counts.values())


def slots(assembly: str) -> dict[str, int]:
    """How many operations all instructions hold."""
    return {"vliw_slots": sum(len(one.operations) for one in instructions(assembly))}


def rates(_: str) -> Mapping[str, int]:
    """How many issue slots an instruction of each kind takes: one, whatever it holds."""
    return dict.fromkeys(KINDS, 1)


def jumps(assembly: str) -> tuple[int, int]:
    """(branches, loops): conditional jumps ahead, and jumps back."""
    found = [match for one in instructions(assembly) for part in one.operations if (match := _JUMP.match(part))]
    back = sum(bool(match[3]) and int(match[3]) < 0 for match in found)
    return sum(bool(match[2]) and not (match[3] and int(match[3]) < 0) for match in found), back
