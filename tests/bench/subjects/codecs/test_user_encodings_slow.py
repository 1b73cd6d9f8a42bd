"""Users' encodings from GLSL files, and one-line errors that do not affect other files."""

import json

import pytest
from test_user_encodings import MINE, QUICK, written
from twins import HALF_OCTAHEDRAL
from typed import encodings_named

from normalbench.encodings.catalogue import NAMES

pytestmark = pytest.mark.usefixtures("gl")


def test_a_users_pair_is_measured_like_a_catalogue_encoding(run, tmp_path):
    """Using the whole square for half the sphere gains about one bit over the full octahedral map."""
    path = written(tmp_path)
    status, out, err = run("quality", "--encoding", f"{path},octahedral", "--backend", "glsl", *QUICK)
    rows = {row["encoding"]: row for row in json.loads(out)}
    assert status == 0 and err.endswith(
        "mine.glsl: assumed to be made only for normals with z >= 0: other normals do not round-trip\n"
    )
    assert err.count("\n") == 1
    assert 0.8 < rows["mine"]["effective_bits"] - rows["octahedral"]["effective_bits"] < 1.2, rows
    status, out, _ = run("render", "--encoding", path, "--size", "64x48", "--repeats", "1", "--format", "json")
    assert status == 0 and json.loads(out)[0]["encoding"] == "mine"


def test_jax_row_reports_a_missing_twin_and_agrees_with_an_existing_one(run, tmp_path):
    path = written(tmp_path)
    status, out, err = run("quality", "--encoding", path, *QUICK)
    jax_row, gl_row = json.loads(out)
    reason = "mine has no Python twin; add mine.py next to it for rows computed by JAX"
    assert status == 0 and jax_row["skipped"] == reason
    assert f"normalbench: measured only by OpenGL: {reason}\n" in err and "without figures" not in err
    _, out, _ = run("quality", "--encoding", path, *QUICK[:-1], "markdown")
    assert "| mine " in out and "jax" not in out.partition("- by OpenGL")[0], "a row by GLSL alone"
    assert f"by OpenGL alone: mine/rgba8 on hemisphere ({jax_row['skipped']})" in out
    (tmp_path / "mine.py").write_text(HALF_OCTAHEDRAL)
    _, out, err = run("quality", "--encoding", path, *QUICK)
    by_jax, by_gl = json.loads(out)
    assert err.count("\n") == 1 and by_jax["psnr_db"] == pytest.approx(by_gl["psnr_db"], abs=0.02)
    assert by_gl["psnr_db"] == gl_row["psnr_db"]
    # The twin's functions are encode and decode; those of the shader may be, too.
    (tmp_path / "mine.glsl").write_text(MINE.replace("mine_", ""))
    renamed = json.loads(run("quality", "--encoding", path, *QUICK)[1])
    assert [row["psnr_db"] for row in renamed] == [by_jax["psnr_db"], by_gl["psnr_db"]], renamed


def test_decoder_that_does_not_invert_the_encoder_is_reported_and_measured(run, tmp_path):
    path = written(tmp_path, MINE.replace("vec3(p, 1.0", "vec3(p * p, 1.0"))
    status, out, err = run("quality", "--encoding", path, "--backend", "glsl", *QUICK)
    assert status == 0 and len(json.loads(out)) == 1 and "encode and decode are not a pair" in err


@pytest.mark.parametrize(
    "text, said",
    [
        (MINE.replace("p.x + p.y, p.x", "q.x + p.y, p.x"), "mine.glsl:4: error"),
        (MINE.partition("vec3 mine_decode")[0], "no function vec3 mine_decode(vec2 e, vec3 view)"),
        (MINE.replace("vec2(p.x + p.y, p", "vec2(sqrt(n.z - 2.0), p"), "encode of"),
        (MINE.replace("mine_", "octahedral_"), "an encoding named octahedral already exists"),
        (MINE + "float2 half_of(float2 e) { return e * 0.5; }", "(float2 is HLSL: rename float2 to vec2"),
        ("", "no function vec2"),
    ],
)
def test_invalid_file_does_not_affect_other_encodings(run, tmp_path, text, said):
    path = written(tmp_path, text)
    status, out, err = run("quality", "--encoding", path, *QUICK)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
    status, out, err = run("quality", "--encoding", f"{path},octahedral", "--backend", "glsl", *QUICK)
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["octahedral"]
    assert err.startswith("normalbench: left out: ") and said in err and err.count("\n") == 1


def test_all_means_the_catalogue_even_after_files_were_read(tmp_path):
    """A test session or a file of gates gives the same results in any order."""
    path = written(tmp_path)
    assert [encoding.name for encoding in encodings_named(path)] == ["mine"]
    assert [encoding.name for encoding in encodings_named("all")] == list(NAMES)
    assert [encoding.name for encoding in encodings_named(f"{path},all")] == [*NAMES, "mine"]


GOOD_ENCODE = "from normalbench.encodings.vec import Vec2\ndef encode(n, view):\n    return Vec2(n.x, n.y)\n"


@pytest.mark.parametrize(
    "twin, said",
    [
        (
            "def encode(n, view):\n    return n.w\ndef decode(e, view):\n    return e\n",
            "mine.py: AttributeError in line 2",
        ),
        (
            GOOD_ENCODE + "def decode(e, view):\n    return [e.x, e.y, e.x]\n",
            "mine.py: decode returns list, not a Vec3",
        ),
        ("print('hello')\nraise SystemExit(0)\n", "mine.py: SystemExit"),
    ],
)
def test_a_failing_twin_loses_only_the_jax_row(run, tmp_path, twin, said):
    (tmp_path / "mine.py").write_text(twin)
    status, out, err = run("quality", "--encoding", written(tmp_path), *QUICK)
    by_jax, by_gl = json.loads(out)
    assert status == 0 and said in by_jax["skipped"] and by_gl["psnr_db"]
    assert said in err and [line for line in err.splitlines() if "assumed to be made only for" not in line] == [
        err.splitlines()[-1]
    ], err
