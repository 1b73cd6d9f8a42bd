"""Code of codecs, written in every language, run there and compared with the catalogue."""

import re
from itertools import product
from pathlib import Path

import pytest
from languages import RUN, require_runner
from slowly import a_tenth
from test_code import codec_of, written
from typed import codecs_named, encodings_named

from normalbench.bench.door import code_command
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.verify import agreement
from normalbench.bench.tables.cost import measure as cost

# What is changed in the text of octahedral/rgb10a2 in C, and what must notice.
MUTANTS = {
    "scale": ("* 1023.0f)", "* 1022.0f)"),
    "rounding": ("rintf(", "floorf("),
    "order": ("x | (y << 10)", "y | (x << 10)"),
    "shift": ("y << 10", "y << 11"),
    "mask": ("(texel >> 10) & 1023u", "(texel >> 10) & 511u"),
    "bias": ("code.x * 0.5f + 0.5f, 0.0f", "code.x * 0.5f + 0.499f, 0.0f"),
    "fold": ("n.z < 0.0f", "n.z < 0.01f"),
    "target": ("{code.x * 0.5f + 0.5f, code.y", "{code.y * 0.5f + 0.5f, code.y"),
    "from target": ("texel.y * 2.0f - 1.0f", "texel.y * 2.0f"),
    "unpack": ("(1.0f / 1023.0f) * 2.0f - 1.0f;\n    float y", "(1.0f / 1024.0f) * 2.0f - 1.0f;\n    float y"),
    "decode": ("fabsf(e.x) - fabsf(e.y)", "fabsf(e.x) + fabsf(e.y)"),
}


@pytest.mark.parametrize("fault", MUTANTS)
def test_a_wrong_constant_or_a_swapped_number_is_noticed(fault, tmp_path):
    """Each fault alone makes the comparison fail."""
    codec = codec_of("octahedral/rgb10a2")
    code = code_of(codec, "c", "p")
    old, new = MUTANTS[fault]
    assert old in code.body, code.body
    verdict = agreement(codec, "c", written(tmp_path, code, code.body.replace(old, new)), code.interface)
    assert not verdict.holds, verdict.says


MANY_WORDS = """
#define SCALE 0.75
float halves(float x) { return mod(x + 3.0, 2.0) - 1.0; }
vec2 many_encode(vec3 n, vec3 view) {
    vec2 p = mix(n.xy, n.xy * SCALE, 0.25) * step(-2.0, n.z) + fract(vec2(0.0)) + vec2(sign(0.0));
    p /= max(length(vec3(p, n.z)), 0.001);
    p = mix(p, -p, lessThan(n.zz, vec2(-2.0)));
    for (int i = 0; i < 2; ++i) p[i] = clamp(p[i], -1.0, 1.0);
    if (n.z > 2.0) return vec2(halves(p.x), p.y); else if (n.z > 3.0) { return p.yx; }
    return p;
}
vec3 many_decode(vec2 e, vec3 view) {
    float z = sqrt(max(1.0 - dot(e, e), 0.0)), a = atan(e.y, e.x + 4.0);
    return vec3(e.x, e.y + 0.0 * a, z);
}
"""


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("language", ["hlsl", "essl", "wgsl", "c"])
def test_a_users_glsl_is_written_in_every_language(language, tmp_path):
    """Functions that the catalogue does not use have the same meaning: mod of negatives, mix, step, sign, length and
    atan."""
    require_runner(language)
    (tmp_path / "many.glsl").write_text(MANY_WORDS)
    (codec,) = codecs_named(str(tmp_path / "many.glsl"), "rgb10a2", "nearest")
    code = code_of(codec, language, "p")
    verdict = agreement(codec, language, written(tmp_path, code), code.interface)
    assert verdict.holds, verdict.says


