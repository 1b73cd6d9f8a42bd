"""Generated code of whole layouts, compared with the renderer's own GLSL."""

from itertools import product

import pytest
import test_whole_layouts
import test_whole_layouts_slow
from languages import require_runner
from slowly import half
from test_whole_layouts import check_short
from test_whole_layouts_slow import FAST, IN_TURN, KINDS, MANY, OTHERS, TIES, many_agree

from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.gbuffer.layouts.presets import LAYOUTS

pytestmark = pytest.mark.usefixtures("gl")
layouts = test_whole_layouts.layouts


@pytest.mark.parametrize("name, language", half(product(TIES, FAST)))
def test_code_packs_a_million_surfaces_like_the_renderer(name, language, layouts):
    require_runner(language)
    many_agree(layouts[name], language, TIES[name], MANY)


@pytest.mark.parametrize("name, language", half(each for each in product(TIES, OTHERS) if each not in IN_TURN))
def test_code_packs_and_unpacks_like_the_renderer_in_every_language(name, language, layouts):
    test_whole_layouts_slow.test_code_packs_and_unpacks_like_the_renderer(name, language, layouts)


@pytest.mark.parametrize("name", [name for name in LAYOUTS if name not in KINDS])
def test_every_single_preset_is_written(name):
    test_whole_layouts_slow.test_every_preset_is_written(name)


@pytest.mark.parametrize("language", LANGUAGES)
def test_lines_and_names_of_every_layout_are_short(language, layouts):
    check_short(layouts.values(), language)
