"""The contents of a listing of NVIDIA's machine code (SASS), from Turing to Blackwell: the kinds of its instructions,
its jumps, and the cycles for which the compiler stalls a warp after each instruction.

Names are those of the CUDA Binary Utilities' instruction set reference. An instruction has 128 bits, which nvdisasm
prints as two words. The upper part of the second word controls the scheduler: 4 bits for stall cycles, a yield bit,
3 + 3 bits for barriers and 6 bits for barriers to wait for (Z. Jia et al., Dissecting the NVIDIA Volta GPU
Architecture via Microbenchmarking, 2018).
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator, Mapping
from typing import NamedTuple

# The columns that add up to the count.
KINDS = ("other_alu", "conversion", "transcendental", "scalar", "memory", "control_flow", "waiting")
# Bytes of an instruction.
SIZE = 16

_NAMES = {
    "other_alu": "FADD FADD2 FADD32I FFMA FFMA2 FFMA32I FMUL FMUL2 FMUL32I FMNMX FMNMX3 FSEL FSET FSETP FSWZADD FCHK "
    "HADD2 HADD2_32 HFMA2 HFMA2_32I HMUL2 HMUL2_32I HMNMX2 HSET2 HSETP2 VHMNMX "
    "IABS IADD IADD3 IADD32I IMAD IMNMX IMUL IMUL32I ISCADD ISCADD32I ISETP LEA LOP LOP3 LOP32I SHF SHL SHR SGXT BMSK "
    "BREV FLO POPC IDP IDP4A PRMT MOV MOV32I SEL PLOP3 PSETP P2R R2P VABSDIFF VABSDIFF4 VIADD VIADDMNMX VIMNMX VIMNMX3 "
    "S2R CS2R SHFL VOTE MATCH",
    # Rounding to a whole number runs in the unit of conversions.
    "conversion": "F2F F2FP F2I F2IP I2F I2FP I2I I2IP FRND",
    "transcendental": "MUFU",
    "scalar": "R2UR REDUX S2UR CS2UR UBMSK UBREV UCLEA UF2FP UF2I UF2IP UFADD UFFMA UFLO UFMNMX UFMUL UFRND UFSEL "
    "UFSET UFSETP UI2F UI2FP UI2I UI2IP UIABS UIADD3 UIMAD UIMNMX UISETP ULEA ULOP ULOP3 ULOP32I UMOV UP2UR UPLOP3 "
    "UPOPC UPRMT UPSETP UR2UP USEL USGXT USHF USHL USHR UVIADD UVIMNMX UVIRTCOUNT VOTEU",
    # Constants, too, for one lane or for all.
    "memory": "LD LDC LDCU LDG LDL LDS ULDC ST STG STL STS TEX TLD TLD4 TMML TXD TXQ SULD SUST SURED SUATOM ATOM ATOMG "
    "ATOMS RED CCTL CCTLL CCTLT MEMBAR",
    "control_flow": "BMOV BRA BREAK BRX BRXU BSSY BSYNC CALL EXIT JMP JMX JMXU KILL RET WARPSYNC YIELD",
    "waiting": "NOP BAR DEPBAR NANOSLEEP ERRBAR",
}
_KIND: Mapping[str, str] = {name: kind for kind, names in _NAMES.items() for name in names.split()}
# "/*0160*/ @P0 BRA 0x230 ; /* 0x000000c000000947 */", and the second word in a line of its own.
_INSTRUCTION = re.compile(
    r"^\s*/\*([0-9a-f]+)\*/\s+(@!?U?P\w+\s+)?([A-Z][A-Z0-9_]*)[\w.]*\s*([^;]*?)\s*;\s*/\* 0x([0-9a-f]{16}) \*/"
)
_SECOND_WORD = re.compile(r"^\s*/\* 0x([0-9a-f]{16}) \*/\s*$")
_TARGET = re.compile(r"\b0x([0-9a-f]+)\b")
_CONDITION = re.compile(r"^!?U?P\d")
# Of the second word, the lowest of the bits that say how many cycles to wait.
_STALL = 41


class Instruction(NamedTuple):
    """An instruction: its byte offset, whether it has a predicate, its name without modifiers, its operands, and its
    second word, 0 if the listing has none."""

    place: int
    is_predicated: bool
    name: str
    operands: str
    control: int


def every(assembly: str) -> list[Instruction]:
    """Return all instructions of a listing, in order, padding included."""
    listed: list[Instruction] = []
    for line in assembly.splitlines():
        if match := _INSTRUCTION.match(line):
            listed.append(Instruction(int(match[1], 16), bool(match[2]), match[3], match[4], 0))
        elif (match := _SECOND_WORD.match(line)) and listed:
            listed[-1] = listed[-1]._replace(control=int(match[1], 16))
    return listed


def instructions(assembly: str) -> list[Instruction]:
    """Return all instructions except the padding: the NOPs after the self-jump that ends every kernel."""
    listed = every(assembly)
    while listed and listed[-1].name == "NOP":
        listed.pop()
    return listed


def names(assembly: str) -> list[str]:
    """Return the name of each instruction of a listing, in order, without the padding."""
    return [instruction.name for instruction in instructions(assembly)]


def kinds(assembly: str, total: int, _: str = "") -> dict[str, int] | None:
    """Count the instructions of each kind; return None unless the text lists `total` known instructions."""
    listed = names(assembly)
    if len(listed) != total or not _KIND.keys() >= set(listed):
        return None
    counts = Counter(_KIND[name] for name in listed)
    return {kind: counts[kind] for kind in KINDS}


def issue_slots(_: Mapping[str, int], __: str) -> None:
    """Return None: issue times depend on the widths of units, and NVIDIA does not publish all of these widths."""
    return


def packed(_: str) -> None:
    """Return None: the same instructions compute one 16-bit number or two, so packed ones cannot be counted."""
    return


def rates(family: str) -> Mapping[str, int]:
    """Return the issue slots per instruction, by kind. Per cycle, a multiprocessor computes 16 special functions, and
    64 additions on Turing or 128 after it (CUDA C++ Programming Guide, Arithmetic Instructions)."""
    return {**dict.fromkeys(KINDS, 1), "waiting": 0, "transcendental": 4 if family == "sm_75" else 8}


def kinds_in_order(assembly: str, _: str) -> list[str]:
    """Return the kind of each instruction in a listing, in order. All instructions must be known."""
    return [_KIND[name] for name in names(assembly)]


def loops(assembly: str) -> list[range]:
    """Return each loop's range of instruction indices: from the target of a backward jump to that jump."""
    jumps_back = ((instruction.place, distance) for instruction, _, distance in _jumps(assembly) if distance < 0)
    return [range((place + distance) // SIZE, place // SIZE + 1) for place, distance in jumps_back]


def jumps(assembly: str) -> tuple[int, int]:
    """Return (branches, loops): the number of conditional forward jumps, and of backward jumps. A jump to itself,
    such as a kernel's last jump, counts as neither."""
    ahead = back = 0
    for _, is_conditional, distance in _jumps(assembly):
        back += distance < 0
        ahead += is_conditional and distance > 0
    return ahead, back


def _jumps(assembly: str) -> Iterator[tuple[Instruction, bool, int]]:
    """Yield each jump, whether it is conditional, and its distance in bytes, positive for a forward jump."""
    for instruction in instructions(assembly):
        if instruction.name in ("BRA", "JMP") and (target := _TARGET.search(instruction.operands)):
            is_conditional = instruction.is_predicated or bool(_CONDITION.match(instruction.operands))
            yield instruction, is_conditional, int(target[1], 16) - instruction.place


def stall_cycles(assembly: str) -> int | None:
    """Return the sum of the stall cycles that the compiler sets after the instructions of a listing; None if the
    listing lacks an instruction's second word."""
    listed = instructions(assembly)
    return (
        sum(instruction.control >> _STALL & 15 for instruction in listed)
        if all(instruction.control for instruction in listed)
        else None
    )
