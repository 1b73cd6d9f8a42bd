"""Facts from listings beyond counts: loops, waves and half-precision arithmetic."""

import pytest

from normalbench.bench.ground.options.gpu_families import FAMILIES
from normalbench.bench.shaders.isa import disassembly, intel_disassembly, occupancy
from normalbench.bench.subjects.codecs.half.kernels import half_operation
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.variants import in_half
from normalbench.gbuffer.gl.shader import ShaderError


def test_code_between_a_label_and_a_jump_back_to_it_is_a_loop():
    """Both nested loops are found; a forward jump is not a loop."""
    lines = ["BB0:", "\tv_a", "\ts_cbranch_vccz BB4", "BB1:", "\tv_b", "BB2:", "\tv_c", "\t(then repeated 2 times)"]
    lines += ["\ts_cbranch_scc1 BB2", "\ts_branch BB1", "BB4:", "\ts_endpgm"]
    assert disassembly.loops("\n".join(lines)) == [range(3, 7), range(2, 8)]
    assert disassembly.loops("\n".join(lines[:-4])) == []


def test_intels_loops_end_with_while():
    add = "add(16)  g1<1>F  g2<8,8,1>F  g3<8,8,1>F  { align1 1H };"
    jump = "while(16)  JIP:  LABEL2  { align1 1H };"
    broken = "(+f0.0) break(16) JIP:  LABEL1        UIP:  LABEL1    { align1 1H };"
    listing = "\n".join([add, "LABEL2:", add, broken, add, "LABEL1:", jump, add])
    assert intel_disassembly.loops(listing) == [range(1, 5)]
    assert intel_disassembly.loops(listing.replace("while", "jmpi")) == []


@pytest.mark.parametrize(
    "family, registers, waves",
    # 256 / 84, 512 / 40, 768 / 48 by hand; few registers leave the most there is.
    [
        ("vega10", 84, 3),
        ("navi21", 40, 12),
        ("navi31", 48, 16),
        ("navi31", 96, 8),
        ("navi10", 16, 20),
        ("skl", None, 7),
    ],
)
def test_waves_follow_the_registers_up_to_the_limit_of_a_simd(family, registers, waves):
    assert occupancy.waves(family, registers) == waves


def test_waves_are_unknown_without_a_rule_or_registers():
    assert set(occupancy.OCCUPANCY) <= set(FAMILIES)
    assert occupancy.waves("another", 16) is None and occupancy.waves("navi21", None) is None


def test_precise_rounding_in_half_precision_is_refused_with_a_reason():
    with pytest.raises(ShaderError, match=r"octahedral_precise.*: precise rounding is not counted in half arithmetic"):
        half_operation(in_half(ENCODINGS["octahedral_precise"]), "encode")
