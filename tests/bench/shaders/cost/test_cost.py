"""Costs of encodings: exact subtraction, repeatable counts and failures."""

import itertools
from pathlib import Path

import pytest

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.bench.measures.metrics import published
from normalbench.bench.shaders.isa import isa
from normalbench.bench.shaders.isa.disassembly import issue_slots, kind, kinds
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.cost import sheets as cost_sheets
from normalbench.bench.tables.cost import work
from normalbench.bench.tables.registry import TABLES
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines import kernels


def test_article_figures_are_complete():
    rows = cost_sheets.article_rows(ENCODINGS, cost.OPERATIONS)
    assert len(rows) == len(published.PSNR_DB) * 2 * (1 + len(published.GPUS))
    assert set(published.SLOTS) == set(published.CYCLES) == set(itertools.product(published.PSNR_DB, cost.OPERATIONS))
    slots = {(r["encoding"], r["operation"]): r["instructions"] for r in rows if not r["device"]}
    # The article's own summary table.
    names = ("xy", "spherical", "spheremap", "stereographic", "per_pixel_view")
    assert [slots[name, "encode"] for name in names] == [1, 26, 4, 5, 17]
    assert [slots[name, "decode"] for name in names] == [8, 18, 9, 8, 22]
    cycles = {(r["encoding"], r["operation"], r["device"]): r["cycles"] for r in rows}
    assert [cycles[name, "encode", "GeForce 8800GTX"] for name in names] == [7, 43, 12, 12, 24]
    assert [cycles[name, "decode", "Radeon HD 2400"] for name in names] == [1, 17, 3, 4, 11]


@pytest.mark.parametrize(
    "name, expected",
    [
        ("v_fma_f32", "full_rate"),
        ("v_mul_u32_u24_e32", "full_rate"),
        ("v_mul_hi_u32_u24_e32", "full_rate"),
        ("v_mul_lo_u16_e32", "full_rate"),
        ("v_cvt_f32_ubyte1_e32", "full_rate"),
        ("v_cvt_pkrtz_f16_f32_e64", "full_rate"),
        ("v_cvt_u32_f32_sdwa", "conversion"),
        ("v_cvt_f16_f32_e32", "conversion"),
        ("v_rcp_iflag_f32_e32", "transcendental"),
        ("v_sqrt_f32_e32", "transcendental"),
        ("v_sin_f32_e32", "transcendental"),
        ("v_log_f32_e32", "transcendental"),
        ("v_exp_f32_e32", "transcendental"),
        ("v_mul_hi_u32", "quarter_rate"),
        ("v_mul_hi_i32", "quarter_rate"),
        ("v_mad_u64_u32", "quarter_rate"),
        ("v_dual_mul_f32", "full_rate"),
        ("v_rsq_f32_e64", "transcendental"),
        ("v_s_rcp_f32", "transcendental"),
        ("v_mul_lo_u32", "quarter_rate"),
        ("s_and_b64", "scalar"),
        ("s_load_dwordx4", "memory"),
        ("v_interp_p1_f32_e32", "memory"),
        ("exp", "memory"),
        ("image_load", "memory"),
        ("s_waitcnt", "waiting"),
        ("s_endpgm", "waiting"),
    ],
)
def test_instructions_have_the_expected_kind(name, expected):
    assert kind(name) == expected


def test_invalid_listing_has_no_kinds():
    assert kinds("(no disassembler)\n", 3) is None
    assert kinds("BB0:\n\tv_mov_b32 v0, v1\n\tmystery v0\n", 2) is None
    assert kinds("BB0:\n\tv_mov_b32 v0, v1  ; 7e\n\ts_endpgm\n", 2)["full_rate"] == 1


def test_repeated_instructions_are_counted_each_time():
    text = "BB0:\n\tv_rcp_f32 v0, v0\n\tv_mul_f32 v4, v4, v4\n\t(then repeated 2 times)\n\ts_endpgm\n"
    counts = kinds(text, 5)
    assert counts and (counts["full_rate"], counts["transcendental"], counts["waiting"]) == (3, 1, 1)


def test_fused_multiply_adds_are_slow_only_on_polaris():
    assert [kind("v_fma_f32", family) for family in CHOICES["radeon"]] == ["quarter_rate", *["full_rate"] * 4]


def test_doubles_have_no_kind():
    with pytest.raises(ValueError, match="v_add_f64 computes in 64-bit floats"):
        kind("v_add_f64")


@pytest.mark.parametrize(
    "family, slots",
    [("polaris10", 61), ("vega10", 61), ("navi10", 20), ("navi21", 20), ("navi31", 20), ("another", None)],
)
def test_issue_slots_follow_the_familys_rates(family, slots):
    """Scalar, memory and waiting instructions take no slots."""
    counts = {"full_rate": 5, "conversion": 2, "quarter_rate": 3, "transcendental": 9, "scalar": 7, "memory": 11}
    expected = slots if slots is None else {61: 5 + 4 * (2 + 3 + 9), 20: 5 + 2 + 4 * 3 + 9}[slots]
    assert issue_slots({**counts, "waiting": 13}, family) == expected


def made(assembly: str, **statistics: float) -> isa.Compiled:
    names = {name.replace("_", " "): value for name, value in statistics.items()}
    kernel = isa.Kernel(64, {"Instructions": 2, "Code size": 8, **names}, assembly)
    return isa.Compiled("navi21", "a device", "1.2.3", (kernel,))


def test_spills_include_both_kinds_of_register():
    few = {"VGPRs": 8, "SGPRs": 16, "Spilled_VGPRs": 1, "Spilled_SGPRs": 2}
    many = few | {"Spilled_VGPRs": 4, "Spilled_SGPRs": 7, "VGPRs": 12}
    row = TABLES["cost"].empty() | {"family": "navi21"}
    text = "BB0:\n\tv_mov_b32 v0, v1\n\ts_endpgm\n"
    figures, _ = cost._figures(row, made(text, **many), made(text, **few))
    assert (figures["spills"], figures["vgprs"], figures["sgprs"], figures["kernel_vgprs"]) == (8, 4, 0, 12)


def test_the_runners_do_not_list_encodings_by_name():
    """The whole catalogue is measured: no encoding is listed by hand."""
    for module in (cost, work, isa, kernels):
        text = Path(module.__file__).read_text()
        assert not [name for name in ENCODINGS if f'"{name}"' in text and name not in ("xy", "xyz")], module.__name__
