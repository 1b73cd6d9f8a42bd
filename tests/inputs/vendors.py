"""Vendors' compilers for the tests that they share; Radeon compilers and their figures are tested separately."""

import sys
from collections.abc import Callable
from dataclasses import dataclass, replace
from types import ModuleType

import pytest

from normalbench.bench.ground.options.gpu_families import CHOICES, FAMILIES
from normalbench.bench.shaders.isa import intel_disassembly, isa, null_device
from normalbench.bench.shaders.isa import process as isa_process
from normalbench.bench.shaders.isa.nvidia import sass, tools
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines.packings import PACKINGS

EVERY_PACKING = tuple(dict.fromkeys(packing for several in PACKINGS.values() for packing in several))
CHEAP = ("xyz", "xy", "spheremap", "stereographic", "octahedral")
# What asks for the instructions of one codec.
INSTRUCTIONS = ["cost", "--isa", "--format", "json", "--encoding", "spheremap", "--storage", "rgba8"]
# Runs the code where the driver is told of an Intel GPU; for a Radeon it compiles as always.
INTELS_CHILD = """
import os, sys, time
from normalbench.bench.shaders.isa import child
if {variable!r} in os.environ:
    {code}
sys.exit(child.main())
"""


@dataclass(frozen=True)
class Vendor:
    """A vendor's GPUs and their compilers.

    Attributes:
        name: name of the vendor's GPUs together in --family, and of the fixture that requests its compilers.
        quick: one family for each compiler.
        stages: kinds of shaders that are counted for the vendor.
        lanes: number of lanes that each kernel works on.
        reader: reader of the listings.
        zero: columns that are 0 if nothing is done, besides the kinds of instructions.
        encodings, packings: names to compile unless all are compiled.
        runs: makes only this vendor's child processes run Python code.
        changes: changes the compiler, or the GPU of `quick[-1]`.
    """

    name: str
    quick: tuple[str, ...]
    stages: tuple[str, ...]
    lanes: int
    reader: ModuleType
    zero: tuple[str, ...]
    runs: Callable[[pytest.MonkeyPatch, str], None]
    changes: Callable[[pytest.MonkeyPatch], None]
    encodings: tuple[str, ...] = CHEAP
    packings: tuple = PACKINGS["12:12"]

    def families(self, is_every: bool) -> tuple[str, ...]:
        return CHOICES[self.name] if is_every else self.quick

    def shaders(self, is_every: bool) -> tuple[tuple[str, ...], tuple]:
        """Return encodings and packings."""
        return (tuple(ENCODINGS), EVERY_PACKING) if is_every else (self.encodings, self.packings)

    def rows(self, is_every: bool) -> list[dict]:
        """Return rows that are compiled, or taken from the cache."""
        encodings, packings = self.shaders(is_every)
        chosen = cost.cases([ENCODINGS[name] for name in encodings], packings, cost.OPERATIONS)
        families = list(self.families(is_every))
        return [row for row, _ in cost.isa_rows(chosen, list(self.stages), families, [], cost.nobody)]


def _intels_child_runs(patch: pytest.MonkeyPatch, code: str) -> None:
    script = INTELS_CHILD.format(variable=null_device.SAID, code=code)
    patch.setattr(isa_process, "CHILD", [sys.executable, "-c", script])


def _nvidias_child_runs(patch: pytest.MonkeyPatch, code: str) -> None:
    patch.setattr(isa, "python", lambda _: [sys.executable, "-c", f"import os, sys, time; {code}"])


def _another_gpu(family: str, words: str) -> Callable[[pytest.MonkeyPatch], None]:
    other = FAMILIES | {family: replace(FAMILIES[family], null_device=words)}
    return lambda patch: patch.setattr(isa, "FAMILIES", other)


def _another_build(patch: pytest.MonkeyPatch) -> None:
    patch.setattr(tools, "fingerprint", lambda path: f"another {path}")


INTEL = Vendor(
    "intel",
    quick=("hsw", "dg2"),
    stages=("fragment", "compute"),
    lanes=16,
    reader=intel_disassembly,
    zero=("instructions", "branches", "loops"),
    runs=_intels_child_runs,
    changes=_another_gpu("dg2", "0x1916 7 1 3 8 0"),
)
NVIDIA = Vendor(
    "nvidia",
    quick=("sm_86",),
    stages=("compute",),
    lanes=32,
    reader=sass,
    zero=("instructions", "branches", "loops", "stall_cycles", "vgprs", "code_bytes", "spills"),
    runs=_nvidias_child_runs,
    changes=_another_build,
)
VENDORS = (INTEL, NVIDIA)
