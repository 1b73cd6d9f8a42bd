"""Code of every codec as an engine programmer would paste it: short names and lines, and loops over tables unrolled."""

import re

import pytest
from pasted import LONGEST, loops_without_unrolling, names_in
from typed import codecs_named, codecs_of_kind

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.fold import WIDTH
from normalbench.encodings.catalogue import BY_KIND
from normalbench.encodings.kinds import KINDS, NORMAL
from normalbench.encodings.storages.storage import (
    STORAGES,
)

QUICK = ("hlsl", "c")


def codecs_of(kind, name, storages):
    """Return an encoding's codecs in the given storages that fit it."""
    if kind is NORMAL:
        codecs = [codec for codec in codecs_named(name, storages, "nearest") if codec.fits]
        return codecs or [codec for codec in codecs_named(name, ",".join(STORAGES), "nearest") if codec.fits][:1]
    codecs = codecs_of_kind(kind, name, storages, ["nearest"])
    return [codec for codec in codecs if not (codec.misfit or getattr(codec.storage, "curved", 0))]


def check(codecs, languages) -> None:
    """Check every name, line and loop of the codecs' code."""
    assert codecs
    for codec in codecs:
        for language in languages:
            code = code_of(codec, language)
            about = f"{codec.encoding.name} in {codec.storage.name}, {language}"
            lines = code.text(["A head. " * 40]).splitlines()
            assert max(map(len, lines)) <= WIDTH, (about, max(lines, key=len))
            names = names_in(code.body)
            assert len(max(names, key=len)) <= LONGEST, (about, max(names, key=len))
            if language == "hlsl":
                assert not loops_without_unrolling(code.body), about


EVERY = [(kind, name) for kind in KINDS for name in BY_KIND[kind]]


@pytest.mark.parametrize("kind, name", EVERY, ids=[f"{kind.word}-{name}" for kind, name in EVERY])
def test_the_code_of_an_encoding_has_short_names_and_lines(kind, name):
    """Names have at most 24 letters. Lines have at most 99 characters, including the comments at the top."""
    check(codecs_of(kind, name, "rgba8" if kind is NORMAL else "")[:1], QUICK)


def test_a_loop_without_an_unroll_attribute_is_found():
    """The loop evaluates a polynomial; its `[unroll]` is removed."""
    body = code_of(codecs_of(NORMAL, "spherical", "rg8")[0], "hlsl").body
    assert "[unroll]" in body and not loops_without_unrolling(body)
    assert loops_without_unrolling(re.sub(r" *\[unroll\]\n", "", body))


@pytest.mark.parametrize(
    "name, has, has_not",
    [
        ("warped_cube", ("atan_pi",), ("quadrant_pi", "atan2_pi")),
        ("equal_area_octahedral", ("quadrant_pi",), ("atan2_pi",)),
        ("spherical", ("atan2_pi",), ()),
    ],
)
def test_an_arc_tangent_handles_only_the_octants_that_it_needs(name, has, has_not):
    """A ratio in [-1, 1] needs only its own octants, and two unsigned numbers only the first quadrant."""
    names = names_in(code_of(codecs_of(NORMAL, name, "rgba8")[0], "c").body)
    assert {f"normal_{word}" for word in has} <= names and not {f"normal_{word}" for word in has_not} & names


DECLARED = {
    "hlsl": "Texture2D<float4> normal_scale : register(t0);",
    "slang": "Texture2D<float4> normal_scale : register(t0);",
    "glsl": "layout(binding = 0) uniform sampler2D normal_scale;",
    "essl": "uniform highp sampler2D normal_scale;",
    "wgsl": "@group(0) @binding(0) var normal_scale: texture_2d<f32>;",
    "msl": "// normal_scale, 1024 x 1024 texels, R8_UNORM, one mip level, from best_fit_rgba8_scale.dds.",
}


@pytest.mark.parametrize("language", DECLARED)
def test_a_texture_is_declared_with_its_binding_and_its_contents(language):
    """The code comes with the file that the declaration names."""
    (codec,) = codecs_of(NORMAL, "best_fit", "rgba8")
    code = code_of(codec, language)
    assert DECLARED[language] in code.body
    assert "1024 x 1024 texels, R8_UNORM, one mip level, from best_fit_rgba8_scale.dds." in code.body
    assert "Read texel by texel, without a sampler or a filter." in code.body
    assert "best_fit_rgba8_scale.dds" in code.files([])


def test_two_tables_are_bound_in_the_order_of_their_names():
    body = code_of(codecs_of(NORMAL, "spherical_lut", "rg8")[0], "hlsl").body
    assert re.findall(r"> (\w+) : register\((t\d)\);", body) == [("normal_angle", "t0"), ("normal_xy", "t1")]


def test_files_with_the_same_function_names_have_different_include_guards():
    """A compiler therefore reports the clash; with the same guard it would silently skip one file."""
    (codec,), (other,) = (codecs_of(NORMAL, name, "rg8") for name in ("octahedral", "spheremap"))
    assert "#ifndef OCTAHEDRAL_RG8_INCLUDED" in code_of(codec, "c").text([])
    assert "#ifndef SPHEREMAP_RG8_INCLUDED" in code_of(other, "c").text([])
    assert "#ifndef OCT_INCLUDED" in code_of(codec, "c", "oct").text([])


@pytest.mark.parametrize("word", ["frames", "all", "normal,depth"])
def test_wrong_kind_is_a_one_line_error_that_lists_all_kinds(run, word):
    status, _, err = run("code", "octahedral", "--of", word)
    assert status == 2 and err.strip().count("\n") == 0
    assert "known: normal, motion, curve, light, depth, frame, layout" in err
