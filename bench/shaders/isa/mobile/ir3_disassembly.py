"""What the disassembly of a Qualcomm GPU is made of (Mesa's ir3, for Adreno 6xx).

The hardware's categories (src/freedreno/ir3/ir3.h): 0 flow, 1 moves and conversions, 2 and 3 arithmetic of two and
three operands, 4 transcendental functions, 5 textures, 6 memory, 7 barriers. Mesa's count includes the cycles that a
program waits in words: `nop`, and (nop2) before another instruction. (rpt1) runs an instruction twice.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from functools import cache
from typing import NamedTuple

# The columns that add up to the count.
KINDS = ("other_alu", "conversion", "transcendental", "memory", "control_flow", "waiting")
# What compares, chooses between two numbers or keeps one within bounds.
GUARDS = ("cmps", "cmpv", "sel", "min", "max")

_RULES = (
    ("waiting", r"nop|bar|fence"),
    (
        "control_flow",
        r"jump|br\w*|bany|ball|bkt|end|ret|kill|demote|call|ch(?:mask|sh)|shp[se]|pred[tfe]|getone|getlast",
    ),
    ("conversion", r"cov"),
    ("transcendental", r"h?(?:rcp|rsq|sqrt|log2|exp2|sin|cos)"),
    ("memory", r"sam\w*|isam\w*|gather\w*|get(?:size|lod|info|buf|pos)|dsx\w*|dsy\w*|res(?:info|fmt)|atomic"),
    ("memory", r"ld\w*|st[gliopcb]\w*|prefetch|endls|l2g|g2l"),
    ("other_alu", r"mova?1?|movs|swz|gat|sct|movmsk|bary|flat|absneg|add|and|ashr|bfrev|cbits|ceil|clz|cmp[sv]|floor"),
    ("other_alu", r"getbit|max|mgen|min|msad|mull?|not|or|rnda?z?n?e?|setrm|sh[blr]\w*|sign|sub|trunc|xor"),
    ("other_alu", r"mad(?:sh)?|sel|sad|andg|dp[24]acc|wmm"),
)
# "(ss)(nop3) mul.f r1.y, ...", "(rpt1)nop", "br p0.x, #12"; what follows the name is types and operands.
_INSTRUCTION = re.compile(r"^\s*((?:\([a-z]+\d*\)\s*)*)([a-z][a-z0-9_]*)((?:\.[a-z0-9]+)*)\b(.*)$")
_TIMES = re.compile(r"\((nop|rpt)(\d+)\)")
_LABEL = re.compile(r"^(l\d+):")
_TARGET = re.compile(r"#(?:(-)?\d+|(l\d+))")


class Instruction(NamedTuple):
    """One line: its name, how often it runs, how many cycles it waits first, and whether it jumps back."""

    name: str
    times: int
    waits: int
    back: bool


def instructions(assembly: str) -> Iterator[Instruction]:
    """Every instruction up to the last `end`; those behind it only fill the line of the cache."""
    found: list[tuple[re.Match[str], bool]] = []
    passed: set[str] = set()
    for line in assembly.splitlines():
        if label := _LABEL.match(line):
            passed.add(label[1])
        elif line[:1] not in ";@N" and (match := _INSTRUCTION.match(line)):
            target = _TARGET.search(match[4])
            found.append((match, bool(target) and (bool(target[1]) or target[2] in passed)))
    last = max((i for i, (match, _) in enumerate(found) if match[2] == "end"), default=len(found) - 1)
    for match, is_back in found[: last + 1]:
        said = {name: int(number) for name, number in _TIMES.findall(match[1])}
        # Without (rpt) the bits that step through registers hold the cycles to wait, which some names show as (r).
        steps = 0 if "rpt" in said else sum(i * ("(r)" in part) for i, part in enumerate(match[4].split(",")[-2:], 1))
        yield Instruction(match[2], 1 + said.get("rpt", 0), said.get("nop", 0) + steps, is_back)


def names(assembly: str) -> list[str]:
    """The name of each instruction, in order."""
    return [one.name for one in instructions(assembly)]


@cache
def kind(name: str) -> str:
    """The kind of an instruction. Raises ValueError for one that is of none."""
    for found, rule in _RULES:
        if re.fullmatch(rule, name):
            return found
    raise ValueError(f"unknown instruction {name}")


def kinds(assembly: str, total: int, _: str = "") -> dict[str, int] | None:
    """How many instructions of each kind; None where the text does not list `total` instructions that are known."""
    counts: Counter[str] = Counter()
    try:
        for one in instructions(assembly):
            counts[kind(one.name)] += one.times
            counts["waiting"] += one.waits
    except ValueError:
        return None
    return {name: counts[name] for name in KINDS} if counts.total() == total else None


def issue_slots(_: Mapping[str, int], __: str) -> None:
    """Nothing: the rates are not public."""
    return


def rates(_: str) -> Mapping[str, int]:
    """How many issue slots an instruction of each kind takes: one, since the rates are not public."""
    return {**dict.fromkeys(KINDS, 1), "waiting": 0}


def jumps(assembly: str) -> tuple[int, int]:
    """(branches, loops): conditional jumps ahead, and jumps back."""
    found = [one for one in instructions(assembly) if kind(one.name) == "control_flow"]
    ahead = sum(one.name.startswith(("br", "ba")) and not one.back for one in found)
    return ahead, sum(one.back for one in found)
