"""Everyday shaders of users, read and translated to every language with the same meaning."""

import pytest
from everyday import GLSL
from typed import read_encoding

from normalbench.bench.shaders.code.files import code_of
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.usefixtures("gl")


# As many letters at most has the text of any of them: what is nested forty times is as many lines of usual length.
LONGEST = 20_000


def codec_of(path):
    """Return the codec of a file without a first check of the file."""
    return Codec(read_encoding(path), STORAGES["rg16"], "nearest")


# What is nested has the longest text, and the most of calls in each other.
NESTED = ["nested modulus", "nested choices of components"]


@pytest.mark.parametrize("name", NESTED)
@pytest.mark.parametrize("language", ["msl", "glsl"])
def test_generated_text_grows_no_faster_than_the_source(language, name, tmp_path):
    """This covers a language that cannot run here and the source language; `agrees` checks the other languages."""
    (tmp_path / "mine.glsl").write_text(GLSL[name])
    size = len(code_of(codec_of(tmp_path / "mine.glsl"), language, "p").body)
    assert size < LONGEST, f"{language}: {size} letters"
