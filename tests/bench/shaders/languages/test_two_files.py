"""An encoder and its decoder in two files: FILE:ENCODE,FILE:DECODE."""

import pytest
from typed import Source

from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.ground.user_files import UserFile, file_names, files_in, with_files
from normalbench.bench.run.measuring import files_of
from normalbench.bench.tables.quality.table import QualityOptions

ENC = '#include "common.hlsl"\nfloat2 PackDir(float3 n) { return scaled(n.xy); }\n'


DEC = """#include "common.hlsl"
#define HALF 2.0
static const float ONE = 1.0;
float2 PackDir(float2 e) { return scaled(e) * (HALF / 2.0); }
float3 UnpackDir(float2 e) { e = PackDir(e); return float3(e, sqrt(saturate(ONE - dot(e, e)))); }
"""


COMMON = "#ifndef COMMON\n#define COMMON\n#define HALF 1.0\nfloat2 scaled(float2 e) { return e * HALF; }\n#endif\n"


@pytest.fixture
def two(tmp_path):
    for name, text in (("enc.hlsl", ENC), ("dec.hlsl", DEC), ("common.hlsl", COMMON)):
        (tmp_path / name).write_text(text)
    return f"{tmp_path / 'enc.hlsl'}:PackDir,{tmp_path / 'dec.hlsl'}:UnpackDir"


def test_consecutive_encoder_and_decoder_form_one_name(two):
    assert file_names(f"octahedral,{two},mine.hlsl:A:B,xyz") == ("octahedral", two, "mine.hlsl:A:B", "xyz")
    assert file_names("a.hlsl:A, b.hlsl:B,c.hlsl:C,d.hlsl:D") == ("a.hlsl:A, b.hlsl:B", "c.hlsl:C,d.hlsl:D")
    assert file_names("a.hlsl:A:define=X,b.hlsl:B")[0] == "a.hlsl:A:define=X"
    enc, dec = files_in(two)
    assert UserFile(two).functions == ("PackDir", "UnpackDir") and UserFile(f"{two}:define=A").settings.defines == (
        "A",
    )
    assert with_files(two, {enc: "x/enc.hlsl", dec: "y/dec.hlsl"}) == "x/enc.hlsl:PackDir,y/dec.hlsl:UnpackDir"


def test_both_files_are_fingerprinted(two, tmp_path):
    options = QualityOptions(encoding=two)
    before = files_of(options)
    (tmp_path / "dec.hlsl").write_text(DEC + "\n")
    assert len(before["files"]) == 1 and files_of(options) != before


def test_the_same_name_for_both_functions_is_refused(two):
    with pytest.raises(UsageError, match="both functions are called PackDir; rename one"):
        Source(two.replace("UnpackDir", "PackDir"))
