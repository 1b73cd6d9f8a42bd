"""Code of whole layouts: it packs and unpacks what the renderer's own GLSL does."""

from itertools import product

import pytest
import test_whole_layouts
import test_whole_layouts_slow
from test_whole_layouts import FAST, TIES

pytestmark = pytest.mark.usefixtures("gl")
layouts = test_whole_layouts.layouts


@pytest.mark.parametrize("name, language", [*product(TIES, FAST)])
def test_a_million_surfaces_are_packed_as_the_renderer_packs_them_in_any_layout(name, language, layouts):
    test_whole_layouts_slow.test_a_million_surfaces_are_packed_as_the_renderer_packs_them(name, language, layouts)
