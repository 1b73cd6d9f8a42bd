"""`doctor FOLDER`: a made-up engine is read once and reported in one table; its patch is measured again."""

import json
import subprocess
import sys

import pytest

from normalbench.bench.door.cli import app as cli

pytestmark = pytest.mark.usefixtures("gl", "slang", "radv")

OCTAHEDRAL = """
float2 PackDir(float3 n) {
    float2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
    return n.z >= 0.0 ? p : (1.0 - abs(p.yx)) * signs_of(p);
}
float3 UnpackDir(float2 e) {
    float3 n = float3(e, 1.0 - abs(e.x) - abs(e.y));
    n.xy -= signs_of(n.xy) * max(-n.z, 0.0);
    return normalize(n);
}
"""
HALVES = OCTAHEDRAL[: OCTAHEDRAL.index("float3 Unpack")], OCTAHEDRAL[OCTAHEDRAL.index("float3 Unpack") :]
SIGNS = "float2 signs_of(float2 v) { return float2(v.x >= 0.0 ? 1.0 : -1.0, v.y >= 0.0 ? 1.0 : -1.0); }\n"
SPHEREMAP = """// Spheremap, as an old engine has it.\r
float2 EncodeNormal(float3 normal)\r
{\r
    return normal.xy / sqrt(normal.z * 8.0 + 8.0) + 0.5;\r
}\r
\r
float3 DecodeNormal(float2 enc)\r
{\r
    float2 fenc = enc * 4.0 - 2.0;\r
    float f = dot(fenc, fenc);\r
    return float3(fenc * sqrt(1.0 - f / 4.0), 1.0 - f / 2.0);\r
}\r
"""
TEMPLATE = """
vec2 encodeDir(vec3 n) { return n.xy * inversesqrt(n.z * 8.0 + 8.0) + 0.5; }
vec3 decodeDir(vec2 e) {
    vec2 f = e * 4.0 - 2.0;
    return vec3(f * sqrt(1.0 - dot(f, f) / 4.0), 1.0 - dot(f, f) / 2.0);
}
"""
WHOLE = SIGNS + OCTAHEDRAL
STRIDE = """namespace A.B
{
    shader Store : Base
    {
        override float3 EncodeNormal(float3 n) { return n * 0.5 + 0.5; }
        float3 DecodeNormal(float3 c) { return normalize(c * 2 - 1); }
    };
}
"""
READER = """float2 screen_of(float3 p) { return p.xy / p.z; }
float3 OtherNormal_Decode(float2 e) {
    float3 n = float3(e, 1.0 - abs(e.x) - abs(e.y));
    float k = max(-n.z, 0.0);
    n.x += n.x >= 0.0 ? -k : k;
    n.y += n.y >= 0.0 ? -k : k;
    return normalize(n);
}
"""
LOST = """#include "Packages/core/Packing.hlsl"
float2 EncodeNormal(float3 n) { return PackOct(n); }
float3 DecodeNormal(float2 e) { return UnpackOct(e); }
"""
# Half a sphere in 8 bits with a root of less than zero, a word of 32 bits, and depth over bytes by powers of 256.
PACKING = """
vec2 encodeDir(vec3 n) { return n.xy * 0.5 + 0.5; }
vec3 decodeDir(vec2 e) { vec2 p = e * 2.0 - 1.0; return vec3(p, sqrt(1.0 - dot(p, p))); }
uint packDirToUint(vec3 n) { return packSnorm2x16(n.xy); }
vec3 unpackDirFromUint(uint c) { vec2 p = unpackSnorm2x16(c); return vec3(p, sqrt(max(0.0, 1.0 - dot(p, p)))); }
vec4 packDepth(float d) {
    vec4 e = fract(vec4(1.0, 256.0, 65536.0, 16777216.0) * d);
    return e - e.yzww * vec4(1.0 / 256.0, 1.0 / 256.0, 1.0 / 256.0, 0.0);
}
float unpackDepth(vec4 c) { return dot(c, vec4(1.0, 1.0 / 256.0, 1.0 / 65536.0, 1.0 / 16777216.0)); }
"""
# A code of colours of three numbers, and a pair that turns a direction over next to one that is right.
COLOURS = """
float3 EncodeYCoCg(float3 c) {
    return float3(dot(c, float3(0.25, 0.5, 0.25)), 0.5 * (c.x - c.z), dot(c, float3(-0.25, 0.5, -0.25)));
}
float3 DecodeYCoCg(float3 c) { return float3(c.x + c.y - c.z, c.x + c.z, c.x - c.y - c.z); }
"""
BROKEN = """
float3 EncodeB(float3 n) { return n * 0.5 + 0.5; }
float3 DecodeB(float3 e) { e = e * 2.0 - 1.0; return normalize(float3(e.x, -e.y, e.z)); }
"""
FILES = {
    "deferred/pack.hlsl": WHOLE,
    "deferred/old.hlsl": SPHEREMAP,
    # Found from the top of the repository, as its author's compiler does.
    "deferred/modules.slang": "import common.signs;" + OCTAHEDRAL,
    "common/signs.slang": "module signs;\npublic " + SIGNS,
    "common/signs.slangh": SIGNS,
    "deferred/header.slang": '#include "../common/signs.slangh"' + OCTAHEDRAL,
    # Functions that have names of the language's, one that kills a compiler, and a word that none is given.
    "other/own.hlsl": "bool2 and(bool2 a, bool2 b) { return bool2(a.x && b.x, a.y && b.y); }\n" + WHOLE,
    "other/endless.slang": "float again(float x = again()) { return x; }\n" + WHOLE,
    "other/intrinsic.slang": "__intrinsic_op(cmpGT) bool above(float a, float b);\n" + WHOLE,
    "web/normals.js": f"import {{ x }} from './x.js';\nexport const glsl = /* glsl */`{TEMPLATE}`;\n",
    "web/build/made.js": f"export const glsl = /* glsl */`{TEMPLATE}`;\n",
    "stride/Store.sdsl": STRIDE,
    "split/write.hlsl": "float2 StoreNormal_Encode(float3 n) { return n.xy / sqrt(n.z * 8.0 + 8.0) + 0.5; }\n",
    "split/read.hlsl": READER,
    "lost/unity.hlsl": LOST,
    "post/packing.glsl": PACKING,
    "post/colours.hlsl": COLOURS,
    "deferred/without_end.hlsl": SPHEREMAP.rstrip().replace("\r", ""),
    "deferred/beside.hlsl": WHOLE + BROKEN,
    # Each folder has its own code by the same names.
    **{f"a/{name}.hlsl": SIGNS + body for name, body in zip(("write", "read"), HALVES, strict=True)},
    "b/write.hlsl": "float2 PackDir(float3 n) { return n.xy / sqrt(n.z * 8.0 + 8.0) + 0.5; }\n",
    "post/blur.hlsl": "float4 blur(float4 a, float4 b) { return 0.5 * (a + b); }\n",
}