def test_users_code_is_attributed_to_the_user(run, tmp_path):
    """The header claims no licence for encode and decode, and gives the command that was typed."""
    (tmp_path / "many.glsl").write_text(MANY_WORDS)
    path, folder = str(tmp_path / "many.glsl"), tmp_path / "made"
    status, _, err = run("code", path, "--storage", "rg8", "--to", "glsl", "-o", str(folder))
    assert status == 0 and "left out: " not in err and "normal_halves(" in (folder / "many_rg8.glsl").read_text()
    text = " ".join((folder / "many_rg8.glsl").read_text().replace("//", "").split())
    assert "Encode and decode are yours." in text and f"normalbench code {path}" in text
    assert "the catalogue's" not in text


@pytest.mark.usefixtures("gl")
def test_check_reports_how_many_texels_differ_in_each_language(run):
    """The table has a row per codec and a column per language."""
    status, out, _ = run("code", "--check", "octahedral,spheremap", "--storage", "rgb10a2", "--to", "glsl,c")
    assert status == 0
    assert re.search(r"octahedral\s+rgb10a2\s+equal\s+equal", out) or "equal" in out
    assert re.search(r"spheremap\s.*\d+ of 65536", out)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(("languages", "wrong_in"), [("msl", "c"), ("glsl,msl", "glsl")])
def test_a_wrong_translation_prevents_all_output_files(run, tmp_path, monkeypatch, languages, wrong_in):
    """All languages come from one syntax tree; Metal on its own is verified through C."""
    seen, own = [], code_command.verified

    def verified(code):
        seen.append(code.language)
        return own(code) | (
            {"verdict": code_command.DIFFERS, "says": "texels differ"} if code.language == wrong_in else {}
        )

    monkeypatch.setattr(code_command, "verified", verified)
    status, out, err = run("code", "octahedral", "--storage", "rg8", "--to", languages, "-o", str(tmp_path / "made"))
    assert (status, out) == (1, "") and "msl: its translation to " in err, err
    assert not list((tmp_path / "made").glob("*")) and wrong_in in seen


# One of each that is made otherwise: plain, precise, with a view, a sign, tables, levels, polynomials, an axis, a
# parameter, floats of each size, numbers across bytes, signed ones, the ways to round, centred numbers, floats of any
# form, signed integers over a power of two, words of 64 bits, and integers of 32.
CODECS = (
    "octahedral/rgb10a2",
    "octahedral_precise/rgb8_12_12_snorm",
    "per_pixel_view/rg16f",
    "xy_sign/rg8",
    "spherical_lut/rg8",
    "cube/rgba8_11_11_10/truncate",
    "tetrahedral/rgb8_10_10_2",
    "spherical:scale=0.9/rg16",
    "xyz_renormalised:axis=y/r11g11b10f",
    "spherical_fibonacci/rg8",
    "stereographic/rg16_snorm/truncate_half",
    "xyz/rgba32f",
    "hemi_octahedral/rgba16f/truncate",
    "octahedral/centred:8:8",
    "octahedral/float:4:3",
    "octahedral/ufloat:8:7/truncate",
    "octahedral_precise/snorm_full:8:7",
    "xyz/unorm:20:17:20",
    "cube/snorm:18:18:4/truncate",
    "octahedral/uint:16:16",
    "cube/sint:12:12:3/truncate",
)


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize("name, language", a_tenth(product(CODECS, RUN)))
def test_the_code_of_a_codec_gives_the_catalogues_texels(language, name, tmp_path):
    """Texels, decoded numbers and render targets are compared for 2^16 hard and random normals in each language."""
    require_runner(language)
    codec = codec_of(name)
    code = code_of(codec, language, "p")
    verdict = agreement(codec, language, written(tmp_path, code), code.interface)
    assert verdict.holds, verdict.says


INSTRUCTIONS = ("spheremap", "octahedral", "octahedral_precise", "best_fit_searched")


