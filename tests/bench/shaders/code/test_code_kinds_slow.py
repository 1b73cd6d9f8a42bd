"""Code of motion vectors, depth, light and curves: run in each language, and equal to the catalogue's."""

import pytest
from languages import RUN, require_runner
from slowly import a_tenth
from test_code_kinds import agreement_of, codec_of

from normalbench.bench.subjects.codecs.kinds.codecs import NAMED
from normalbench.encodings.catalogue import BY_KIND

# Of each kind, codes and storages that are made otherwise: shares, polynomials, powers, floats, and integers.
CODECS = (
    ("motion", "cube_root", "rg16_snorm"),
    ("motion", "linear", "rg16f"),
    ("motion", "log", "rg8_centred"),
    ("motion", "sqrt", "float:4:5"),
    ("curve", "srgb", "r8"),
    ("curve", "log", "r16f"),
    ("curve", "ray_bits", "rgb10a2"),
    ("curve", "squared", "unorm:5"),
    ("light", "plain", "rgba16f"),
    ("light", "plain", "r11g11b10f"),
    ("light", "rgbm", "rgba8"),
    ("light", "nao32", "rgba8"),
    ("light", "rgb9e5", "rgba8"),
    ("depth", "linear", "r32f"),
    ("depth", "linear", "unorm:20"),
    ("depth", "linear_sign", "packed24"),
    ("depth", "window", "packed24"),
    ("depth", "reversed_window", "depth32f"),
    ("depth", "logarithmic", "packed16"),
)


def pairs() -> list:
    """Each codec with each language."""
    return [(*codec, language) for codec in CODECS for language in RUN]


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("kind, name, storage, language", a_tenth(pairs()))
def test_the_code_of_a_kind_gives_the_catalogues_texels(kind, name, storage, language, tmp_path):
    """2^16 values: texels, numbers that come back, and render targets."""
    require_runner(language)
    found = agreement_of(codec_of(kind, name, storage), language, tmp_path)
    assert found.holds, found.says


@pytest.mark.parametrize("kind", ["motion", "curve", "light", "depth"])
def test_the_code_of_every_encoding_of_a_kind_is_written(kind, tmp_path):
    """In the first storage where each usually lies, in C."""
    require_runner("c")
    for name in BY_KIND[NAMED[kind]]:
        found = agreement_of(codec_of(kind, name, ""), "c", tmp_path)
        assert found.holds, f"{name}: {found.says}"
