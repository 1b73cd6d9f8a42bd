"""Code of codecs: written in every language, run there, and equal to the catalogue's."""

import json
import re
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from languages import require_runner

import normalbench as nb
from normalbench.bench.door import code_command
from normalbench.bench.shaders.code.channels import Channels
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.kinds.normal import normals
from normalbench.bench.shaders.code.reference import reference
from normalbench.bench.shaders.code.run.interface import Ran
from normalbench.bench.shaders.code.tables import dds, header
from normalbench.bench.shaders.code.verify import agreement, compared
from normalbench.bench.subjects.codecs.names import codecs_named


def codec_of(name):
    (codec,) = codecs_named(*[*name.split("/"), "nearest"][:3])
    assert codec.fits, codec.misfit
    return codec


def written(folder: Path, code, text=None) -> Path:
    for name, data in code.files([]).items():
        (folder / name).write_bytes(data)
    if text is not None:
        (folder / code.name).write_text(text)
    return folder / code.name


@pytest.mark.parametrize("name", ["octahedral/rgb10a2", "xyz/rgba8_snorm", "octahedral/rg16f", "octahedral/rgb8_12_12"])
def test_the_reference_texels_hold_the_integers_that_the_python_interface_gives(name):
    """`nb.encode` computes the stored integers by itself."""
    codec = codec_of(name)
    expected = reference(codec)
    integers = np.asarray(nb.encode(codec, expected.n).integers)
    bits = [channel.bits for channel in Channels(codec).channels]
    assert np.array_equal(integers & (2 ** np.array(bits) - 1), expected.integers)


def test_the_reference_normals_are_unit_and_of_the_domain():
    """Axes and both zeros among them; z >= 0 for hemispheres, and towards the viewer for views."""
    for domain in ("sphere", "hemisphere", "view"):
        n, view = normals(domain)
        assert n.shape == view.shape == (2**16, 3)
        assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-6
    assert (normals("hemisphere")[0][:, 2] >= 0).all()
    n, view = normals("view")
    assert (np.sum(n * view, axis=1) <= 0).all()


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
    found = agreement(codec, "c", written(tmp_path, code, code.body.replace(old, new)), code.interface)
    assert not found.holds, found.says


def test_the_texel_of_a_known_normal_is_what_the_formula_gives():
    """(1, 0, 0) is (1, 0) in the octahedral map: 1023 and 511.5, of which the even neighbour is 512."""
    expected = reference(codec_of("octahedral/rgb10a2"))
    at = int(np.argmax((expected.n == (1.0, 0.0, 0.0)).all(axis=1)))
    assert expected.words[at, 0] == 1023 | 512 << 10


def test_a_table_is_a_dds_texture_of_floats():
    """Sizes and the format of DirectX 10 stand where Microsoft's guide puts them, the floats behind them."""
    table = np.arange(12, dtype=np.float32).reshape(2, 3, 2)
    data = dds(table)
    assert data[:4] == b"DDS " and struct.unpack_from("<2I", data, 12) == (2, 3)
    assert data[84:88] == b"DX10" and struct.unpack_from("<I", data, 128) == (16,)
    assert np.array_equal(np.frombuffer(data, "<f4", offset=148), table.ravel())


def test_a_table_is_an_array_of_c_in_the_same_order():
    """Every number stands in it with the digits that make the same float."""
    table = np.array([[[0.1], [1.0]], [[2.5], [1e-7]]], np.float32)
    numbers = re.findall(r"([-\d.e]+)f", header({"t": table}))
    assert np.array_equal(np.float32(numbers), table.ravel())


def test_a_texel_is_counted_once():
    """A byte has 256 texels, however many normals have them."""
    codec = codec_of("octahedral/unorm:4:4")
    expected = reference(codec)
    ran = Ran(expected.stored, expected.words, expected.stored, expected.decoded, expected.texels, expected.stored)
    found = compared(codec, expected, ran)
    assert found.holds and found.says.startswith(f"all {len(np.unique(expected.words))} texels of 65536 normals")
    assert len(np.unique(expected.words)) == 256


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
    """Functions that the catalogue does not use mean the same: mod of negatives, mix, step, sign, length, atan."""
    require_runner(language)
    (tmp_path / "many.glsl").write_text(MANY_WORDS)
    (codec,) = codecs_named(str(tmp_path / "many.glsl"), "rgb10a2", "nearest")
    code = code_of(codec, language, "p")
    found = agreement(codec, language, written(tmp_path, code), code.interface)
    assert found.holds, found.says


