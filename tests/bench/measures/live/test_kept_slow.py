"""The data that a run stores for a page's laboratory: codec programs, their files, scenes and damaged files."""

import re

from typed import codecs_named

from normalbench.bench.measures.live import kept, programs
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES

# Of GLSL ES 3.10 and later: a browser's 3.00 has none of them.
LATER = re.compile(r"\b(bitfield\w+|fma|frexp|ldexp|(un)?pack[US]norm4x8|findMSB|findLSB|textureGather)\(")


MINE = "vec2 mine_encode(vec3 n) { return n.xy; }\nvec3 mine_decode(vec2 e) { return vec3(e, 0.5); }\n"


def test_every_codec_uses_only_functions_that_browsers_support():
    records = {}
    for encoding in ENCODINGS.values():
        codec = Codec(encoding, STORAGES["rgba8"], "nearest")
        try:
            records[encoding.name] = programs.program(codec)
        except programs.NotLiveError as error:
            assert str(error) == programs.TABLES_TOO_LARGE, encoding.name
    assert set(ENCODINGS) - set(records) == {"best_fit", "spherical_lut"}
    for name, record in records.items():
        assert not LATER.search(record["source"]), name
        kept.KEPT.validate_python({**record, "checks": None})


def test_the_record_of_a_users_encoding_includes_its_source(tmp_path):
    (tmp_path / "mine.glsl").write_text(MINE)
    (codec,) = codecs_named(str(tmp_path / "mine.glsl"), "rg16f", "nearest")
    record = programs.program(codec)
    assert (record["text"], record["size"], record["title"]) == (MINE, 2, "RG16F")
    assert "vec2 codec_encode(vec3 n)" in record["source"]


def test_a_page_has_its_laboratory_wherever_its_files_are_written(run, tmp_path):
    """Here --live writes the files to another folder."""
    page, folder = tmp_path / "page.html", tmp_path / "there"
    words = ("--encoding", "octahedral", "--backend", "jax", "--normals", "sphere", "--count", "4096")
    status, _, err = run("quality", *words, "--live", str(folder), "--report", str(page))
    assert status == 0, err
    assert [path.name for path in folder.iterdir()] == ["octahedral-rgba8.json"]
    assert '<section id="live"' in page.read_text()
