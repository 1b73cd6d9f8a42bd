"""Which kind each instruction of a Radeon's disassembly is of.

Full-rate and the others that compute run once for each lane; transcendental ones and whole products of 32-bit integers
at a quarter of the rate. Scalar ones run once for all lanes, beside the others. Memory is loads, stores, interpolation
and export. Waiting is what the compiler has to say about order: waits, hints, the end.
"""

from __future__ import annotations

import re
from collections import Counter

KINDS = ("full_rate", "transcendental", "wide_product", "scalar", "memory", "waiting")

_RULES = (
    ("memory", r"v_interp_|lds_|ds_|buffer_|tbuffer_|image_|global_|flat_|scratch_|exp|s_load|s_buffer_load|s_store"),
    ("waiting", r"s_(wait|nop|clause|delay|end|code_end|inst_prefetch|set_inst|setprio|sleep|barrier|ttrace|sendmsg)"),
    ("transcendental", r"v_(s_)?(rcp|rsq|sqrt|log|exp|sin|cos)_"),
    ("wide_product", r"v_(mul_lo|mul_hi|mad_u64|mad_i64)_"),
    ("scalar", r"s_"),
    ("full_rate", r"v_"),
)
_INSTRUCTION = re.compile(r"^\s+([a-z][a-z0-9_]+)\b")


def names(assembly: str) -> list[str]:
    """The name of each instruction, in order; labels, comments and blank lines are none."""
    return [match[1] for line in assembly.splitlines() if (match := _INSTRUCTION.match(line))]


def kind(name: str) -> str:
    """The kind of an instruction. Raises ValueError for one that is of none."""
    for found, rule in _RULES:
        if re.match(rf"(?:{rule})", name):
            return found
    raise ValueError(f"unknown instruction {name}")


def kinds(assembly: str, total: int) -> dict[str, int] | None:
    """How many instructions of each kind; None where the text is not a listing of `total` instructions that are known.

    A driver that was built without a disassembler says so in words instead.
    """
    try:
        counts = Counter(map(kind, names(assembly)))
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if counts.total() == total else None
