"""Shaders as people write them: read, and meant the same in every language."""

import re

import pytest
from everyday import GLSL, WGSL
from languages import require_runner

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.subjects.codecs.names import codecs_named
from normalbench.bench.subjects.codecs.user_encodings import read_encoding
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.usefixtures("gl")


# Of the others Slang is given HLSL's text, and GLSL ES what OpenGL is given.
LANGUAGES = ["c"]


def codec_of(path):
    """A codec without a first look at its file."""
    return Codec(read_encoding(path), STORAGES["rg16"], "nearest")


def agrees(codec, language, folder):
    """What is wrong with a codec's file in a language; empty where nothing is."""
    code = code_of(codec, language, "p")
    (folder / code.name).write_text(code.body)
    found = agreement(codec, language, folder / code.name, code.interface)
    return "" if found.holds else f"{code.language}: {found.says}\n{code.body}"


@pytest.mark.parametrize("name", GLSL)
@pytest.mark.parametrize("language", LANGUAGES)
def test_everyday_glsl_is_read_and_means_the_same(language, name, tmp_path):
    """What OpenGL makes of the file itself is what each language makes of its translation."""
    require_runner(language)
    (tmp_path / "mine.glsl").write_text(GLSL[name])
    said = agrees(codec_of(tmp_path / "mine.glsl"), language, tmp_path)
    assert not said, said


@pytest.mark.parametrize("name", ["nested modulus", "nested choices of components"])
@pytest.mark.parametrize("language", ["c", "hlsl", "wgsl", "msl", "glsl"])
def test_text_grows_with_the_source_and_no_faster(language, name, tmp_path):
    """Nested forty times it is at most as many lines of usual length."""
    (tmp_path / "mine.glsl").write_text(GLSL[name])
    assert len(code_of(codec_of(tmp_path / "mine.glsl"), language, "p").body) < 20_000


@pytest.mark.parametrize("name", WGSL)
def test_everyday_wgsl_means_what_naga_makes_of_it(name, tmp_path):
    """The text as it was typed, compiled by naga and run by Vulkan, gives the texels of its translation by OpenGL."""
    require_runner("wgsl")
    (tmp_path / "mine.wgsl").write_text(WGSL[name])
    codec = codec_of(tmp_path / "mine.wgsl")
    code = code_of(codec_of_octahedral(), "wgsl", "p")
    body = re.sub(r"fn p_(en|de)code\(.*?\n}\n", "", code.body, flags=re.S)
    calls = "fn p_encode(n: vec3f) -> vec2f { return mine_encode(n); }\n"
    calls += "fn p_decode(e: vec2f) -> vec3f { return mine_decode(e); }\n"
    (tmp_path / code.name).write_text(WGSL[name] + body + calls)
    found = agreement(codec, "wgsl", tmp_path / code.name, code.interface)
    assert found.holds, found.says


def codec_of_octahedral():
    (codec,) = codecs_named("octahedral", "rg16", "nearest")
    return codec
