"""Everyday shaders of users, read and translated to every language with the same meaning."""

import re
from itertools import product

import pytest
from everyday import GLSL, WGSL
from languages import require_runner
from slowly import a_tenth
from test_everyday import LONGEST, NESTED, codec_of
from typed import codecs_named

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement

pytestmark = pytest.mark.usefixtures("gl")


# Of the others Slang is given HLSL's text, and GLSL ES what OpenGL is given.
LANGUAGES = ["c"]


def agrees(codec, language, folder):
    """Return the error in a codec's file in a language, or an empty string."""
    code = code_of(codec, language, "p")
    assert len(code.body) < LONGEST, f"{code.language}: {len(code.body)} letters, which grow faster than the source"
    (folder / code.name).write_text(code.body)
    verdict = agreement(codec, language, folder / code.name, code.interface)
    return "" if verdict.holds else f"{code.language}: {verdict.says}\n{code.body}"


@pytest.mark.drawn(3)
@pytest.mark.parametrize("name", GLSL)
@pytest.mark.parametrize("language", LANGUAGES)
def test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path):
    """Each language's translation gives the same results as the original file in OpenGL."""
    require_runner(language)
    (tmp_path / "mine.glsl").write_text(GLSL[name])
    wrong = agrees(codec_of(tmp_path / "mine.glsl"), language, tmp_path)
    assert not wrong, wrong


@pytest.mark.drawn(3)
@pytest.mark.parametrize("name", WGSL)
def test_everyday_wgsl_gives_the_same_texels_as_naga(name, tmp_path):
    """The original text, compiled by naga and run by Vulkan, gives the texels of its translation in OpenGL."""
    require_runner("wgsl")
    (tmp_path / "mine.wgsl").write_text(WGSL[name])
    codec = codec_of(tmp_path / "mine.wgsl")
    code = code_of(codec_of_octahedral(), "wgsl", "p")
    body = re.sub(r"fn p_(en|de)code\(.*?\n}\n", "", code.body, flags=re.S)
    calls = "fn p_encode(n: vec3f) -> vec2f { return mine_encode(n); }\n"
    calls += "fn p_decode(e: vec2f) -> vec3f { return mine_decode(e); }\n"
    (tmp_path / code.name).write_text(WGSL[name] + body + calls)
    verdict = agreement(codec, "wgsl", tmp_path / code.name, code.interface)
    assert verdict.holds, verdict.says


def codec_of_octahedral():
    (codec,) = codecs_named("octahedral", "rg16", "nearest")
    return codec


TWO = ["hlsl", "wgsl"]


OTHERS = [*product(TWO, [name for name in GLSL if name not in NESTED])]


@pytest.mark.parametrize("language, name", [*product(TWO, NESTED), *a_tenth(OTHERS)])
def test_everyday_glsl_is_read_and_means_the_same_in_hlsl_and_wgsl(language, name, tmp_path):
    test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path)
