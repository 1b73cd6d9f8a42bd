"""Mistakes in encoders, named correctly for every text and bit count, and correct files without findings.

Each program is a correct text with one edit; see `mistakes`. The round trip is measured without any storage, so an
edit that changes no result, such as `>` for `>=` in a fold, is not a mistake.
"""

from pathlib import Path

import pytest
from typed import first_look

from normalbench.bench.shaders.code.files import code_of
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

pytestmark = pytest.mark.usefixtures("gl")


SOME = {("octahedral", "glsl"), ("cube", "wgsl"), ("xy", "glsl"), ("spheremap", "wgsl")}


def check_written(folder: Path, name: str, language: str) -> None:
    codec = Codec(ENCODINGS[name], STORAGES["rgba16"])
    path = folder / f"mine.{language}"
    path.write_text(code_of(codec, language).text([]))
    look = first_look(path)
    assert look.get("wrong") == [], look
    assert look["domain"] == ENCODINGS[name].domain


@pytest.mark.parametrize("name, language", sorted(SOME))
def test_code_from_the_catalogue_has_no_findings(tmp_path, monkeypatch, name, language):
    monkeypatch.chdir(tmp_path)
    check_written(Path(), name, language)
