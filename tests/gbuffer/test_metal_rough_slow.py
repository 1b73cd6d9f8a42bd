"""Metal/rough surfaces: against their formulas in float64, in every pipeline, through what a layout keeps of them."""

import pytest
import test_metal_rough


@pytest.mark.parametrize("roughness, metalness", [(0.25, 0.0), (0.75, 1.0)])
def test_more_lights_on_surfaces_are_those_of_the_formulas_in_float64(gl, roughness, metalness):
    test_metal_rough.test_lights_on_surfaces_are_those_of_the_formulas_in_float64(gl, roughness, metalness)
