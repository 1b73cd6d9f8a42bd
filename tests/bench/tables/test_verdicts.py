"""Table verdicts: ties, bit counts that gain nothing, names, and a verdict for every table of a run."""

import pytest

from normalbench.bench.tables.registry import TABLES
from normalbench.bench.tables.table import Group
from normalbench.bench.tables.verdicts import TIE, alternatives, best_by_bits, by_bits, codecs, listed


def row(encoding: str, storage: str, bits: int, error: float) -> dict:
    return {"encoding": encoding, "storage": storage, "bits": bits, "error": error}


ROWS = [
    row("spherical", "rg8", 16, 0.5),
    row("octahedral", "rg8", 16, 0.3 * TIE * 0.999),
    row("octahedral_precise", "rg8", 16, 0.3),
    row("xy_sign", "rg8", 17, 0.31),
    row("octahedral", "rgb10a2", 20, 0.1),
    row("spheremap", "rgb10a2", 20, 0.1 * TIE * 1.001),
]


def test_results_within_half_a_decibel_tie_and_useless_extra_bits_are_omitted():
    names = [[tied["encoding"] for tied in group] for group in best_by_bits(ROWS, "error")]
    assert names == [["octahedral_precise", "octahedral"], ["octahedral"]]


def test_a_sentence_lists_each_bit_count_once():
    text = by_bits(ROWS, "error", lambda row: f"{row['error']:.2g}°")
    assert text == "octahedral_precise or octahedral in rg8 at 16 bits (0.3°), octahedral in rgb10a2 at 20 bits (0.1°)"


@pytest.mark.parametrize(
    ("names", "said"),
    [(["a"], "a"), (["a", "b", "a"], "a or b"), (["a", "b", "c"], "a, b or c"), ([*"abcd"], "a or 3 others that tie")],
)
def test_tied_names_are_listed(names, said):
    assert alternatives(names) == said


def test_codecs_in_several_storages_are_listed_with_their_storages():
    rows = [row("xyz", "rgba8", 24, 0.1), row("octahedral", "rg16", 32, 0.1) | {"rounding": "truncate"}]
    assert codecs(rows, listed) == "xyz in rgba8 and octahedral in rg16 (truncate)"


@pytest.mark.parametrize(
    "name", [name for name, table in TABLES.items() if table.in_all and table.group != Group.ANSWER]
)
def test_every_table_of_a_run_has_a_verdict_unless_it_has_no_rows(name):
    work = TABLES[name].work
    assert work.verdict.__name__ == "_verdict", f"{name} has no verdict, which run prints"
    assert list(work.verdict([])) == []
