"""Costs of the layouts of `budget`: bytes that passes fetch, and issue slots to pack and unpack."""

import json
import re

import pytest
from typed import attributes_held

from normalbench.bench.shaders.code.whole.kernel import pack_operation, unpack_operation
from normalbench.bench.tables.budget import cost
from normalbench.bench.tables.budget.bins import BINS
from normalbench.bench.tables.budget.sentences import told
from normalbench.bench.tables.budget.table import BudgetOptions


def test_every_code_has_a_kernel_for_every_target_that_holds_it():
    """This covers all that `--hold` can name; a code without a kernel would exceed every limit."""
    words = "shadow:8,custom:32,other:5,tangent,emissive,motion:packed"
    named = f"normal,base_color,roughness,metallic,f0,ao,shading_model:4,flags:4,{words}"
    held_all = attributes_held(named, BudgetOptions().speed)
    pairs = [(code, box) for held_one in held_all for code in held_one.codes for box in BINS.values() if box.need(code)]
    assert len(pairs) > 200
    for code, one in pairs:
        layout = cost.alone(code, one)
        assert pack_operation(layout).made == unpack_operation(layout).given, f"{code.name} in {one.name}"


# Few scenes, targets and kernels.
FEW_KINDS = ["budget", "--scene", "ramps", "--size", "64x48", "--bytes", "20", "--classes", "rough"]


FEW_KINDS += ["--no-fields", "--formats", "rgba8,srgb8_a8,rgb10a2,rg16f,rg8", "--format", "json"]


@pytest.mark.usefixtures("gl", "radv")
def test_rows_have_slots_of_the_emitted_code_and_bytes_of_decoding_passes(run):
    """The figures of unreal4 are counted by hand: see test_layout_cost."""
    status, out, err = run(*FEW_KINDS, "--against", "unreal4", "--readers", "1,normal+roughness")
    assert status == 0, err
    rows = {row["kind"]: row for row in json.loads(out)}
    proposal, mine = rows["proposal"], rows["mine"]
    assert [mine[name] for name in ("pack_slots", "unpack_slots", "slots")] == [20, 29, 1.5 * 20 + 29]
    assert mine["mb_1080p"] == pytest.approx(1920 * 1080 * (1.5 * 16 + 16 + 8) / 1e6)
    assert proposal["dearest_family"] == "navi21" and proposal["slots"] > 0
    text = next(sentence for sentence in told(proposal) if sentence.startswith("Packing takes"))
    assert text.endswith(f"{proposal['slots']:g} slots per pixel, written 1.5 times and read once in full.")


@pytest.mark.usefixtures("gl", "radv")
def test_the_answer_for_a_limit_has_at_most_a_dozen_lines(run, monkeypatch):
    """Lines have 80 columns; `-v` prints more of the same figures."""
    monkeypatch.setenv("COLUMNS", "80")
    (status, short, err), (_, verbose, _) = (run(*FEW_KINDS[:-2], *more) for more in ((), ("-v",)))
    assert status == 0 and short.count("\n") <= 12 < verbose.count("\n"), (short, err)
    (db,) = re.findall(r"bytes per pixel: .*?([0-9.]+) dB in the worst", short)
    assert f"{db} dB in the worst" in verbose and " to pack and " in short, (short, verbose)


@pytest.mark.usefixtures("gl", "radv")
def test_slot_limit_is_met_or_the_lowest_possible_limit_is_reported(run):
    status, _, err = run(*FEW_KINDS, "--most-instructions", "1")
    pattern = r"1 issue slots are too few: the cheapest .* takes (\d+) slots to pack and unpack"
    (least,) = map(int, re.findall(pattern, err))
    assert status != 0 and "Traceback" not in err, err
    status, out, err = run(*FEW_KINDS, "--most-instructions", str(least))
    (row,) = json.loads(out)
    assert status == 0 and row["pack_slots"] + row["unpack_slots"] <= least, err
