"""Rows that the C compiler's code measures: those of XLA's code, whatever the set and the decodes are like."""

from dataclasses import replace

import pytest
import test_native_rows
from slowly import a_tenth
from test_native_rows import BY_XLA

from normalbench.bench.ground.native import library
from normalbench.bench.subjects.normals.normal_sets import CHUNK, sphere
from normalbench.bench.tables.quality import measure as quality
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.skipif(not library.compiler(), reason="no C compiler")


def test_a_row_of_a_large_set_says_who_compiled_it(monkeypatch):
    """And has the same figures as one that XLA compiled, whether measured alone or with others, in parts or not."""
    codecs = [Codec(ENCODINGS[name], STORAGES["rgba8"]) for name in ("octahedral", "best_fit")]
    normals = sphere(5 * CHUNK)
    monkeypatch.setattr(quality, "LARGE", 1)
    cases = quality.cases(codecs, [normals], ["jax"])
    rows = [*quality.rows(cases, lambda _: None)]
    assert [row["compiled_by"] for row in rows] == [library.compiler(), "XLA"]
    assert rows == [quality.measure(case) for case in cases]
    halves = [replaced(cases[0], range(4)), replaced(cases[0], range(4, 5))]
    assert quality.merged(cases[0], [quality.measure(half) for half in halves]) == rows[0]
    other = quality.measure(halves[1]) | {"compiled_by": "XLA"}
    assert quality.merged(cases[0], [quality.measure(halves[0]), other])["compiled_by"] == f"{library.compiler()}; XLA"
    monkeypatch.setattr(quality, "LARGE", 2**40)
    usual = quality.measure(cases[0])
    assert usual["compiled_by"] == "XLA" and usual["psnr_db"] == pytest.approx(rows[0]["psnr_db"], abs=1e-6)


def replaced(case, chunks: range):
    return replace(case, normal_set=replace(case.normal_set, of=chunks))


NATIVE = sorted(set(ENCODINGS) - BY_XLA)


@pytest.mark.parametrize("name", a_tenth(NATIVE))
def test_rows_are_those_of_xla_in_a_second_format(name):
    test_native_rows.test_rows_are_those_of_xla(name, 1)