@pytest.mark.usefixtures("radv")
@pytest.mark.parametrize("language", ["glsl", "hlsl"])
def test_written_code_costs_as_much_as_the_catalogues_code(language, tmp_path):
    """Read back as a user's encoder, the written code takes as many instructions on RADV as the catalogue's code."""
    require_runner("hlsl")
    codecs = [codec_of(f"{name}/{'rgba8' if name == 'best_fit_searched' else 'rg8'}") for name in INSTRUCTIONS]
    files = [written(tmp_path, code_of(codec, language, f"my_{codec.encoding.name}")) for codec in codecs]
    mine = encodings_named(",".join(map(str, files)))
    encodings = [*mine, *(codec.encoding for codec in codecs)]
    counts = cost.counted(cost.cases(encodings, (), cost.OPERATIONS), "navi21", "fragment")
    for encoding, codec in zip(mine, codecs, strict=True):
        for operation in cost.OPERATIONS:
            count, ours = (counts[name, operation]["instructions"] for name in (encoding.name, codec.encoding.name))
            assert count == ours, f"{encoding.name} {operation}: {count} instructions, the catalogue's {ours}"


@pytest.mark.usefixtures("gl")
def test_code_prints_one_file_with_a_descriptive_header(run):
    """The header has the codec, its figures, the verification, the command and the licence; the functions follow."""
    status, out, err = run("code", "spheremap", "--storage", "rg8", "--to", "glsl", "--prefix", "sm")
    assert (status, err) == (0, "")
    head = " ".join(line.removeprefix("//").strip() for line in out.partition("\n\n")[0].splitlines())
    assert head.startswith("spheremap/rg8 in GLSL: sm_encode, sm_pack, sm_unpack, sm_decode;")
    assert re.search(
        r"mean 0\.492\d degrees, RMS 0\.719\d; supremum 11\.9\d degrees; largest sampled error in float32 22\.\d+", head
    )
    assert re.search(r"Instructions: \d+ to encode and \d+ to decode|Instructions: not counted", head)
    assert re.search(r"texels of (\d+ of )?65536 normals", head)
    assert "normalbench code spheremap --storage rg8 --to glsl --prefix sm" in head
    assert "MIT License" in head
    assert "vec2 sm_encode(vec3 n) {" in out


@pytest.mark.usefixtures("gl")
def test_code_writes_a_file_per_language_and_the_tables(run, tmp_path):
    """The C header and the shader textures are in the same folder."""
    status, _, err = run("code", "spherical_lut", "--storage", "rg8", "--to", "hlsl,c", "-o", str(tmp_path / "made"))
    assert status == 0, err
    assert "Table: normal_xy, 256 x 256 texels of R32G32_FLOAT, 512 kB." in _unwrapped(tmp_path / "made")
    names = {path.name for path in (tmp_path / "made").iterdir()}
    tables = {f"spherical_lut_rg8_{name}" for name in ("angle.dds", "xy.dds", "tables.h")}
    assert names == {"spherical_lut_rg8.hlsl", "spherical_lut_rg8.h", *tables}


def _unwrapped(folder: Path) -> str:
    return " ".join((folder / "spherical_lut_rg8.hlsl").read_text().replace("//", "").split())


@pytest.mark.usefixtures("gl")
def test_a_codec_is_measured_once_for_all_languages(run, tmp_path, monkeypatch):
    """The header of every file has the codec's figures."""
    seen, own = [], code_command.figures
    monkeypatch.setattr(code_command, "figures", lambda codec: seen.append(codec.name) or own(codec))
    words = ("octahedral,xy", "--storage", "rg8", "--to", "glsl,c,msl")
    assert run("code", *words, "-o", str(tmp_path / "codec"))[0] == 0
    assert seen == ["octahedral/rg8", "xy/rg8"]
    texts = [path.read_text() for path in (tmp_path / "codec").iterdir()]
    assert len(texts) == 6 and all("Error on " in text for text in texts)
