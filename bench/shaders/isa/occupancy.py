"""The number of a kernel's waves that a GPU's SIMD can hold at once, from the number of registers per wave."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType


@dataclass(frozen=True)
class Occupancy:
    """The limits on the number of waves in a SIMD.

    Attributes:
        waves: the maximum, however few registers a wave uses.
        registers: the number of registers, each as wide as a wave; 0 if each wave has its own fixed share.
        step: the number of registers that are allocated at once.
    """

    waves: int
    registers: int = 0
    step: int = 1

    def of(self, registers: float) -> int:
        """Return the number of waves that a SIMD holds if each uses this number of registers.

        Args:
            registers: the number of registers per wave, as the driver counts them.
        """
        if not self.registers:
            return self.waves
        allotted = -(-max(int(registers), 1) // self.step) * self.step
        return min(self.waves, self.registers // allotted)


# NVIDIA: 16384 registers of 32 bits a quarter of a multiprocessor, which are 512 of a warp of 32 lanes, allotted by 8;
# a quarter of a multiprocessor's warps (CUDA C++ Programming Guide 12.9, technical specifications by compute
# capability).
_GCN, _RDNA2 = Occupancy(10, 256), Occupancy(16, 512)
# Waves of 64 lanes. GCN: 256 registers of 64 lanes and 10 waves a SIMD (AMD, Graphics Core Next Architecture Generation
# 3 ISA, 2016); Polaris 8 waves (Mesa's ac_gpu_info.c). RDNA: 1024 registers of 32 lanes, which are 512 of 64, and 20
# waves (AMD, RDNA whitepaper, 2019); RDNA 2 16 waves (AMD, RDNA 2 ISA, 2020); Navi 31 half as many registers again
# (AMD, RDNA 3 ISA, 2022). Intel: threads of an execution unit, each with 128 registers of its own: 7, Arc 8 (Intel,
# Programmer's Reference Manuals).
OCCUPANCY: Mapping[str, Occupancy] = MappingProxyType(
    {"polaris10": Occupancy(8, 256), "vega10": _GCN, "navi10": Occupancy(20, 512), "navi21": _RDNA2}
    | {"navi31": Occupancy(16, 768)}
    | dict.fromkeys(("hsw", "bdw", "skl", "tgl", "adl"), Occupancy(7))
    | {"dg2": Occupancy(8), "sm_75": Occupancy(8, 512, 8)}
    | dict.fromkeys(("sm_86", "sm_89", "sm_120"), Occupancy(12, 512, 8))
    | dict.fromkeys(("sm_90", "sm_100"), Occupancy(16, 512, 8))
)


def waves(family: str, registers: float | None) -> int | None:
    """Return the number of waves that a SIMD of a GPU family holds for a kernel with this number of registers; None
    if it is unknown."""
    rule = OCCUPANCY.get(family)
    if rule is None or (rule.registers and registers is None):
        return None
    return rule.of(registers or 0)
