"""Instructions by Mesa's r600 for the article's Radeons: what listings hold, and the device that is not there."""

import json
import re
from pathlib import Path

import pytest
from null_devices import NO_DEVICE, tried
from vendors import TERASCALE, every_or_some

from normalbench.bench.ground.options.gpu_families import CHOICES, FAMILIES
from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.keep.machine import require_terascale
from normalbench.bench.measures.metrics import published
from normalbench.bench.shaders.isa import isa, null_device
from normalbench.bench.shaders.isa.terascale import disassembly, driver

LISTINGS = Path(__file__).with_name("terascale_listings")
# By hand, line by line, of listings that Mesa 22.3.6 wrote: the kinds, then the slots and those of them that are t.
COUNTED = {
    "rv670-spheremap-encode": ({"other_alu": 4, "transcendental": 1, "memory": 1}, 8, 1),
    "cypress-spheremap-encode": ({"other_alu": 6, "transcendental": 1, "memory": 1}, 14, 1),
    "rv670-spherical_lut-decode": ({"other_alu": 6, "memory": 2}, 11, 2),
    "cypress-spherical_lut-decode": ({"other_alu": 7, "memory": 2}, 17, 0),
}
EVERY = ["cost", "--isa", "--format", "json", "--encoding", "spheremap", "--storage", "rgba8", "--stage", "fragment"]
BRANCH = """0000 00000004 A4000000  ALU_PUSH_BEFORE 1 @8
 0008 801F0000 80000000     1 x:  MP  PRED_SETNE_INT         __.x,  R0.x, 0
0002 00000006 82800001  JUMP @6
0004 0000000A A0000000  ALU 1 @10
 0010 80000400 00200C90     2 x:     MOV                    R1.x,  R0.y
0006 00000007 83800001  POP @7 POP:1
0008 C0000000 95200FC8  EXPORT_DONE        PIXEL 0     R0.xy__      ES:3 EOP
"""


@pytest.mark.parametrize("name", COUNTED)
def test_the_kinds_of_a_recorded_listing_are_those_counted_by_hand(name):
    expected, slots, in_t = COUNTED[name]
    counts = dict.fromkeys(disassembly.KINDS, 0) | expected
    assembly = (LISTINGS / f"{name}.asm").read_text()
    assert disassembly.count(assembly) == sum(counts.values())
    assert disassembly.kinds(assembly, sum(counts.values())) == counts
    assert disassembly.slots(assembly) == {"vliw_slots": slots, "t_slots": in_t}


def test_every_recorded_listing_is_counted():
    assert {path.stem for path in LISTINGS.iterdir()} == set(COUNTED)


def test_a_listing_that_is_not_understood_has_no_kinds():
    """Of an unknown instruction, and of a bundle more than the driver numbers."""
    assert disassembly.kinds(BRANCH, 5) and not disassembly.kinds(BRANCH, 4)
    assert disassembly.kinds(BRANCH.replace("EXPORT_DONE", "FROBNICATE"), 5) is None


def test_jumps_are_counted_and_starts_of_clauses_are_not():
    assert disassembly.count(BRANCH) == 5
    assert disassembly.kinds(BRANCH, 5) == {"other_alu": 2, "transcendental": 0, "memory": 1, "control_flow": 2}
    assert disassembly.jumps(BRANCH) == (1, 0)
    assert disassembly.jumps(BRANCH.replace("POP @7 POP:1", "LOOP_END @4")) == (1, 1)


def test_a_bundle_ends_where_its_last_operation_says_so():
    """The bit is the driver's own; without it two bundles are one."""
    assert [len(bundle) for bundle in disassembly.bundles(BRANCH)] == [1, 1]
    assert [len(bundle) for bundle in disassembly.bundles(BRANCH.replace("801F0000", "001F0000"))] == [2]


def test_the_chips_are_the_articles():
    titles = [FAMILIES[name].title for name in CHOICES["terascale"]]
    assert titles == ["Radeon HD 3870", "Radeon HD 5870"] and set(titles) < set(published.GPUS)


# Bundles to encode spheremap, by hand on the HD 3870 (the HD 5870 takes one more to interpolate n.z), to encode
# per_pixel_view, and to decode spherical.
BUNDLES = {"rv670": (5, 14, 11), "cypress": (6, 16, 12)}


@every_or_some("bench/shaders/cost/test_terascale.py::test_known_counts")
@pytest.mark.slow
def test_known_counts(vendor_rows, is_every):
    """Per-pixel view is cheaper than spherical, as in the article: bundles compute vectors at once, as ps_3_0 does; the
    order is not that of today's GPUs."""
    rows = vendor_rows(TERASCALE, is_every)
    found = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in rows}
    for chip in TERASCALE.families(is_every):
        encode = [found[name, "encode", chip] for name in ("xy", "spheremap", "per_pixel_view", "spherical")]
        assert encode == sorted(set(encode)), chip
    if {row["driver"] for row in rows} != {"Mesa 22.3.6"}:
        pytest.skip("counts hold for one Mesa")
    for chip in TERASCALE.families(is_every):
        counts = found["spheremap", "encode", chip], found["per_pixel_view", "encode", chip]
        assert (*counts, found["spherical", "decode", chip]) == BUNDLES[chip], chip


@every_or_some("bench/shaders/cost/test_terascale.py::test_a_bundle_has_at_most_five_operations")
def test_a_bundle_has_at_most_five_operations(vendor_rows, is_every):
    for row in vendor_rows(TERASCALE, is_every):
        assert row["t_slots"] <= row["vliw_slots"] <= 5 * row["issue_slots"] + 5, row


@pytest.mark.usefixtures("terascale", "own_cache")
def test_compute_shaders_are_left_out_and_alone_are_one_row_with_the_reason(run):
    status, out, _ = run(*EVERY[:-2], "--family", "rv670", "--stage", "fragment,compute")
    assert status == 0 and {(row["stage"], row["skipped"]) for row in json.loads(out)} == {("fragment", None)}
    status, out, _ = run(*EVERY[:-2], "--family", "rv670", "--stage", "compute")
    assert [row["skipped"] for row in json.loads(out) if row["family"]] == [
        "Radeon HD 3870: compute shaders are not counted; ask for --stage fragment"
    ]


@pytest.mark.usefixtures("terascale", "own_cache")
def test_a_machine_without_the_driver_says_what_to_install(run, monkeypatch):
    monkeypatch.setattr(driver, "FOLDERS", ())
    monkeypatch.delenv("LIBGL_DRIVERS_PATH", raising=False)
    driver.driver_file.cache_clear()
    isa.driver_file.cache_clear()
    try:
        with pytest.raises(MissingError, match="apt-get install libgl1-mesa-dri"):
            require_terascale()
        status, out, err = run(*EVERY, "--family", "cypress")
    finally:
        driver.driver_file.cache_clear()
        isa.driver_file.cache_clear()
    assert status == 3 and driver.NO_DRIVER in err and "instructions" in json.loads(out)[0]


@pytest.mark.usefixtures("terascale", "own_cache")
def test_the_null_device_answers_for_itself_alone():
    """It is radeon 2.50.0; DRM requests on other files and the opening of real devices are refused."""
    told = driver.variables(FAMILIES["cypress"].null_device)
    assert tried(told) == [0, NO_DEVICE, NO_DEVICE, [2, 50, 0]]
    assert re.fullmatch(r"null_radeon-\w{16}-\w{16}\.so", null_device.library(driver.SOURCE).name)
