"""Users' encoders in WGSL: the catalogue's figures with OpenGL and with wgpu, and one-line errors."""

import json
import re

import numpy as np
import pytest
from languages import require_runner
from typed import codecs_named

from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement

pytestmark = pytest.mark.usefixtures("gl")


MINE = """
alias Code = vec2f;
// The sphere, folded into a square.
fn wrap(p: Code) -> Code { return (1.0 - abs(p.yx)) * select(Code(-1), Code(1), p >= Code(0)); }
@must_use
fn EncodeNormal(n: vec3<f32>) -> Code {
    let p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    if n.z < 0.0 { return wrap(p); }
    return p;
}
fn DecodeNormal(e: Code) -> vec3f {
    var n = vec3(e, 1 - abs(e.x) - abs(e.y));
    let t = saturate(-n.z);
    n.x += select(t, -t, n.x >= 0.0);
    n.y += select(t, -t, n.y >= 0.0);
    return normalize(n);
}
"""


QUICK = ("--storage", "rgb10a2", "--normals", "sphere", "--backend", "glsl", "--count", "65536", "--format", "json")


FIGURES = ("mse", "angle_mean_deg", "angle_max_deg")


def written(folder, text, name="mine.wgsl"):
    (folder / name).write_text(text)
    return str(folder / name)


def test_a_wgsl_encoder_has_the_figures_of_the_catalogues_encoder(run, tmp_path):
    """The octahedral map written in WGSL agrees with the catalogue's to a relative 1e-6."""
    status, out, err = run("quality", "--encoding", f"{written(tmp_path, MINE)},octahedral", *QUICK)
    assert status == 0, err
    mine, ours = sorted(json.loads(out), key=lambda row: row["encoding"] == "octahedral")
    assert mine["encoding"] == "mine.wgsl"
    assert [mine[name] for name in FIGURES] == pytest.approx([ours[name] for name in FIGURES], rel=1e-6)


def test_the_users_own_text_in_wgpu_gives_the_codes_of_its_translation(tmp_path):
    """The original text, compiled by naga, is called by the functions of the codec's code."""
    require_runner("wgsl")
    (codec,) = codecs_named(written(tmp_path, MINE), "rgb10a2", "nearest")
    code = code_of(codec, "wgsl", "p")
    mine = re.sub(
        r"fn p_encode\(.*?\n}\n", "fn p_encode(n: vec3f) -> vec2f { return EncodeNormal(n); }\n", code.body, flags=re.S
    )
    mine = re.sub(
        r"fn p_decode\(.*?\n}\n", "fn p_decode(e: vec2f) -> vec3f { return DecodeNormal(e); }\n", mine, flags=re.S
    )
    assert mine.count("EncodeNormal") == 1 and mine.count("DecodeNormal") == 1
    (tmp_path / code.name).write_text(MINE + mine)
    verdict = agreement(codec, "wgsl", tmp_path / code.name, code.interface)
    assert verdict.holds and not verdict.differing, verdict.says


WRONG = {
    "syntax": ("fn EncodeNormal(n: vec3f) -> vec2f { return n.xy", r"\.wgsl:\d+:\d+: expected "),
    "unknown": (MINE.replace("wrap(p); }", "warp(p); }"), r"\.wgsl:8:27: unknown function warp"),
    "missing": (
        MINE.replace("fn DecodeNormal", "fn other").replace("vec3f {", "f32 {").replace("(n);", "(n).x;"),
        "no decoder",
    ),
    "kind": (
        MINE.replace("let t =", "let k: i32 = 2; let t = k *"),
        r"\.wgsl:13:\d+: expected (int|float), not (int|float)",
    ),
    "binding": (
        "@group(0) @binding(0) var<uniform> t: f32;" + MINE.replace("return p;", "return p * t;"),
        r"\.wgsl:1:\d+: t is set from outside",
    ),
    "endless": (MINE.replace("let p =", "loop { } let p ="), "do not end|did not end|killed|must|declaration"),
    "nan": (MINE.replace("return p;", "return p * sqrt(-1.0 - n.z * n.z);"), r"is \(nan, nan\), not finite"),
    "deep": (MINE.replace("return p;", f"return {'(' * 3000}p{')' * 3000};"), "nested more than"),
    "empty": ("", "no encoder"),
    "junk": ("\x00\x01\x02" * 99, "unexpected character"),
    "large": ("// " + "x" * 17_000_000 + "\n" + MINE, "larger than"),
}


@pytest.mark.parametrize("name", WRONG)
def test_invalid_file_is_a_one_line_error_with_status_2(run, tmp_path, name):
    """The error names the user's file, with the line and column if they are known."""
    text, pattern = WRONG[name]
    status, out, err = run("quality", "--encoding", written(tmp_path, text), *QUICK)
    assert (status, out) == (2, "") and err.count("\n") == 1, err
    assert "mine.wgsl" in err and re.search(pattern, err), err


def test_an_invalid_file_loses_only_its_own_rows(run, tmp_path):
    """The other file's row is measured, and the status is 0."""
    wrong = written(tmp_path, WRONG["syntax"][0], "wrong.wgsl")
    status, out, err = run("quality", "--encoding", f"{wrong},{written(tmp_path, MINE)}", *QUICK)
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["mine.wgsl"]
    assert err.count("left out: ") == 1 and np.isfinite(json.loads(out)[0]["mse"])
