"""Suprema by search: compared with geometry and with samples, and found within a time limit."""

import pytest
import test_worst_case_slow
from test_worst_case import codec_of

from normalbench.bench.measures.worst_case.search import worst_case

SEARCHED = [
    *(codec_of(name, "rg8") for name in ("spherical", "spheremap_classic", "cryengine3")),
    codec_of("spherical", "rg8_snorm", "truncate"),
    codec_of("octahedral", "rg16"),
    codec_of("equal_area_octahedral_precise", "rg8_snorm"),
]


@pytest.mark.parametrize("codec", SEARCHED, ids=lambda codec: codec.name)
def test_no_sample_of_other_codecs_is_worse(codec):
    test_worst_case_slow.test_no_sample_is_worse(codec)


def test_three_8_bit_numbers_are_worst_at_an_edge_of_a_cell():
    test_worst_case_slow.test_three_numbers_are_worst_at_an_edge_of_a_cell(8)


def test_the_worst_error_of_an_8_bit_lattice_is_its_covering_radius():
    test_worst_case_slow.test_the_worst_error_of_a_lattice_is_its_covering_radius(4)


@pytest.mark.parametrize(
    ("encoding", "where", "sup"),
    [("octahedral_precise", "rg8", 0.6354766834), ("equal_area_octahedral_precise", "rg8_snorm", 0.5839288567)],
)
def test_precise_rounding_of_other_codecs_matches_an_independent_search(encoding, where, sup):
    test_worst_case_slow.test_precise_rounding_matches_an_independent_search(encoding, where, sup)


def test_two_forms_of_one_map_have_one_supremum():
    """At the opposite pole one form computes 8 n.z + 8, which is only the rounding error of n.z. The search once
    found an error of 60 degrees at a distance of 1e-6 from the pole."""
    published, classic = (worst_case(codec_of(name, "rg16")) for name in ("spheremap", "spheremap_classic"))
    assert published.angle_deg == pytest.approx(classic.angle_deg, rel=1e-8)
    assert published.normal == pytest.approx(classic.normal, abs=1e-9)
