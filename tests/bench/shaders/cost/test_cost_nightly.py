"""Costs of encodings on every family; test_cost_slow.py checks two families."""

import pytest
import test_cost_slow

from normalbench.bench.ground.options.gpu_families import CHOICES
from normalbench.gbuffer.defines.kernels import STAGES


@pytest.fixture(scope="session")
def every_family(radv, tmp_path_factory):  # noqa: ARG001 (asks for the compilers)
    """Every row of the default table, and its disassembly, from an empty cache."""
    return test_cost_slow.table_of(CHOICES["radeon"], tmp_path_factory.mktemp("cache"))


ASKED = [
    test_cost_slow.test_every_encoding_stage_and_family_has_its_row,
    test_cost_slow.test_the_kinds_add_up_to_the_drivers_own_count,
    test_cost_slow.test_no_kernel_computes_addresses,
    test_cost_slow.test_slots_match_the_drivers_model_for_pure_arithmetic,
    test_cost_slow.test_both_stages_have_the_same_spirv_count,
    test_cost_slow.test_spheremap_costs_the_articles_four_instructions_plus_three_for_its_pole,
    test_cost_slow.test_storages_cost_as_much_as_their_conversion,
    test_cost_slow.test_far_plane_is_not_computed_per_lane,
]


@pytest.mark.parametrize("ask", ASKED, ids=lambda ask: ask.__name__.removeprefix("test_"))
def test_rules_of_two_families_hold_for_every_family(every_family, ask):
    ask(every_family)


@pytest.mark.parametrize("stage", STAGES)
def test_known_orders_hold_in_all_families(every_family, stage):
    test_cost_slow.test_known_orders_hold_in_every_family(every_family, stage)
