"""Subsurface scattering over scenes: more sample counts, pipelines and light buffers."""

from itertools import product

import pytest
import test_subsurface_slow

from normalbench.encodings.catalogue import LIGHT_BUFFERS

exact_light = test_subsurface_slow.exact_light

LINES = [(11, "columns"), (17, "rows"), (17, "columns"), (25, "rows")]


@pytest.mark.parametrize("samples, along", LINES)
def test_a_blurred_line_of_light_matches_more_kernels(gl, samples, along):
    test_subsurface_slow.test_a_blurred_line_of_light_matches_the_kernel(gl, samples, along)


BY_DAY = {("hybrid", "separable"), ("prepass", "gaussians"), ("inferred", "burley")}
OTHERS = sorted({*product(("hybrid", "prepass", "inferred"), test_subsurface_slow.METHODS)} - BY_DAY)


@pytest.mark.parametrize("pipeline, method", OTHERS)
def test_only_skin_changes_in_more_pipelines(gl, pipeline, method):
    test_subsurface_slow.test_only_skin_changes(gl, pipeline, method)


@pytest.mark.parametrize("light", sorted({*LIGHT_BUFFERS} - {"rgba32f", *test_subsurface_slow.LIGHTS}))
def test_light_is_read_in_more_encodings(gl, light, exact_light):
    test_subsurface_slow.test_light_is_read_in_every_encoding(gl, light, exact_light)
