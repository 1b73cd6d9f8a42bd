"""Code of codecs, written in every language, run there and compared with the catalogue."""

import json
import re
import struct
import subprocess
from pathlib import Path

import numpy as np
import pytest
from languages import require_runner
from typed import codecs_named

import normalbench as nb
from normalbench.bench.shaders.code.channels import Channels
from normalbench.bench.shaders.code.files import code_of
from normalbench.bench.shaders.code.kinds.normal import normals
from normalbench.bench.shaders.code.reference import reference
from normalbench.bench.shaders.code.run.interface import Ran
from normalbench.bench.shaders.code.tables import dds, header
from normalbench.bench.shaders.code.verify import compared


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
def test_reference_texels_match_the_integers_from_the_python_interface(name):
    """`nb.encode` computes the stored integers independently."""
    codec = codec_of(name)
    expected = reference(codec)
    integers = np.asarray(nb.encode(codec, expected.n).integers)
    bits = [channel.bits for channel in Channels(codec).channels]
    assert np.array_equal(integers & (2 ** np.array(bits) - 1), expected.integers)


def test_reference_normals_are_unit_vectors_in_the_domain():
    """Normals of the hemisphere have z >= 0, and normals for views face the viewer."""
    for domain in ("sphere", "hemisphere", "view"):
        n, view = normals(domain)
        assert n.shape == view.shape == (2**16, 3)
        assert np.abs(np.linalg.norm(n, axis=1) - 1).max() < 1e-6
    assert (normals("hemisphere")[0][:, 2] >= 0).all()
    n, view = normals("view")
    assert (np.sum(n * view, axis=1) <= 0).all()


def test_the_texel_of_a_known_normal_matches_the_formula():
    """(1, 0, 0) maps to (1, 0) in the octahedral encoding: 1023 and 511.5, which rounds to the even 512."""
    expected = reference(codec_of("octahedral/rgb10a2"))
    index = int(np.argmax((expected.n == (1.0, 0.0, 0.0)).all(axis=1)))
    assert expected.words[index, 0] == 1023 | 512 << 10


def test_a_table_is_a_dds_texture_of_floats():
    """The sizes and the Direct3D 10 format are at the offsets of Microsoft's guide, followed by the floats."""
    table = np.arange(12, dtype=np.float32).reshape(2, 3, 2)
    data = dds(table)
    assert data[:4] == b"DDS " and struct.unpack_from("<2I", data, 12) == (2, 3)
    assert data[84:88] == b"DX10" and struct.unpack_from("<I", data, 128) == (16,)
    assert np.array_equal(np.frombuffer(data, "<f4", offset=148), table.ravel())


def test_table_is_a_c_array_in_the_same_order():
    """Every number has enough digits to give the same float."""
    table = np.array([[[0.1], [1.0]], [[2.5], [1e-7]]], np.float32)
    numbers = re.findall(r"([-\d.e]+)f", header({"t": table}))
    assert np.array_equal(np.float32(numbers), table.ravel())


def test_a_texel_is_counted_once():
    """Two 4-bit channels have 256 texels, however many normals share them."""
    codec = codec_of("octahedral/unorm:4:4")
    expected = reference(codec)
    ran = Ran(expected.stored, expected.words, expected.stored, expected.decoded, expected.texels, expected.stored)
    verdict = compared(codec, expected, ran)
    assert verdict.holds and verdict.says.startswith(f"all {len(np.unique(expected.words))} texels of 65536 normals")
    assert len(np.unique(expected.words)) == 256


def test_decode_in_a_glsl_file_may_omit_the_view(run, tmp_path):
    """The written file can be measured if only encode takes the view."""
    code = code_of(codec_of("octahedral/rg8"), "glsl", "mine")
    path = written(tmp_path, code, code.body.replace("mine_encode(vec3 n)", "mine_encode(vec3 n, vec3 view)"))
    arguments = ("--storage", "rg8", "--normals", "axes", "--backend", "glsl", "--format", "json")
    status, out, err = run("quality", "--encoding", f"{path},octahedral", *arguments)
    assert (status, err) == (0, "")
    mine, ours = json.loads(out)
    assert (mine["mse"], mine["angle_max_deg"]) == (ours["mse"], ours["angle_max_deg"])


def test_a_c_header_can_be_included_twice_without_a_warning(tmp_path):
    """Warnings are errors, and the file includes two codecs of the same encoding."""
    require_runner("c")
    for storage in ("rgba8", "rgba16f"):
        written(tmp_path, code_of(codec_of(f"xyz_renormalised/{storage}"), "c", storage))
    lines = [f'#include "xyz_renormalised_{storage}.h"' for storage in ("rgba8", "rgba16f", "rgba8")]
    (tmp_path / "both.c").write_text("\n".join([*lines, "int main(void) { return 0; }", ""]))
    command = ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-c", "both.c", "-o", "both.o"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True)
    assert not done.returncode, done.stderr


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
        (["spherical_lut", "--storage", "rg8"], "comes with lookup table files; name a folder"),
        (["xyz,octahedral", "--prefix", "same", "-o", "made"], "would collide"),
        (["xyz", "--prefix", "1x"], "beginning with a letter"),
        (["xyz", "--prefix", "a b"], "single underscores"),
        (["xyz", "--prefix", "a__b"], "single underscores"),
        (["xyz", "--prefix", "gl_x"], "single underscores"),
        (["xyz", "--prefix", "x" * 61], "at most 60 letters"),
    ],
)
def test_unsupported_request_is_a_one_line_error_with_status_2(run, arguments, said, tmp_path, monkeypatch):
    """Requests include bad names, several files without a folder and codecs that no language supports."""
    monkeypatch.chdir(tmp_path)
    status, out, err = run("code", *arguments)
    assert (status, out) == (2, "")
    assert said in err and err.count("\n") == 1, err
    assert list(tmp_path.iterdir()) == []
