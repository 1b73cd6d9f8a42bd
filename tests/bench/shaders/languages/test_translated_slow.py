"""Users' HLSL and Slang files in every command, and one-line errors that do not affect other files."""

import itertools
import json
import re
from pathlib import Path

import pytest
import test_translated
from test_translated import MINE, QUICK, changed, written

from normalbench.bench.ground.compilers import tools
from normalbench.bench.ground.user_files import UserFile
from normalbench.bench.shaders.languages import translated
from normalbench.encodings import vec
from normalbench.encodings.catalogue import ENCODINGS

pytestmark = pytest.mark.usefixtures("gl")
_here = test_translated._here


def test_missing_compiler_error_says_what_to_install(run, tmp_path, monkeypatch):
    monkeypatch.setattr(tools, "path_of", lambda tool: (_ for _ in ()).throw(tools.MissingError(tools.MISSING[tool])))
    for ending in ("hlsl", "slang"):
        status, out, err = run("quality", "--encoding", written(tmp_path, MINE, f"mine.{ending}"), *QUICK)
        assert (status, out) == (3, "") and err.count("\n") == 1 and "pip install slangpy" in err, err
    assert run("quality", "--encoding", f"{tmp_path / 'mine.hlsl'},xy", *QUICK)[0] == 0


@pytest.mark.usefixtures("hlsl")
def test_process_folder_replaces_an_unwritable_cache(run, tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / written(tmp_path, "a file", "cache")))
    status, out, _ = run("quality", "--encoding", written(tmp_path, MINE, "mine.hlsl"), *QUICK)
    assert status == 0 and json.loads(out)[0]["angle_mean_deg"]


