"""Instructions from Intel's compilers: listings, comparable kernels and the null device."""

from pathlib import Path

import pytest
from typed import chosen_families

from normalbench.bench.ground.options import gpu_families as families
from normalbench.bench.ground.options.gpu_families import FAMILIES
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.shaders.isa import intel_disassembly, null_device
from normalbench.bench.shaders.isa.isa import Compiled, Kernel
from normalbench.bench.tables.cost import extras
from normalbench.bench.tables.cost import measure as cost
from normalbench.bench.tables.registry import TABLES

LISTINGS = Path(__file__).with_name("listings")


# By hand, line by line, of listings that Mesa 22.3.6 wrote for 16 lanes.
COUNTED = {
    "hsw-spheremap-encode": {"other_alu": 16, "transcendental": 1, "scalar": 3, "memory": 3},
    "bdw-spheremap-encode": {"other_alu": 16, "transcendental": 1, "scalar": 3, "memory": 3},
    "skl-spheremap-encode": {"other_alu": 15, "transcendental": 1, "scalar": 3, "memory": 3},
    "tgl-spheremap-encode": {"other_alu": 23, "transcendental": 1, "scalar": 1, "memory": 3, "waiting": 3},
    "adl-spheremap-encode": {"other_alu": 23, "transcendental": 1, "scalar": 1, "memory": 3, "waiting": 3},
    "dg2-spheremap-encode": {"other_alu": 23, "transcendental": 1, "scalar": 1, "memory": 3, "waiting": 4},
    "hsw-12-12-pack": {"other_alu": 21, "conversion": 5, "scalar": 3, "memory": 3},
    "bdw-12-12-pack": {"other_alu": 21, "conversion": 5, "scalar": 3, "memory": 3},
    "skl-12-12-pack": {"other_alu": 20, "conversion": 5, "scalar": 3, "memory": 3},
    "tgl-12-12-pack": {"other_alu": 27, "conversion": 5, "scalar": 1, "memory": 3, "waiting": 3},
    "adl-12-12-pack": {"other_alu": 27, "conversion": 5, "scalar": 1, "memory": 3, "waiting": 3},
    "dg2-12-12-pack": {"other_alu": 27, "conversion": 5, "scalar": 1, "memory": 3, "waiting": 4},
    "skl-compute-xy-decode": {"other_alu": 23, "transcendental": 1, "memory": 14, "control_flow": 2},
}


@pytest.mark.parametrize("name", COUNTED)
def test_kinds_in_a_recorded_listing_match_the_count_by_hand(name):
    counts = dict.fromkeys(intel_disassembly.KINDS, 0) | COUNTED[name]
    assembly = (LISTINGS / f"{name}.asm").read_text()
    assert intel_disassembly.kinds(assembly, sum(counts.values())) == counts


def test_every_recorded_listing_is_counted():
    assert {path.stem for path in LISTINGS.iterdir()} == set(COUNTED)


@pytest.mark.parametrize(
    "line, kind",
    [
        ("mov(16)         g24<1>D         g22<8,8,1>F   { align1 1H };", "conversion"),
        ("mov.sat(8)      g24<1>HF        g22<8,8,1>F   { align1 1Q };", "conversion"),
        ("mov(8)          g24<1>F         g22<8,8,1>UB  { align1 1Q };", "conversion"),
        ("mov(16)         g5<1>D          g2<8,8,1>UW   { align1 1H };", "other_alu"),
        ("mov(16)         g5<1>F          0x3f800000F  /* 1F */ { align1 1H };", "other_alu"),
        ("mov(8)          g5<1>UD         g2<8,8,1>F    { align1 WE_all 1Q };", "conversion"),
        ("math pow(8)     g5<1>F          g2<8,8,1>F    g3<8,8,1>F { align1 1Q };", "transcendental"),
        ("mov(1)          g5<1>D          1090519040D   { align1 WE_all 1N };", "scalar"),
        ("(-f0.1.any16h) halt(16) JIP: LABEL1 UIP: LABEL2 { align1 1H };", "control_flow"),
        ("sync allrd(1)                   null<0,1,0>UB { align1 WE_all 1N };", "waiting"),
        ("send(8)         nullUD          g2UD          nullUD 0x0 { align1 1Q };", "memory"),
    ],
)
def test_an_instruction_has_the_expected_kind(line, kind):
    (instruction,) = intel_disassembly.instructions(line)
    assert intel_disassembly.kind(instruction) == kind


def test_a_listing_that_is_not_understood_has_no_kinds():
    """Examples are an unknown instruction and a count of instructions that differs from the driver's count."""
    text = "add(8) g1<1>F g2<8,8,1>F g3<8,8,1>F { align1 1Q };\n"
    assert intel_disassembly.kinds(text, 1) and not intel_disassembly.kinds(text, 2)
    assert intel_disassembly.kinds(text + text.replace("add", "frobnicate"), 2) is None


