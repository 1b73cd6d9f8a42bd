"""Suprema that come with the package: those that the search finds now."""

import pytest
from slowly import a_tenth

from normalbench.bench.measures.worst_case import recorded
from normalbench.bench.measures.worst_case.search import worst_case
from tests.recorded_suprema import codecs


@pytest.mark.parametrize("codec, is_half", a_tenth(codecs()), ids=lambda value: getattr(value, "name", value))
def test_a_tenth_of_them_are_what_the_search_finds(codec, is_half):
    found, expected = recorded.supremum(codec, is_half), worst_case(codec, is_half)
    assert found.angle_deg == pytest.approx(expected.angle_deg, rel=1e-9)
