"""Encoding costs without a compiler: counts that were recorded elsewhere."""

import random

import pytest

from normalbench.bench.shaders.isa import isa, spirv
from normalbench.bench.tables.cost import measure, recorded
from normalbench.bench.tables.pick.measure import SURVEYED
from tests.recorded_costs import cases

STALE = "its GLSL is not what was counted; run python -m tests.recorded_costs"


def test_every_operation_in_the_catalogue_has_a_current_recorded_count():
    chosen = cases()
    for family in SURVEYED:
        names = {case.name for case, _ in recorded.recorded(chosen, family, "fragment")}
        assert {case.name for case in chosen} == names, STALE


def test_an_operation_with_changed_glsl_has_no_recorded_count(monkeypatch):
    """The other operations keep their counts."""
    chosen = cases()[:3]
    kept = recorded._kept()
    other = kept | {"sources": kept["sources"] | {chosen[1].name: "0" * 16}}
    monkeypatch.setattr(recorded, "_kept", lambda: other)
    assert [case for case, _ in recorded.recorded(chosen, "navi21", "fragment")] == [chosen[0], chosen[2]]


@pytest.mark.parametrize("family", ["navi21", "tgl"])
def test_twenty_recorded_counts_match_the_compilers_here(family):
    if spirv.version(spirv.COMPILER) is None or isa.missing():
        pytest.skip("no compilers")
    chosen = random.Random(52).sample(cases(), 20)
    here = measure.counted(chosen, family, "fragment").values()
    rows = {(row["encoding"] or row["storage"], row["operation"]): row for row in here}
    for case, row in recorded.recorded(chosen, family, "fragment"):
        now = rows[case.encoding.name if case.encoding else case.storage, case.operation]
        if now["driver"] not in row["recorded_by"]:
            pytest.skip(f"{now['driver']} is not the driver that counted them, {row['recorded_by']}")
        counts = {column: row[column] for column in recorded.COLUMNS}
        assert {column: now[column] for column in counts} == counts, case.name
