"""The contents of a Radeon disassembly: the kinds of its instructions, their issue slots, and its jumps.

Scalar instructions run once for all lanes, in parallel with the others. Memory instructions are loads, stores,
interpolation and export. Waiting instructions control the order of execution: waits, hints and the program's end. The
other instructions run once per lane, at rates that depend on the family.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from types import MappingProxyType

KINDS = ("full_rate", "conversion", "quarter_rate", "transcendental", "scalar", "memory", "waiting")

_RULES = (
    ("memory", r"v_interp_|lds_|ds_|buffer_|tbuffer_|image_|global_|flat_|scratch_|exp|s_load|s_buffer_load|s_store"),
    ("waiting", r"s_(wait|nop|clause|delay|end|code_end|inst_prefetch|set_inst|setprio|sleep|barrier|ttrace|sendmsg)"),
    ("transcendental", r"v_(s_)?(rcp|rsq|sqrt|log|exp|sin|cos)_"),
    # From bytes, and into two halves at once, is not a conversion of the slow sort.
    ("conversion", r"v_cvt_(?!f32_ubyte|pk)"),
    # Products of 32-bit integers.
    ("quarter_rate", r"v_mul_(lo|hi)_[iu]32(?!_[iu]24)|v_mad_[iu]64_"),
    ("scalar", r"s_"),
    ("full_rate", r"v_"),
)
# Instructions of a fused multiply-add that Polaris computes at a quarter of the rate; usual ones are v_mad there.
_SLOW = {"polaris10": r"v_fma_"}
_INSTRUCTION = re.compile(r"^\s+([a-z][a-z0-9_]+)\b(?:\s+(BB\d+))?")
_LABEL = re.compile(r"^(BB\d+):")
# RADV writes an instruction that comes several times in a row once.
_REPEATED = re.compile(r"^\s*\(then repeated (\d+) times\)")

# What a lane's instruction keeps the vector ALU's issue busy for, in full-rate instructions (4 cycles of a wave on GCN,
# 1 for 32 lanes on RDNA). GCN: LLVM's scheduling model (SISchedule.td: WriteFloatCvt, WriteTrans32 and
# WriteQuarterRate32 are 4), which is ACO's but for conversions, at full rate there. RDNA: ACO's (aco_statistics.cpp);
# conversions are at full rate, and transcendental ones issue once and run 4 cycles in a unit beside.
_GCN = MappingProxyType({"full_rate": 1, "conversion": 4, "quarter_rate": 4, "transcendental": 4})
_RDNA = MappingProxyType({"full_rate": 1, "conversion": 1, "quarter_rate": 4, "transcendental": 1})
SLOTS: Mapping[str, Mapping[str, int]] = MappingProxyType(
    {"polaris10": _GCN, "vega10": _GCN, "navi10": _RDNA, "navi21": _RDNA, "navi31": _RDNA}
)


def names(assembly: str) -> list[str]:
    """Return the names of a listing's instructions, in order; labels, comments and blank lines are skipped."""
    mnemonics: list[str] = []
    for line in assembly.splitlines():
        if match := _INSTRUCTION.match(line):
            mnemonics.append(match[1])
        elif match := _REPEATED.match(line):
            mnemonics += mnemonics[-1:] * int(match[1])
    return mnemonics


@cache
def kind(name: str, family: str = "") -> str:
    """Return the kind of an instruction, one of KINDS. Raises ValueError if its name is unknown, or if it computes in
    64-bit floats, which have other rates."""
    if "_f64" in name:
        raise ValueError(f"{name} computes in 64-bit floats")
    if family in _SLOW and re.match(_SLOW[family], name):
        return "quarter_rate"
    for rule_kind, rule in _RULES:
        if re.match(rf"(?:{rule})", name):
            return rule_kind
    raise ValueError(f"unknown instruction {name}")


def kinds(assembly: str, total: int, family: str = "") -> dict[str, int] | None:
    """Return the number of instructions of each kind; None unless the text lists `total` known instructions.

    A driver that was built without a disassembler writes a message instead of the listing.
    """
    try:
        counts = Counter(kind(name, family) for name in names(assembly))
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if counts.total() == total else None


def issue_slots(counts: Mapping[str, int], family: str) -> int | None:
    """Return the issue slots of a kernel on the vector ALU, in full-rate instructions; the slots of several kernels
    can be added. None if the family's rates are unknown."""
    slots = rates(family)
    return sum(rate * counts[name] for name, rate in slots.items()) if slots else None


def rates(family: str) -> Mapping[str, int] | None:
    """Return the issue slots per instruction, by kind, without the kinds that run in parallel; None if unknown."""
    return SLOTS.get(family)


def kinds_in_order(assembly: str, family: str) -> list[str]:
    """Return the kind of each instruction of a listing, in order. Raises ValueError if one of them is unknown."""
    return [kind(name, family) for name in names(assembly)]


def packed(assembly: str) -> int:
    """Count the instructions that compute two 16-bit numbers at once."""
    return sum(name.startswith("v_pk_") for name in names(assembly))


def loops(assembly: str) -> list[range]:
    """Return each loop's range of instruction indices: from the target label of a backward jump to the jump."""
    begins: dict[str, int] = {}
    spans: list[range] = []
    place = 0
    for line in assembly.splitlines():
        if label := _LABEL.match(line):
            begins[label[1]] = place
        elif match := _INSTRUCTION.match(line):
            place += 1
            if match[1].startswith(("s_cbranch", "s_branch")) and match[2] in begins:
                spans.append(range(begins[match[2]], place))
        elif match := _REPEATED.match(line):
            place += int(match[1])
    return spans


def jumps(assembly: str) -> tuple[int, int]:
    """Return (branches, loops): the number of conditional forward jumps, over code that some waves skip, and of
    backward jumps."""
    ahead = back = 0
    for is_conditional, is_back in _jumps(assembly):
        back += is_back
        ahead += is_conditional and not is_back
    return ahead, back


def _jumps(assembly: str) -> Iterator[tuple[bool, bool]]:
    """Yield two Booleans for each jump: whether it is conditional, and whether it goes back."""
    passed: set[str] = set()
    for line in assembly.splitlines():
        if label := _LABEL.match(line):
            passed.add(label[1])
        elif (match := _INSTRUCTION.match(line)) and match[1].startswith(("s_cbranch", "s_branch")):
            yield match[1].startswith("s_cbranch"), match[2] in passed
