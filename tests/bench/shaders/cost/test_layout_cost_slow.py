"""Costs of packing and unpacking whole layouts: counted by hand, and zero for floats with every vendor's compiler."""

from functools import partial

import pytest

from normalbench.bench.shaders.code.whole.kernel import pack_operation, unpack_operation
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.layouts.layout import Layout
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.layouts.words import targets_of

# All numbers in floats of 32 bits: more of them than kernels of normals have.
EXACT = Layout(
    "exact",
    "floats",
    targets_of(
        "rgba32f: normal.x normal.y normal.z roughness; rgba32f: base_color metallic; "
        "rgba32f: f0 ao motion.x motion.y; rgba32f: emissive -"
    ),
    ENCODINGS["xyz"],
    "this project",
    space="world",
)


WORDS = Layout(
    "words",
    "fields of whole numbers",
    targets_of("r32_uint: normal.x:12 normal.y:12 roughness:8; srgb8_a8: base_color shading_model:4 other:4"),
    ENCODINGS["octahedral"],
    "this project",
    space="world",
)


def slots(layout: Layout, family: str) -> tuple[float, float]:
    """Return the slots of packing and unpacking on a family."""
    make = {"pack": pack_operation, "unpack": unpack_operation}
    chosen = [cost.CostCase(None, layout.name, name, partial(operation, layout)) for name, operation in make.items()]
    counts = cost.counted(chosen, family, "compute")
    return counts[layout.name, "pack"]["executed_slots"], counts[layout.name, "unpack"]["executed_slots"]


@pytest.mark.usefixtures("radv")
@pytest.mark.parametrize(
    ("layout", "packed", "unpacked"),
    [
        # Counted line by line in the listings that Mesa 22.3.6 wrote for navi21. Packing: the normal's bias 3,
        # reflectance 1, the 2 bits beside the normal 3, the byte of two halves 5, four bytes of others 8.
        # Unpacking: that byte 4, the bias 3, the length of the normal 11, reflectance 1, five whole numbers 10.
        (LAYOUTS["unreal4"], 20, 29),
        # Packing: octahedral 14, three numbers to whole ones 12, these to a word 3, the byte of two halves 5.
        # Unpacking: out of the word 3 and out of the byte 4, the normal's numbers 4, octahedral 16, roughness 2.
        (WORDS, 34, 29),
    ],
    ids=lambda value: getattr(value, "name", None),
)
def test_cost_of_a_layout_matches_the_count_by_hand(layout, packed, unpacked):
    assert slots(layout, "navi21") == (packed, unpacked)


def _costs_nothing(family: str) -> None:
    assert slots(EXACT, family) == (0, 0), family


@pytest.mark.usefixtures("radv")
@pytest.mark.parametrize("family", ["polaris10", "navi31"])
def test_floats_cost_nothing_on_radeons(family):
    """Even planes beyond the reach of an instruction's offset are free: the empty kernel computes them too."""
    _costs_nothing(family)


@pytest.mark.usefixtures("intel")
def test_floats_cost_nothing_on_intel():
    _costs_nothing("tgl")


@pytest.mark.usefixtures("nvidia")
def test_floats_cost_nothing_on_nvidia_and_integers_are_compiled():
    _costs_nothing("sm_86")
    # No fewer than a Radeon, whose instructions do as much: half of NVIDIA's rate are conversions and shifts.
    assert all(mine >= theirs for mine, theirs in zip(slots(WORDS, "sm_86"), (34, 29), strict=True))
