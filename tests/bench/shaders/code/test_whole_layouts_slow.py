"""Code of whole layouts: it packs and unpacks what the renderer's own GLSL does."""

from itertools import product

import pytest
import test_whole_layouts
from languages import require_runner
from slowly import a_tenth
from test_whole_layouts import FAST, FEW, MANY, TIES

from normalbench.bench.shaders.code.whole.emit import gbuffer_code
from normalbench.bench.shaders.code.whole.run import RUNS
from normalbench.bench.shaders.code.whole.verify import agreement
from normalbench.gbuffer.layouts.presets import LAYOUTS

pytestmark = pytest.mark.usefixtures("gl")
layouts = test_whole_layouts.layouts


OTHERS = [language for language in RUNS if language not in FAST]
# Each layout in another language than the one before.
IN_TURN = [(name, OTHERS[turn % len(OTHERS)]) for turn, name in enumerate(TIES)]


@pytest.mark.parametrize("name, language", IN_TURN)
def test_it_packs_and_unpacks_as_the_renderer_does_in_any_language(name, language, layouts):
    test_whole_layouts.test_it_packs_and_unpacks_as_the_renderer_does(name, language, layouts)


@pytest.mark.parametrize("name, language", a_tenth(product(TIES, FAST)))
def test_many_surfaces_are_packed_as_the_renderer_packs_them(name, language, layouts):
    """None differs where no curve has a power; else a few do, by a step where they lie next to a tie."""
    require_runner(language)
    many_agree(layouts[name], language, TIES[name], MANY // 5)


def many_agree(layout, language, share, count) -> None:
    """Of many surfaces no more than a share differs."""
    result = agreement(gbuffer_code(layout, language), count, seed=1)
    assert result.holds, result.says
    assert result.differing <= share * count, result.says


# Of each kind of code one at every landing: tables, words, and a sign beside another number.
KINDS = ("cryengine3", "unreal5_substrate_22", "volo")


@pytest.mark.parametrize("name", [*KINDS, *a_tenth(name for name in LAYOUTS if name not in KINDS)])
def test_every_preset_is_written(name):
    """In C: what the renderer's own GLSL writes and reads."""
    require_runner("c")
    assert (found := agreement(gbuffer_code(LAYOUTS[name], "c"), FEW)).holds, found.says
