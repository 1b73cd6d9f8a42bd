"""Ambient occlusion with other closed forms and other pipelines."""

import pytest
import test_ambient_occlusion_slow
from occluded import SOLID


@pytest.mark.parametrize("name", [name for name in SOLID if name not in test_ambient_occlusion_slow.FORMS])
def test_gtao_matches_other_closed_forms(gl, name):
    test_ambient_occlusion_slow.test_gtao_matches_the_closed_form(gl, name)


OTHERS = [(pipeline, {"full": "half", "half": "full"}[size]) for pipeline, size in test_ambient_occlusion_slow.PIPED]


@pytest.mark.parametrize("pipeline, size", OTHERS)
def test_ambient_light_is_multiplied_by_the_visibility_in_other_sizes(gl, pipeline, size):
    test_ambient_occlusion_slow.test_ambient_light_is_multiplied_by_the_visibility(gl, pipeline, size)
