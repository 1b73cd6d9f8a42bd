"""Mistakes in encoders, named correctly for every text and bit count, and correct files without findings.

Each program is a correct text with one edit; see `mistakes`. The round trip is measured without any storage, so an
edit that changes no result, such as `>` for `>=` in a fold, is not a mistake.
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


@pytest.mark.parametrize("text, mistake, bits", [case for case in ALL if case not in QUICK])
def test_every_mistake_is_identified(tmp_path, text, mistake, bits):
    check(tmp_path, text, mistake, bits)


# Encodings whose code is a file alone, in the languages that doctor reads.
WRITTEN = [name for name, e in ENCODINGS.items() if not e.has_tables and not e.is_precise]


LANGUAGES = ("glsl", "hlsl", "slang", "wgsl")


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize("name", WRITTEN)
def test_all_code_from_the_catalogue_has_no_findings(tmp_path, monkeypatch, name, language):
    monkeypatch.chdir(tmp_path)
    check_written(Path(), name, language)
