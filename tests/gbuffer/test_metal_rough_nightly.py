"""Metallic-roughness surfaces, compared with their formulas in float64, in every pipeline and in several layouts."""

from __future__ import annotations

import pytest
import test_metal_rough_slow

REST = [(0.1, 0.0), (0.25, 1.0), (0.5, 0.0), (0.5, 1.0), (0.75, 0.0), (1.0, 1.0)]


@pytest.mark.parametrize("roughness, metalness", REST)
def test_the_light_on_all_surfaces_matches_the_formulas_in_float64(gl, roughness, metalness):
    test_metal_rough_slow.test_the_light_on_surfaces_matches_the_formulas_in_float64(gl, roughness, metalness)