def test_a_mesa_version_that_does_not_count_waits_is_supported():
    text = "add(8) g1<1>F g2<8,8,1>F g3<8,8,1>F { align1 1Q };\nsync nop(1) null<0,1,0>UB { align1 };\nnop ;\n"
    with_waits, without = (intel_disassembly.kinds(text, total) for total in (2, 1))
    assert (with_waits["waiting"], without["waiting"], without["other_alu"]) == (1, 0, 1)


def test_loops_and_branches_are_counted():
    text = "(+f0.0) if(8) JIP: L { };\nelse(8) JIP: L { };\nendif(8) JIP: L { };\n(-f0.0) while(8) JIP: L { };\n"
    assert intel_disassembly.jumps(text) == (1, 1)


def kernel(width: int, spills: int = 0) -> Kernel:
    return Kernel(width, {"Instruction Count": 10 * width, "Spill Count": spills, "Fill Count": spills}, "")


def test_widest_kernel_without_spills_is_compared_at_its_own_width():
    empties = [kernel(8), kernel(16)]
    pairs = [
        cost.alike(kernels, empties)
        for kernels in (
            [kernel(8), kernel(16), kernel(32)],
            [kernel(8), kernel(16, 3)],
            [kernel(8, 1), kernel(16, 3)],
            [kernel(32)],
        )
    ]
    assert [pair and (pair[0].simd_width, pair[1].simd_width) for pair in pairs] == [(16, 16), (8, 8), (16, 16), None]


def test_kernels_without_a_common_width_have_no_counts():
    row = TABLES["cost"].empty() | {"family": "skl"}
    ours, empty = (Compiled("skl", "a device", "1.2.3", (kernel(width),)) for width in (8, 16))
    counts, _ = cost._figures(row, ours, empty)
    assert counts["instructions"] is None and counts["skipped"].startswith("compiled for 8 lanes, but the empty kernel")


def test_figures_use_the_drivers_names_and_radeon_columns_stay_empty():
    row = TABLES["cost"].empty() | {"family": "skl"}
    text = "add(16) g1<1>F g2<8,8,1>F g3<8,8,1>F { };\n"
    statistics = {"Instruction Count": 3, "Cycle Count": 40, "Spill Count": 2, "Fill Count": 1}
    ours = Compiled("skl", "a device", "1.2.3", (Kernel(16, statistics, 3 * text),))
    nothing = {"Instruction Count": 1, "Cycle Count": 9, "Spill Count": 0, "Fill Count": 0}
    counts, _ = cost._figures(row, ours, Compiled("skl", "a device", "1.2.3", (Kernel(16, nothing, text),)))
    assert (counts["instructions"], counts["other_alu"], counts["spills"], counts["kernel_latency"]) == (2, 2, 3, 40)
    assert counts["simd_width"] == 16
    for column in ("issue_slots", "full_rate", "quarter_rate", "vgprs", "sgprs", "code_bytes", "kernel_vgprs"):
        assert counts[column] is None, column


def test_vendor_names_select_their_families():
    assert chosen_families("intel") == ["hsw", "bdw", "skl", "tgl", "adl", "dg2"]
    assert chosen_families("AMD") == chosen_families("radeon") == list(FAMILIES)[:5]
    assert chosen_families("radeon,intel,skl") == list(FAMILIES)[:11]
    assert set(chosen_families("all")) >= set(chosen_families("radeon,intel"))
    with pytest.raises(UsageError, match=r"unknown family 'icl'.* known: all, polaris10, .*dg2, .*radeon, intel"):
        chosen_families("icl")


def test_page_uses_the_last_family_of_the_first_vendor():
    rows = [
        {"family": name, "stage": "fragment", "instructions": 3} for name in ("navi21", "navi31", "skl", "dg2", "new")
    ]
    assert extras.usual_family({"cost": rows}) == "navi31"
    assert extras.usual_family({"cost": rows[2:]}) == "dg2"
    assert extras.usual_family({}) == ""


def test_unwritable_cache_is_a_one_line_error(monkeypatch, tmp_path):
    (tmp_path / "file").write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    with pytest.raises(null_device.NullDeviceError, match="set XDG_CACHE_HOME to another folder") as error:
        null_device.library()
    assert not error.value.is_missing


def test_every_family_has_a_title_and_a_driver():
    for name, family in FAMILIES.items():
        assert family.library in families.TITLES and family.title and family.names, name
        assert (family.vendor in ("radeon", "nvidia")) == (not family.null_device), name
