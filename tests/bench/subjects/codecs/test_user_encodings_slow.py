"""Users' own encodings from GLSL files: measured, and what is wrong with them said in a line that spares the others."""

import json

import pytest
from test_user_encodings import MINE, QUICK, written

from normalbench.bench.subjects.codecs import user_encodings
from normalbench.encodings.catalogue import NAMES

pytestmark = pytest.mark.usefixtures("gl")


@pytest.mark.parametrize(
    "text, said",
    [
        (MINE.replace("p.x + p.y, p.x", "q.x + p.y, p.x"), "mine.glsl:4: error"),
        (MINE.partition("vec3 mine_decode")[0], "no function vec3 mine_decode(vec2 e, vec3 view)"),
        (MINE.replace("vec2(p.x + p.y, p", "vec2(sqrt(n.z - 2.0), p"), "encode of"),
        (MINE.replace("mine_", "octahedral_"), "there is an encoding named octahedral already"),
        (MINE + "float2 half_of(float2 e) { return e * 0.5; }", "(float2 is HLSL: rename float2 to vec2"),
        ("", "no function vec2"),
    ],
)
def test_what_is_wrong_with_one_spares_the_others(run, tmp_path, text, said):
    path = written(tmp_path, text)
    status, out, err = run("quality", "--encoding", path, *QUICK)
    assert (status, out) == (2, "") and err.count("\n") == 1 and said in err, err
    status, out, err = run("quality", "--encoding", f"{path},octahedral", "--backend", "glsl", *QUICK)
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["octahedral"]
    assert err.startswith("normalbench: left out: ") and said in err and err.count("\n") == 1


def test_all_is_the_catalogue_whatever_files_there_were(tmp_path):
    """A session of tests, or a file of gates, measures the same in any order."""
    path = written(tmp_path)
    assert [encoding.name for encoding in user_encodings.encodings_named(path)] == ["mine"]
    assert [encoding.name for encoding in user_encodings.encodings_named("all")] == list(NAMES)
    assert [encoding.name for encoding in user_encodings.encodings_named(f"{path},all")] == [*NAMES, "mine"]


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
def test_a_twin_that_fails_costs_the_rows_by_jax(run, tmp_path, twin, said):
    (tmp_path / "mine.py").write_text(twin)
    status, out, err = run("quality", "--encoding", written(tmp_path), *QUICK)
    by_jax, by_gl = json.loads(out)
    assert status == 0 and said in by_jax["skipped"] and by_gl["psnr_db"]
    assert said in err and [line for line in err.splitlines() if "taken to be made for" not in line] == [
        err.splitlines()[-1]
    ], err