def test_a_file_of_glsl_may_do_without_the_view(run, tmp_path):
    """What is written can be measured as it is; encode alone may take the view."""
    code = code_of(codec_of("octahedral/rg8"), "glsl", "mine")
    path = written(tmp_path, code, code.body.replace("mine_encode(vec3 n)", "mine_encode(vec3 n, vec3 view)"))
    arguments = ("--storage", "rg8", "--normals", "axes", "--backend", "glsl", "--format", "json")
    status, out, err = run("quality", "--encoding", f"{path},octahedral", *arguments)
    assert (status, err) == (0, "")
    mine, ours = json.loads(out)
    assert (mine["mse"], mine["angle_max_deg"]) == (ours["mse"], ours["angle_max_deg"])


def test_code_of_a_user_is_the_users(run, tmp_path):
    """Its head names no licence for encode and decode, and the command that was typed."""
    (tmp_path / "many.glsl").write_text(MANY_WORDS)
    path, made = str(tmp_path / "many.glsl"), tmp_path / "made"
    status, _, err = run("code", path, "--storage", "rg8", "--to", "glsl", "-o", str(made))
    assert status == 0 and "left out: " not in err and "normal_halves(" in (made / "many_rg8.glsl").read_text()
    text = " ".join((made / "many_rg8.glsl").read_text().replace("//", "").split())
    assert "Encode and decode are yours." in text and f"normalbench code {path}" in text
    assert "the catalogue's" not in text


def test_a_header_of_c_can_be_included_twice_without_a_warning(tmp_path):
    """All warnings are errors; two codecs of one encoding stand next to each other."""
    require_runner("c")
    for storage in ("rgba8", "rgba16f"):
        written(tmp_path, code_of(codec_of(f"xyz_renormalised/{storage}"), "c", storage))
    lines = [f'#include "xyz_renormalised_{storage}.h"' for storage in ("rgba8", "rgba16f", "rgba8")]
    (tmp_path / "both.c").write_text("\n".join([*lines, "int main(void) { return 0; }", ""]))
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-c", "both.c", "-o", "both.o"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert not done.returncode, done.stderr


@pytest.mark.usefixtures("gl")
def test_check_says_of_every_language_how_many_texels_differ(run):
    """A row of each codec, a column of each language."""
    status, out, _ = run("code", "--check", "octahedral,spheremap", "--storage", "rgb10a2", "--to", "glsl,c")
    assert status == 0
    assert re.search(r"octahedral\s+rgb10a2\s+equal\s+equal", out) or "equal" in out
    assert re.search(r"spheremap\s.*\d+ of 65536", out)


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["octahedrl"], "octahedral"),
        (["octahedral", "--to", "cobol"], "unknown language 'cobol'"),
        (["octahedral", "--storage", "rg9"], "rg9"),
        (["octahedral,spheremap"], "name one with -o"),
        (["octahedral", "--to", "all"], "name one with -o"),
        (["octahedral", "-o", "x.hlsl"], "a folder"),
        (["octahedral/rgb8_12_12+xyz"], "chain"),
        (["octahedral:arithmetic=half"], "half arithmetic"),
        (["xyz", "--storage", "rg8"], "3 components"),
        (["spherical_lut", "--storage", "rg8"], "comes with look-up tables: name a folder"),
        (["xyz,octahedral", "--prefix", "same", "-o", "made"], "would collide"),
        (["xyz", "--prefix", "1x"], "a letter first"),
        (["xyz", "--prefix", "a b"], "single underscores"),
        (["xyz", "--prefix", "a__b"], "single underscores"),
        (["xyz", "--prefix", "gl_x"], "single underscores"),
        (["xyz", "--prefix", "x" * 61], "60 at most"),
    ],
)
def test_what_cannot_be_written_is_a_line_and_status_2(run, arguments, said, tmp_path, monkeypatch):
    """Bad names, several files without a folder, and what no language is written for."""
    monkeypatch.chdir(tmp_path)
    status, out, err = run("code", *arguments)
    assert (status, out) == (2, "")
    assert said in err and err.count("\n") == 1, err
    assert list(tmp_path.iterdir()) == []


@pytest.mark.usefixtures("gl")
@pytest.mark.parametrize(("languages", "wrong_in"), [("msl", "c"), ("glsl,msl", "glsl")])
def test_what_is_wrong_in_one_language_is_written_in_none(run, tmp_path, monkeypatch, languages, wrong_in):
    """All are written from one tree; Metal alone has C as its witness."""
    seen, own = [], code_command.verified

    def verified(code):
        seen.append(code.language)
        return own(code) | (
            {"verdict": code_command.DIFFERS, "says": "texels differ"} if code.language == wrong_in else {}
        )

    monkeypatch.setattr(code_command, "verified", verified)
    status, out, err = run("code", "octahedral", "--storage", "rg8", "--to", languages, "-o", str(tmp_path / "made"))
    assert (status, out) == (1, "") and "msl: its translation is seen to be wrong in" in err, err
    assert not list((tmp_path / "made").glob("*")) and wrong_in in seen
