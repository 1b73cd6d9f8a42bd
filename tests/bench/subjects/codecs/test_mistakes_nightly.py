"""Mistakes of encoders are named rightly, whatever the text and the bits; right files raise nothing.

Each program is a right text with one edit; see `mistakes`. What is measured is a round trip without any storage, so
that a mistake which changes no result, as `>` for `>=` in a fold, is none.
"""

from pathlib import Path

import pytest
from mistakes import MISTAKES, TEXTS
from test_mistakes import QUICK, check
from test_mistakes_slow import check_written

from normalbench.encodings.catalogue import ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")


BITS = (8, 10, 16)


ALL = [(text, mistake, bits) for text in TEXTS for mistake in MISTAKES for bits in BITS]


@pytest.mark.parametrize("text, mistake, bits", [one for one in ALL if one not in QUICK])
def test_every_mistake_is_named(tmp_path, text, mistake, bits):
    check(tmp_path, text, mistake, bits)


# Encodings whose code is a file alone, in the languages that doctor reads.
WRITTEN = [name for name, e in ENCODINGS.items() if not e.has_tables and not e.is_precise]


LANGUAGES = ("glsl", "hlsl", "slang", "wgsl")


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", WRITTEN)
def test_all_code_of_the_catalogue_raises_nothing(tmp_path, monkeypatch, name, language):
    monkeypatch.chdir(tmp_path)
    check_written(Path(), name, language)
