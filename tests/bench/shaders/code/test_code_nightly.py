"""Code of codecs, written in every language, run there and compared with the catalogue."""

from itertools import product

import pytest
import test_code_slow
from languages import RUN, require_runner
from slowly import half
from test_code import written
from test_code_slow import CODECS
from typed import codecs_named

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.storages.storage import STORAGES


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("name, language", half(product(CODECS, RUN)))
def test_the_code_of_a_codec_gives_the_catalogues_texels_in_any_language(language, name, tmp_path):
    test_code_slow.test_the_code_of_a_codec_gives_the_catalogues_texels(language, name, tmp_path)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("encoding", half(ENCODINGS))
def test_the_code_of_every_codec_gives_the_catalogues_texels(encoding, tmp_path):
    """C covers every storage that fits, and the other languages every third, so that each language still has every
    encoding and storage. Slang takes the HLSL text, and OpenGL the GLSL ES text without precision qualifiers."""
    languages = ("c", "hlsl", "wgsl", "essl")
    for language in languages:
        require_runner(language)
    wrong = []
    codecs = [codec for codec in codecs_named(encoding, ",".join(STORAGES), "nearest") if codec.fits]
    for number, codec in enumerate(codecs, list(ENCODINGS).index(encoding)):
        for language in languages[: 1 if number % 3 else None]:
            code = code_of(codec, language)
            verdict = agreement(codec, language, written(tmp_path, code), code.interface)
            wrong += [] if verdict.holds else [f"{codec.name} in {language}: {verdict.says}"]
    assert not wrong, wrong
