"""Instructions on GPUs of phones and small boards: what listings hold, and the device that is not there."""

import json
from pathlib import Path

import pytest
from null_devices import NO_DEVICE, tried

from normalbench.bench.ground.options.gpu_families import CHOICES, FAMILIES, MOBILE
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.keep.machine import require_mobile
from normalbench.bench.shaders.isa import driver_files, isa
from normalbench.bench.shaders.isa.mobile import driver, ir3_disassembly, qpu_disassembly
from normalbench.bench.tables.cost import measure as cost
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.defines.kernels import STAGES
from normalbench.gbuffer.defines.packings import PACKINGS

LISTINGS = Path(__file__).with_name("mobile_listings")
# By hand, line by line, of listings that Mesa 22.3.6 wrote.
COUNTED = {
    "a630-spheremap-encode": {"other_alu": 13, "transcendental": 1, "control_flow": 1, "waiting": 10},
    "a630-spheremap-decode": {"other_alu": 14, "transcendental": 1, "control_flow": 1, "waiting": 14},
    "a650-octahedral-encode": {"other_alu": 21, "transcendental": 1, "control_flow": 1, "waiting": 16},
    "v3d42-spheremap-encode": {"other_alu": 14, "transcendental": 1, "memory": 8},
    "v3d42-spheremap-decode": {"other_alu": 16, "transcendental": 2, "memory": 9},
}
OPERATIONS = {"v3d42-spheremap-encode": 31, "v3d42-spheremap-decode": 32}
EVERY = ["cost", "--isa", "--format", "json", "--encoding", "spheremap", "--storage", "rgba8", "--stage", "fragment"]


@pytest.fixture(autouse=True)
def nothing_remembered():
    """Which drivers there are is asked anew before each test and after it."""
    driver_files.driver_file.cache_clear()
    yield
    driver_files.driver_file.cache_clear()


@pytest.mark.parametrize("name", COUNTED)
def test_the_kinds_of_a_recorded_listing_are_those_counted_by_hand(name):
    read = cost.READERS[FAMILIES[name.split("-")[0]].vendor]
    counts = dict.fromkeys(read.KINDS, 0) | COUNTED[name]
    assembly = (LISTINGS / f"{name}.asm").read_text()
    assert read.kinds(assembly, sum(counts.values())) == counts
    assert read.kinds(assembly, sum(counts.values()) + 1) is None
    assert read.jumps(assembly) == (0, 0)


@pytest.mark.parametrize("name", OPERATIONS)
def test_the_operations_of_a_recorded_listing_are_those_counted_by_hand(name):
    assert qpu_disassembly.slots((LISTINGS / f"{name}.asm").read_text()) == {"vliw_slots": OPERATIONS[name]}


def test_every_recorded_listing_is_counted():
    assert {path.stem for path in LISTINGS.iterdir()} == set(COUNTED)


@pytest.mark.parametrize(
    "line, kind, total",
    [
        ("(sy)(ss)cov.u32f32 r0.x, r1.x", "conversion", 1),
        ("(rpt2)mov.f32f32 r0.x, (r)r1.x", "other_alu", 3),
        ("sam (f32)(xy)r0.x, r0.x, s#0, t#0", "memory", 1),
        ("stib.b.untyped.1d.u32.1.imm r0.x, r1.x, 0", "memory", 1),
        ("hrsq hr0.x, hr0.y", "transcendental", 1),
        ("br !p0.x, #l9", "control_flow", 1),
        ("(rpt5)nop", "waiting", 6),
    ],
)
def test_a_line_of_ir3_has_its_kind(line, kind, total):
    counts = ir3_disassembly.kinds(line, total)
    assert counts and counts[kind] == total, counts


@pytest.mark.parametrize(
    "line, kind",
    [
        ("nop                           ; nop                         ; thrsw", "waiting"),
        ("nop                           ; nop                         ; ldvary.r0", "memory"),
        ("ftoin r0, r1                  ; fmul r1, r2, r3", "conversion"),
        ("recip rf9, rf8                ; nop                         ; thrsw", "transcendental"),
        ("mov tmua, r0                  ; nop", "memory"),
        ("b.anya  -80", "control_flow"),
    ],
)
def test_a_line_of_v3d_has_its_kind(line, kind):
    counts = qpu_disassembly.kinds(line, 1)
    assert counts and counts[kind] == 1, counts


def test_jumps_ahead_and_back_are_told_apart():
    ahead, back = "br p0.x, #l2\nadd.f r0.x, r0.x, r0.y\nl2:\nend\n", "l1:\nadd.f r0.x, r0.x, r0.y\nbr p0.x, #l1\nend\n"
    assert (ir3_disassembly.jumps(ahead), ir3_disassembly.jumps(back)) == ((1, 0), (0, 1))
    assert qpu_disassembly.jumps("b.anya  64\nb  -80\n") == (1, 1)


def test_a_listing_that_is_not_understood_has_no_kinds():
    assert ir3_disassembly.kinds("frobnicate r0.x, r0.y", 1) is None
    assert qpu_disassembly.kinds("frobnicate r0, r1 ; nop", 1) is None


def test_mobile_stands_for_both_vendors():
    assert CHOICES["mobile"] == CHOICES["qualcomm"] + CHOICES["broadcom"] == ("a630", "a650", "a660", "v3d42")
    assert FAMILIES["a660"].null_device == "msm 660 0x060600ff"


@pytest.mark.usefixtures("radv", "own_cache")
def test_without_a_build_the_rows_say_how_to_build(run, monkeypatch):
    monkeypatch.delenv(driver.VARIABLE, raising=False)
    monkeypatch.setattr(driver_files, "_descriptions", lambda: iter(()))
    status, out, err = run(*EVERY, "--family", "mobile")
    assert status == 3 and "python -m tests.build_mesa DIR" in err
    assert {row["skipped"] for row in json.loads(out) if row["skipped"]} == set(map(driver_files.no_driver, MOBILE))
    with pytest.raises(MissingError, match=r"no Qualcomm turnip: .*; no Broadcom v3dv: .*build_mesa"):
        require_mobile()


@pytest.mark.usefixtures("intel", "own_cache")
@pytest.mark.parametrize("family, version", [("a630", [1, 9, 0]), ("v3d42", [1, 0, 0])])
def test_the_null_device_answers_for_itself_alone(family, version):
    told = driver.variables(FAMILIES[family].null_device)
    assert tried(told) == [0, NO_DEVICE, NO_DEVICE, version]


@pytest.fixture
def built():
    """A build of the user's; the tests that need one are skipped on other machines."""
    if any(isa.missing(library) for library in MOBILE):
        pytest.skip("Mesa's mobile drivers are not built here")


@pytest.mark.usefixtures("built", "own_cache")
def test_every_encoding_and_packing_is_counted():
    """With kinds that add up wherever the driver lists its code: all but v3dv's compute shaders."""
    packings = list(dict.fromkeys(packing for several in PACKINGS.values() for packing in several))
    chosen = cost.cases(ENCODINGS.values(), packings, cost.OPERATIONS)
    rows = [row for row, _ in cost.isa_rows(chosen, list(STAGES), CHOICES["mobile"], [], cost.nobody)]
    assert len(rows) == len(chosen) * len(STAGES) * 4
    for row in rows:
        assert row["skipped"] is None and row["instructions"] >= 0, row
        if (row["family"], row["stage"]) != ("v3d42", "compute"):
            assert sum(row[kind] for kind in cost.READERS[FAMILIES[row["family"]].vendor].KINDS) == row["instructions"]
        if row["encoding"] == "xyz":
            assert row["instructions"] == 0, row
