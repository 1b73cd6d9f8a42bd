"""Figures that ship with the package: they match new measurements."""

import pytest
from slowly import a_tenth
from test_recorded import assert_same_judgements

from normalbench.bench.measures.worst_case.recorded import supremum
from normalbench.bench.measures.worst_case.search import worst_case
from normalbench.bench.subjects.normals.normal_sets import NORMAL_SETS
from normalbench.bench.tables.mix.judge import judged_now, judgements
from normalbench.bench.tables.mix.table import USES
from tests.recorded import codecs, is_half


def name_of(value):
    return getattr(value, "name", value)


@pytest.mark.parametrize("codec", a_tenth(codecs()), ids=name_of)
def test_a_tenth_of_the_suprema_match_the_search(codec):
    worst, expected = supremum(codec, is_half(codec)), worst_case(codec, is_half(codec))
    assert worst.angle_deg == pytest.approx(expected.angle_deg, rel=1e-9)


@pytest.mark.parametrize("codec", a_tenth(codec for codec in codecs() if codec.storage.bits[0] < 32), ids=name_of)
def test_a_tenth_of_the_recorded_mixes_match_the_measurement(codec):
    """Errors of codes in 32-bit floats are rounding alone, which processors do differently."""
    asked = list(USES), NORMAL_SETS["sphere"](64, 0), codec.encoding.domain
    assert_same_judgements(judgements(codec, *asked), judged_now(codec, *asked))