@pytest.mark.usefixtures("hlsl")
def test_a_damaged_translation_is_made_again(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    path = translated.translated(UserFile(str(written(tmp_path, MINE, "mine.hlsl")))).glsl(False)
    text = path.read_text()
    path.write_text("damaged")
    assert translated.translated(UserFile(str(tmp_path / "mine.hlsl"))).glsl(False).read_text() == text


def test_compiler_hints_do_not_prevent_translation(run, ending):
    """SPIRV-Cross writes [unroll] and [branch] as conditional macros."""
    loop = "float s = 0; [unroll] for (int i = 0; i < 2; i++) s += p[i];"
    Path(f"mine.{ending}").write_text(changed(f"{loop} [branch] if (n.z < 2) return float2(s, p.x - p.y); return p;"))
    status, out, err = run(
        "code", "--check", f"mine.{ending}", "--storage", "rg16", "--to", "c,hlsl", "--format", "json"
    )
    assert status == 0 and [row["verdict"] for row in json.loads(out)] == ["verified"] * 2, err


BOMB = "#define A0 s += sin(s);\n" + "".join(f"#define A{i + 1} A{i} A{i} A{i} A{i}\n" for i in range(14))


def test_a_file_is_measured_rendered_and_costed(run, tmp_path, ending):
    path = written(tmp_path, MINE, f"mine.{ending}")
    status, out, err = run("quality", "--encoding", f"{path},hemi_octahedral", *QUICK)
    own, catalogues = (row["angle_mean_deg"] for row in json.loads(out))
    assert status == 0 and own == pytest.approx(catalogues, rel=1e-3) and err.count("\n") == 1, err
    render = ("--size", "64x48", "--repeats", "1", "--format", "json")
    status, out, _ = run("render", "--encoding", path, *render)
    assert status == 0 and json.loads(out)[0]["encoding"] == f"mine.{ending}"
    status, out, _ = run("doctor", path, "--format", "json")
    assert status == 0 and "made only for normals with z >= 0" in out


@pytest.mark.usefixtures("hlsl")
def test_run_and_gates_accept_a_users_file(run, tmp_path):
    written(tmp_path, MINE, "mine.hlsl")
    written(tmp_path, '[[gate]]\nencoding = "mine.hlsl"\nstorage = "rg8"\nnormals = "hemisphere"\ncount = 4096\n'
            'angle_mean_deg = "at most 0.3"\n', "gates.toml")  # fmt: skip
    assert run("check", "gates.toml")[0] == 0
    status, _, err = run("run", "-o", "results", "--tables", "quality", "--encoding", "mine.hlsl", *QUICK[:-2])
    assert status == 0 and "mine.hlsl" in (tmp_path / "results" / "quality.csv").read_text(), err


PLAIN = ("octahedral", "signed_octahedral", "spheremap", "xyz_largest", "cryengine3", "xy_sign")


# What encodings/vec.glsl has, in HLSL.
OF_VEC = f"""
#define TINY {vec.TINY!r}
float sign_not_zero(float v) {{ return v < 0.0 ? -1.0 : 1.0; }}
float2 sign_not_zero(float2 v) {{ return float2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }}
float2 unit(float2 v) {{ if (dot(v, v) > TINY) return v * rsqrt(dot(v, v)); return float2(1.0, 0.0); }}
float3 unit(float3 v) {{ if (dot(v, v) > TINY) return v * rsqrt(dot(v, v)); return float3(1.0, 0.0, 0.0); }}
"""


def in_hlsl(name: str) -> str:
    """Return an encoding of the catalogue, word for word in HLSL."""
    text = ENCODINGS[name].glsl.read_text().replace(f"{name}_", f"own_{name}_")
    return OF_VEC + re.sub(r"\bvec([23])", r"float\1", re.sub("#include.*", "", text))


@pytest.mark.usefixtures("radv")
def test_the_same_steps_take_the_same_number_of_instructions(run, ending, tmp_path):
    """Counts are equal on two generations of GPUs."""
    # Slang is given HLSL's text, and takes a second for each.
    names = PLAIN if ending == "hlsl" else PLAIN[:2]
    files = [written(tmp_path, in_hlsl(name), f"{name}.{ending}") for name in names]
    row = ("--isa", "--stage", "fragment", "--family", "polaris10,navi21", "--storage", "rg8", "--format", "json")
    _, out, _ = run("cost", "--encoding", ",".join([*files, *names]), *row)
    counts = {(row["encoding"], row["operation"], row["family"]): row["instructions"] for row in json.loads(out)}
    for name, operation, family in itertools.product(names, ("encode", "decode"), ("polaris10", "navi21")):
        own, glsl = (counts[each, operation, family] for each in (f"own_{name}", name))
        assert own == glsl, f"{name} {operation} on {family}: {own} instructions, {glsl} in GLSL"


ENDLESS = "float s = n.x; while (s < 2.0) s *= 0.5; return n.xy * s;"


READS = "Texture2D<float4> T; SamplerState S;\n" + changed("return T.SampleLevel(S, n.xy, 0).xy;")


KILLED = "cannot handle this input|did not end|killed|crashes the compiler"
# What is wrong, and what its line says.
WRONG = {
    "undeclared": (changed("\n return n.xy * strange;"), r":5:16: (strange: unknown variable|undefined.*'strange')"),
    "cut": (MINE[:-3], "expected|at the end of the file"),
    "stops": ("#error stop here\n" + MINE, "stop here"),
    "missing": ('#include "gone.hlsli"\n' + changed("return gone(n);"), ":1: gone.hlsli is not next to missing"),
    "elsewhere": ('#include "/etc/hostname"\n' + changed("return host(n);"), "is outside the folder of elsewhere"),
    "empty": ("", "no encoder and decoder found"),
    "half": (MINE.split("float3 Dec")[0], "EncodeNormal has no decoder"),
    "binary": (bytes(range(256)) * 40, "not text in UTF-8"),
    "nan": (changed("return sqrt(n.xy - 2.0);"), r"is \(nan, nan\), not finite"),
    "endless": (changed(ENDLESS), "do not end here"),
    "recurses": (changed("return EncodeNormal(n.yzx);"), "[Rr]ecursion"),
    "reads": (READS, "read a texture or a constant buffer"),
    "bomb": (BOMB + changed("float s = n.x; A14 return n.xy * s;"), KILLED),
    "deep": (changed(f"return {'(' * 30000}p{')' * 30000};"), KILLED),
}


def test_invalid_files_do_not_affect_the_others(run, tmp_path, ending):
    """One line reports each invalid file, and the rows of the other files are measured."""
    text = {name: text for name, (text, _) in WRONG.items()}
    text |= {"large": "// " + "x" * 3_000_000 + "\n" + MINE, "good": MINE}
    files = [str(tmp_path / written(tmp_path, each, f"{name}.{ending}")) for name, each in text.items()]
    status, out, err = run("quality", "--encoding", ",".join([*files, "hemi_octahedral"]), *QUICK)
    measured = {row["encoding"] for row in json.loads(out)}
    assert status == 0 and measured == {f"large.{ending}", f"good.{ending}", "hemi_octahedral"}
    lines = [line for line in err.splitlines() if "left out: " in line]
    assert len(lines) == len(WRONG) and "Traceback" not in err
    for name, (_, why) in WRONG.items():
        (line,) = [line for line in lines if f"/{name}.{ending}" in line.split(": ")[2]]
        assert re.search(why, line), line
