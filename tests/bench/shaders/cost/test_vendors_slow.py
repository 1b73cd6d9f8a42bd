"""Rules for every vendor's compiler: the identity costs nothing, kinds add up, rows are cached, and failures affect
only its own rows. Figures of a vendor are in the vendor's own file."""

import json

import pytest
from vendors import INSTRUCTIONS, INTEL, NVIDIA, VENDORS

from normalbench.bench.shaders.isa import isa
from normalbench.bench.shaders.isa import process as isa_process

named = pytest.mark.parametrize("vendor", VENDORS, ids=lambda vendor: vendor.name)


@named
def test_the_identity_costs_nothing(vendor_rows, vendor, is_every=False):
    rows = [row for row in vendor_rows(vendor, is_every) if row["encoding"] == "xyz"]
    assert len(rows) == 2 * len(vendor.stages) * len(vendor.families(is_every))
    for row in rows:
        assert {row[column] for column in (*vendor.zero, *vendor.reader.KINDS)} == {0}, row


@named
def test_kinds_add_up_to_the_compilers_own_count(vendor_rows, vendor, is_every=False):
    rows = vendor_rows(vendor, is_every)
    shaders = sum(map(len, vendor.shaders(is_every)))
    assert len(rows) == 2 * shaders * len(vendor.stages) * len(vendor.families(is_every))
    for row in rows:
        assert row["skipped"] is None and row["simd_width"] == vendor.lanes, row
        assert sum(row[kind] for kind in vendor.reader.KINDS) == row["instructions"] >= 0, row


@pytest.mark.usefixtures("own_cache")
@named
def test_cached_rows_match_and_another_gpu_or_build_causes_recompilation(request, run, monkeypatch, vendor):
    """The article's rows appear next to the compiler's."""
    request.getfixturevalue(vendor.name)
    asked = [*INSTRUCTIONS, "--stage", ",".join(vendor.stages), "--family", vendor.quick[-1], "--article"]
    first = run(*asked)
    rows = json.loads(first[1])
    assert first[0] == 0 and {row["measure"] for row in rows} == {"isa", "article"}
    of_compiler = [row for row in rows if row["measure"] == "isa"]
    assert len(of_compiler) == 6 * len(vendor.stages) and all(row["skipped"] is None for row in of_compiler)
    vendor.runs(monkeypatch, "sys.exit(1)")
    assert run(*asked) == first
    vendor.changes(monkeypatch)
    assert "status 1" in json.loads(run(*asked)[1])[0]["skipped"]


# A vendor's child processes are read by the same code; how each ends is seen of one, and all of a Radeon's.
FAILING = [
    (INTEL, "sys.exit('no GPU')", "status 1: no GPU"),
    (NVIDIA, "time.sleep(60)", "did not respond within"),
    (INTEL, "os.abort()", "SIGABRT"),
]


@pytest.mark.usefixtures("own_cache")
@pytest.mark.parametrize("vendor, code, reason", FAILING, ids=[f"{vendor.name}-{code}" for vendor, code, _ in FAILING])
def test_a_compiler_failure_loses_only_its_own_rows(request, run, monkeypatch, vendor, code, reason):
    request.getfixturevalue(vendor.name)
    vendor.runs(monkeypatch, code)
    monkeypatch.setattr(isa_process, "SECONDS", 8.0 if "sleep" in code else isa_process.SECONDS)
    isa._loaded.cache_clear()
    family, stages = vendor.quick[-1], ",".join(vendor.stages)
    status, out, err = run(*INSTRUCTIONS, "--stage", stages, "--family", f"navi21,{family}")
    isa._loaded.cache_clear()
    (lost,) = [row for row in json.loads(out) if row["skipped"]]
    assert status == 0 and lost["family"] == family and reason in lost["skipped"] and reason in err
    assert sum(row["family"] == "navi21" for row in json.loads(out)) == 6 * len(vendor.stages)
