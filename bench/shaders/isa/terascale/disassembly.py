"""What r600's listing is made of: bundles by what they compute, exports and fetches, and jumps.

The ALU runs a bundle at once: an operation in each of the slots x, y, z and w, and one in t, which alone computes
reciprocals, roots, logarithms and sines (AMD, R600 and Evergreen Family Instruction Set Architecture, 2009 and 2011).
The line that starts a clause only says where its bundles or fetches are: it is not counted.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple

# The columns that add up to the count.
KINDS = ("other_alu", "transcendental", "memory", "control_flow")
# What compares, chooses between two numbers or keeps one within bounds.
GUARDS = ("SET", "CND", "MAX", "MIN", "PRED_SET", "KILL")

_TRANSCENDENTAL = ("RECIP", "SQRT", "EXP_", "LOG_", "SIN", "COS")
_CLAUSES = ("ALU", "TEX", "VTX", "GDS")
_MEMORY = ("EXPORT", "MEM_")
_JUMPS = ("JUMP", "ELSE", "POP", "LOOP_", "CALL", "RETURN", "PUSH", "END", "CF_END", "NOP", "CF_NATIVE")
# " 0006 00380400 00346B80     1 x:     INTERP_ZW ...": a place, two words, the bundle's number, the slot, the name.
_OPERATION = re.compile(r"^ \d{4,} ([0-9A-F]{8}) [0-9A-F]{8} +(\d+)? *([xyzwt]):[MP01 ]*([A-Z]\w*)")
_FETCH = re.compile(r"^ \d{4,} (?:[0-9A-F]{8} ){3} *([A-Z]\w*)")
# "0002 C0000000 94C00FC8  EXPORT ...": of the program that starts clauses, exports and jumps.
_CONTROL = re.compile(r"^\d{4,} [0-9A-F]{8} [0-9A-F]{8} +([A-Z]\w*)")
# The bit of an operation's first word that ends its bundle.
_LAST = 1 << 31


class Operation(NamedTuple):
    """One slot of a bundle."""

    slot: str
    name: str


def bundles(assembly: str) -> list[list[Operation]]:
    """The operations of each bundle, in order, by the bit that ends one."""
    found: list[list[Operation]] = [[]]
    for match in filter(None, map(_OPERATION.match, assembly.splitlines())):
        found[-1].append(Operation(match[3], match[4]))
        if int(match[1], 16) & _LAST:
            found.append([])
    return [bundle for bundle in found if bundle]


def _others(assembly: str) -> Iterator[str]:
    """The name of each fetch, export and jump."""
    for line in assembly.splitlines():
        match = _FETCH.match(line) or _CONTROL.match(line)
        if match and not (line[0] != " " and match[1].startswith(_CLAUSES)):
            yield match[1] if line[0] != " " else f"MEM_{match[1]}"


def count(assembly: str) -> int:
    """Bundles by the driver's own numbers, and fetches, exports and jumps."""
    numbers = [int(match[2]) for match in map(_OPERATION.match, assembly.splitlines()) if match and match[2]]
    return max(numbers, default=0) + sum(1 for _ in _others(assembly))


def names(assembly: str) -> list[str]:
    """The name of each operation and of each other instruction; operations first."""
    return [operation.name for bundle in bundles(assembly) for operation in bundle] + list(_others(assembly))


def kind(name: str) -> str:
    """The kind of a fetch, an export or a jump. Raises ValueError for one that is of none."""
    if name.startswith(_MEMORY):
        return "memory"
    if name.startswith(_JUMPS):
        return "control_flow"
    raise ValueError(f"unknown instruction {name}")


def _is_transcendental(bundle: list[Operation]) -> bool:
    return any(operation.name.startswith(_TRANSCENDENTAL) for operation in bundle)


def kinds(assembly: str, total: int, _: str = "") -> dict[str, int] | None:
    """How many instructions of each kind; None where the text does not list `total` instructions that are known."""
    counts = Counter("transcendental" if _is_transcendental(bundle) else "other_alu" for bundle in bundles(assembly))
    try:
        counts.update(map(kind, _others(assembly)))
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if counts.total() == total else None


def slots(assembly: str) -> dict[str, int]:
    """How many slots of all bundles have an operation, and how many of those are t."""
    filled = [operation.slot for bundle in bundles(assembly) for operation in bundle]
    return {"vliw_slots": len(filled), "t_slots": filled.count("t")}


def issue_slots(counts: Mapping[str, int], _: str) -> int:
    """Bundles: each takes as long as any other, whatever it computes."""
    return counts["other_alu"] + counts["transcendental"]


def rates(_: str) -> Mapping[str, int]:
    """How many issue slots a bundle of each kind takes: one, whatever it computes."""
    return {"other_alu": 1, "transcendental": 1}


def jumps(assembly: str) -> tuple[int, int]:
    """(branches, loops): jumps over what not every lane runs, and jumps back."""
    found = list(_others(assembly))
    return sum(name.startswith("JUMP") for name in found), sum(name.startswith("LOOP_END") for name in found)
