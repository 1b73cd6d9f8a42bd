"""Code of every codec as an engine programmer would paste it: short names and lines, and loops over tables unrolled."""

import numpy as np
import pytest
from test_readable import EVERY, check, codecs_of

from normalbench.bench.door import code_command
from normalbench.bench.shaders.code.emit import LANGUAGES
from normalbench.bench.shaders.code.tables import dds, header, kept, texels_of
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.kinds import NORMAL
from normalbench.encodings.storages.storage import (
    CURVE_STORAGES,
    FRAME_STORAGES,
    LIGHT_STORAGES,
    MOTION_STORAGES,
)


def test_best_fit_table_takes_one_byte_per_texel():
    """The scales are k / 255, so 8 bits hold the same numbers as 32-bit floats: 1 MiB instead of 4 MiB."""
    (table,) = ENCODINGS["best_fit"].tables().values()
    texels = texels_of(table)
    assert texels.is_bytes and texels.format == "R8_UNORM" and texels.bytes == 2**20
    assert np.array_equal(kept(table) / np.float32(255), table)
    assert len(dds(table)) == 148 + 2**20
    assert "static const unsigned char t[1048576] = {" in header({"t": table})
    (angles,) = (array for name, array in ENCODINGS["spherical_lut"].tables().items() if name.endswith("angle"))
    assert texels_of(angles).format == "R32_FLOAT"


def test_codecs_of_one_kind_have_distinct_names(run, tmp_path, monkeypatch):
    """The files share a folder and can be used together; each gives the command that writes it alone."""
    # Errors take a search for the worst case; test_code.py has a file that says them.
    monkeypatch.setattr(code_command, "figures", lambda _: [])
    status, _, _ = run("code", "xy,octahedral,cube_root", "--storage", "rg16_snorm", "--to", "c", "-o", str(tmp_path))
    assert status == 0
    assert "octahedral_rg16_snorm_encode(" in (tmp_path / "octahedral_rg16_snorm.h").read_text()
    text = (tmp_path / "xy_rg16_snorm.h").read_text()
    assert "xy_rg16_snorm_encode(" in text
    assert "--prefix xy_rg16_snorm" in " ".join(text.replace("//", "").split())
    assert " motion_encode(" in (tmp_path / "motion_cube_root_rg16_snorm.h").read_text()


# Storages whose functions are the longest: bytes, bits across channels, floats, signed numbers, two words.
SOME = "rg8,rgba8,rgb8_12_12,rg16f,rgba8_10_10_10_snorm"


OF_KIND = {"motion": MOTION_STORAGES, "curve": CURVE_STORAGES, "light": LIGHT_STORAGES, "frame": FRAME_STORAGES}


@pytest.mark.parametrize("kind, name", EVERY, ids=[f"{kind.word}-{name}" for kind, name in EVERY])
def test_code_in_other_storages_has_short_names_and_lines(kind, name):
    """Every language is checked, in one storage per encoding, taken in turn; the nightly test checks all storages."""
    codecs = in_other_storages(kind, name)
    check([codecs[EVERY.index((kind, name)) % len(codecs)]], LANGUAGES)


def in_other_storages(kind, name) -> list:
    """Return the codecs of an encoding in storages of its kind."""
    return codecs_of(kind, name, SOME if kind is NORMAL else ",".join(OF_KIND.get(kind.word, ())))
