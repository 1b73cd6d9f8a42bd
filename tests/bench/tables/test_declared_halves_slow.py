"""Files that declare 16-bit numbers, also measured in half arithmetic, on which the answer is based."""

import json

import pytest
from manual import ROOT

from normalbench.bench.ground.output.errors import MissingError
from normalbench.bench.subjects.codecs.half import compute

FORMS = ROOT / "tests" / "inputs" / "encoders"


# A file is answered with one code of the catalogue, of few normals.
SMALL_ANSWER = ("--domain", "tangent", "--encoding", "hemi_octahedral", "--count", "4096", "--format", "json")


GLSL = """mediump vec2 dir_encode(highp vec3 n) { return n.xy; }
mediump vec3 dir_decode(mediump vec2 e) { return vec3(e, sqrt(max(1.0 - dot(e, e), 0.0))); }
"""


@pytest.fixture
def halves():
    try:
        compute.half_device()
    except MissingError as error:
        pytest.skip(str(error))


@pytest.mark.usefixtures("gl", "halves", "slang")
def test_quality_has_a_row_for_each_arithmetic(run, tmp_path):
    """In half arithmetic xy cannot use all of 16-bit UNORM: its mean error is 0.0708 degrees instead of 0.0030."""
    (tmp_path / "dir.glsl").write_text(GLSL)
    files = f"{FORMS / 'half_literal.hlsl'},{tmp_path / 'dir.glsl'},xy"
    asked = ("--storage", "rg16", "--normals", "hemisphere", "--backend", "glsl", "--count", "65536")
    _, out, err = run("quality", "--encoding", files, *asked, "--format", "json")
    means = {row["encoding"]: row["angle_mean_deg"] for row in json.loads(out)}
    assert means == {
        "xy": pytest.approx(0.00298, rel=0.01),
        **dict.fromkeys(("half_literal.hlsl", "dir"), pytest.approx(0.00298, rel=0.01)),
        **dict.fromkeys(("half_literal.hlsl:arithmetic=half", "dir:arithmetic=half"), pytest.approx(0.0708, rel=0.1)),
    }
    assert "it declares 16-bit numbers" in err
    _, out, _ = run("quality", "--encoding", files, *asked, "--arithmetic", "float", "--format", "json")
    assert len(json.loads(out)) == 3


@pytest.mark.usefixtures("gl", "halves", "slang")
def test_the_answer_quotes_half_arithmetic(run):
    file = str(FORMS / "half_literal.hlsl")
    _, out, _ = run("doctor", file, "--storage", "rg16")
    assert "in rg16, with the half precision that the file declares: mean error 0.07" in out
    _, out, _ = run("pick", "--storage", "rg16", "--against", file, *SMALL_ANSWER)
    (row,) = [row for row in json.loads(out) if row["against"]]
    assert row["encoding"] == "half_literal.hlsl:arithmetic=half"
    assert row["angle_mean_deg"] == pytest.approx(0.0709, rel=0.1)


@pytest.mark.usefixtures("gl", "slang")
def test_the_answer_uses_32_bits_without_a_device_for_half_arithmetic(run, monkeypatch):
    def missing():
        raise MissingError("half arithmetic with --backend glsl needs wgpu; pip install wgpu")

    monkeypatch.setattr("normalbench.bench.subjects.codecs.half.compute.half_device", missing)
    message = "computed only in 32 bits: half arithmetic with --backend glsl needs wgpu"
    file = str(FORMS / "half_literal.hlsl")
    _, out, err = run("pick", "--storage", "rg8", "--against", file, *SMALL_ANSWER)
    (row,) = [row for row in json.loads(out) if row["against"]]
    assert row["encoding"] == "half_literal.hlsl" and message in err
    asked = ("--storage", "rg8", "--normals", "hemisphere", "--backend", "glsl", "--count", "4096", "--format", "json")
    _, out, err = run("quality", "--encoding", file, *asked)
    assert [row["encoding"] for row in json.loads(out)] == ["half_literal.hlsl"] and message in err


@pytest.mark.usefixtures("gl", "slang")
def test_an_encoding_with_an_integer_code_is_computed_in_32_bits(run, tmp_path):
    text = (FORMS / "uint_only.hlsl").read_text()
    (tmp_path / "mine.hlsl").write_text(text.replace("float3 c", "half3 c"))
    asked = ("--normals", "sphere", "--storage", "rg8", "--backend", "glsl", "--count", "4096", "--format", "json")
    _, out, err = run("quality", "--encoding", str(tmp_path / "mine.hlsl"), *asked)
    assert len(json.loads(out)) == 1 and "its code is an integer: it is computed in 32 bits" in err
