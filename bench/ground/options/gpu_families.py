"""The GPU families that shaders are compiled for, and the compiler for each. Imports nothing heavy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

RADV, ANV, HASVK = "libvulkan_radeon", "libvulkan_intel", "libvulkan_intel_hasvk"
# NVIDIA's compiler of CUDA, which is given its own language and knows one kind of shader.
NVRTC = "libnvrtc"
FRAGMENT = "fragment"
# The family that answers quote.
USUAL = "navi21"


@dataclass(frozen=True)
class Family:
    """One generation of GPUs.

    Attributes:
        title: the name that people use.
        vendor: "radeon", "intel" or "nvidia", which is also the name for all families of the vendor.
        library: the driver that compiles for the family: a Vulkan driver, or NVRTC.
        names: the family's names in all versions of Mesa; the first name that the driver accepts is used.
        null_device: the description of an absent GPU that a driver is given, in the format of null_i915.c.
        stages: the shader stages whose instructions are counted.
    """

    title: str
    vendor: str
    library: str
    names: tuple[str, ...]
    null_device: str = ""
    stages: tuple[str, ...] = ("fragment", "compute")


def _radeon(title: str, *names: str) -> Family:
    return Family(title, "radeon", RADV, names)


def _intel(title: str, library: str, name: str, null_device: str) -> Family:
    return Family(title, "intel", library, (name,), null_device)


def _nvidia(title: str, name: str) -> Family:
    return Family(title, "nvidia", NVRTC, (name,), stages=("compute",))


# One for each generation, each vendor's oldest first. An Intel's words are PCI device, revision, slices, subslices of
# each, execution units of each, and whether it has memory of its own (Mesa's pci_ids, and its tables of devices).
FAMILIES: Mapping[str, Family] = MappingProxyType(
    {
        "polaris10": _radeon("Polaris", "polaris10"),
        "vega10": _radeon("Vega", "vega10"),
        "navi10": _radeon("Navi 1x", "navi10"),
        "navi21": _radeon("Navi 2x", "navi21"),
        "navi31": _radeon("Navi 3x", "navi31", "gfx1100"),
        "hsw": _intel("Haswell", HASVK, "hsw", "0x0412 6 1 2 10 0"),
        "bdw": _intel("Broadwell", HASVK, "bdw", "0x1616 9 1 3 8 0"),
        "skl": _intel("Skylake", ANV, "skl", "0x1912 6 1 3 8 0"),
        "tgl": _intel("Tiger Lake", ANV, "tgl", "0x9a49 1 1 6 16 0"),
        "adl": _intel("Alder Lake", ANV, "adl", "0x46a6 12 1 6 16 0"),
        "dg2": _intel("Arc A770", ANV, "dg2", "0x56a0 8 8 4 16 1"),
        "sm_75": _nvidia("Turing", "sm_75"),
        "sm_86": _nvidia("Ampere", "sm_86"),
        "sm_89": _nvidia("Ada", "sm_89"),
        "sm_90": _nvidia("Hopper", "sm_90"),
        "sm_100": _nvidia("Blackwell B200", "sm_100"),
        "sm_120": _nvidia("Blackwell", "sm_120"),
    }
)
VENDORS = tuple(dict.fromkeys(family.vendor for family in FAMILIES.values()))

# What a user may name: a family, or a vendor for all of its families.
CHOICES: Mapping[str, tuple[str, ...]] = MappingProxyType(
    {name: (name,) for name in FAMILIES}
    | {vendor: tuple(name for name, family in FAMILIES.items() if family.vendor == vendor) for vendor in VENDORS}
)
# What people call each driver.
TITLES = MappingProxyType(
    {
        RADV: "RADV",
        ANV: "Intel anv",
        HASVK: "Intel hasvk",
        NVRTC: "NVIDIA NVRTC",
    }
)


def usual_stage(family: str) -> str:
    """Return a family's usual stage: fragment shaders, or its first stage if fragment shaders are not counted."""
    stages = FAMILIES[family].stages if family in FAMILIES else (FRAGMENT,)
    return FRAGMENT if FRAGMENT in stages else stages[0]


def titled(vendor: str) -> str:
    """Return a vendor's families as text for help, such as "hsw (Haswell), bdw (Broadwell)"."""
    return ", ".join(f"{name} ({FAMILIES[name].title})" for name in CHOICES[vendor])
