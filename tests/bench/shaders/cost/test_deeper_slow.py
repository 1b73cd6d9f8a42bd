"""Facts from listings beyond counts: loops, waves and half-precision arithmetic."""

import pytest

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.shaders.isa import disassembly, isa, occupancy
from normalbench.bench.shaders.isa.compiler import uses_halves
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.variants import in_half

OCTAHEDRAL = ENCODINGS["octahedral"]


@pytest.mark.usefixtures("radv")
def test_polaris_and_vega_hold_as_many_waves_as_radv_reports():
    """For RDNA, RADV reports twice as many: the waves of two SIMDs."""
    prepared = cost.prepare(cost.cases([ENCODINGS["octahedral_precise"]], [], ["encode"])[0], "compute")
    for family, outcome in compiled(prepared.job, CHOICES["radeon"]).items():
        statistics = outcome.kernels[0].statistics
        twice = 1 if family in ("polaris10", "vega10") else 2
        assert statistics["Subgroups per SIMD"] == twice * occupancy.waves(family, statistics["VGPRs"]), family


def compiled(job, families) -> dict:
    return {family: outcome for (family, _), outcome in isa.compile_all([job], families, cost.nobody).items()}


@pytest.mark.usefixtures("radv")
def test_half_arithmetic_uses_packed_instructions_and_xyz_costs_nothing():
    rows = [
        row
        for row, _ in cost.isa_rows(
            cost.cases(map(in_half, (OCTAHEDRAL, ENCODINGS["xyz"])), [], ["encode", "decode"]),
            ["fragment", "compute"],
            ["vega10", "navi31"],
            [],
            cost.nobody,
        )
    ]
    assert len(rows) == 16 and not [row["skipped"] for row in rows if row["skipped"]]
    for row in rows:
        assert sum(row[kind] for kind in disassembly.KINDS) == row["instructions"]
        assert (row["instructions"] == 0) == (row["encoding"] == "xyz:arithmetic=half"), row
        assert (row["packed"] > 0) == (row["instructions"] > 0), row


@pytest.mark.usefixtures("radv")
def test_a_gpu_without_16_bit_arithmetic_is_reported_and_others_are_measured():
    prepared = cost.prepare(cost.cases([in_half(OCTAHEDRAL)], [], ["encode"])[0], "fragment")
    assert uses_halves(prepared.job.code) and not uses_halves(prepared.job.vertex)
    outcomes = compiled(prepared.job, ["polaris10", "vega10"])
    assert outcomes["polaris10"].reason == "Null hardware (RADV POLARIS10) does not support 16-bit shader arithmetic"
    assert outcomes["vega10"].kernels


@pytest.mark.usefixtures("nvidia")
def test_uncounted_half_arithmetic_is_skipped_with_a_reason():
    chosen = cost.cases([in_half(OCTAHEDRAL)], [], ["encode"])
    rows = [row for row, _ in cost.isa_rows(chosen, ["fragment", "compute"], ["sm_86"], [], cost.nobody)]
    reasons = {row["family"]: row["skipped"] for row in rows if row["family"]}
    assert reasons["sm_86"] == "octahedral:arithmetic=half encode: half arithmetic is not counted for NVIDIA"