@pytest.fixture(scope="module")
def engine(tmp_path_factory):
    folder = tmp_path_factory.mktemp("engine")
    for name, text in FILES.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode())
    (folder / ".git").mkdir()
    return folder


def doctor(folder, *words: str) -> list[dict]:
    file = folder.parent / f"{folder.name}.json"
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(sys, "argv", ["normalbench", "doctor", str(folder), *words, "-o", str(file)])
        assert cli.main() == 1
    return json.loads(file.read_text())


@pytest.fixture(scope="module")
def told(engine, tmp_path_factory):
    """Each file's row (the first if it has several), the patch, and all rows."""
    patch = tmp_path_factory.mktemp("patch") / "best.patch"
    rows = doctor(engine, "--diff", str(patch), "--report", str(patch.with_name("page.html")))
    return {row["file"]: row for row in reversed(rows)}, patch, rows


def test_each_pair_in_a_folder_has_a_row(told):
    """Code that a pair does not use is ignored; a decoder next to a function for something else is not a pair."""
    rows, _, _ = told
    octahedral = {name for name, row in rows.items() if row["mean_deg"] == pytest.approx(0.337, abs=0.001)}
    assert octahedral == {
        *("deferred/pack.hlsl", "deferred/modules.slang", "deferred/header.slang"),
        *("other/own.hlsl", "other/endless.slang", "other/intrinsic.slang"),
        *("deferred/beside.hlsl", "a/write.hlsl, a/read.hlsl"),
    }
    assert rows["stride/Store.sdsl"]["mean_deg"] == pytest.approx(0.170, abs=0.001)
    assert all(rows[name]["best"] == "octahedral" for name in ("deferred/old.hlsl", "web/normals.js"))
    assert rows["deferred/old.hlsl"]["mean_deg"] > 0.35
    assert not {"post/colours.hlsl", "web/build/made.js", "post/blur.hlsl", "common/signs.slang"} & {*rows}
    assert "OtherNormal_Decode matches the decoder of octahedral" in rows["split/read.hlsl"]["says"]
    assert not rows["split/read.hlsl"]["findings"]


def test_a_broken_pair_next_to_a_correct_pair_has_its_own_row(told):
    _, _, rows = told
    (row,) = [row for row in rows if row["functions"] == "EncodeB:DecodeB"]
    assert row["findings"] == 1 and "every direction comes back with y reversed" in row["says"]


def test_all_codes_in_a_file_have_a_line(told):
    """Lines cover measured normals, the effects of rounding, functions that the user must name, and depth."""
    _, _, rows = told
    lines = {row["functions"]: row["says"] for row in rows if row["file"] == "post/packing.glsl"}
    assert "rounded codes (3.3%) decode to NaN" in lines["encodeDir:decodeDir"]
    assert any("packDirToUint:unpackDirFromUint" in line and "only if named" in line for line in lines.values())
    depth = lines["packDepth:unpackDepth"]
    assert "not a multiple of 1/255; use powers of 255 instead of 256" in depth
    assert "`normalbench depth --depth" in depth


def test_a_compile_error_of_a_pair_names_the_missing_include(told):
    rows, _, _ = told
    message = rows["lost/unity.hlsl"]["says"]
    assert "PackOct" in message and "Packages/core/Packing.hlsl is not next to unity.hlsl" in message
    assert "--include Packages=FOLDER" in message and rows["lost/unity.hlsl"]["mean_deg"] is None


def test_the_patch_is_applied_and_measured_again(told, engine):
    """The patched HLSL file keeps its line endings and its scale to [0, 1]."""
    _, patch, _ = told
    subprocess.run(["git", "init", "-q"], cwd=engine, check=True)
    subprocess.run(["git", "apply", str(patch)], cwd=engine, check=True)
    assert (engine / "deferred/without_end.hlsl").read_text().endswith("}")
    text = (engine / "deferred/old.hlsl").read_bytes().decode()
    assert "nb_octahedral_write(normal) * 0.5 + 0.5" in text and "\n" not in text.replace("\r\n", "")
    (row,) = [row for row in doctor(engine) if row["functions"] == "EncodeNormal:DecodeNormal" and "old" in row["file"]]
    assert row["mean_deg"] == pytest.approx(0.336, abs=0.005) and row["best"] == "as good"
    page = patch.with_name("page.html").read_text()
    assert "nb_octahedral_write" in page and "deferred/old.hlsl" in page
