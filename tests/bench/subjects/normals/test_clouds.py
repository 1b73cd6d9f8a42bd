"""Point clouds as sets of normals, and Git LFS pointers in place of files."""

import struct

import numpy as np
import pytest
from manual import ROOT
from typed import normal_sets_named

from normalbench.bench.ground.options.option import Reading
from normalbench.bench.ground.output.errors import UsageError

CLOUD = ROOT / "tests" / "inputs" / "normals" / "points.ply"


POINTER = f"version https://git-lfs.github.com/spec/v1\noid sha256:{'0' * 64}\nsize 12345\n"


def normals_of(path, **reading):
    """Return the normals of a set, (count, 3)."""
    (cloud,) = normal_sets_named(str(path), 0, 0, Reading(**reading))
    chunk = cloud.chunk(0)
    return np.stack([np.asarray(component) for component in chunk.n], axis=1)[np.asarray(chunk.covered)]


@pytest.mark.parametrize("order", ["<", ">"])
def test_binary_clouds_are_read_like_text_clouds(tmp_path, order):
    """Capture options apply to binary clouds."""
    n = np.array([[0, 0, 1], [0, 0.6, 0.8], [-1, 0, 0]], np.float32)
    kind = {"<": "little", ">": "big"}[order]
    names = "".join(f"property float {name}\n" for name in ("nx", "ny", "nz"))
    path = tmp_path / "cloud.ply"
    head = f"ply\nformat binary_{kind}_endian 1.0\nelement vertex 3\n{names}element face 0\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + struct.pack(f"{order}9f", *n.ravel()))
    assert normals_of(path) == pytest.approx(n, abs=1e-6)
    with pytest.raises(UsageError, match="are not unit"):
        normals_of(path, unpack=True)


def test_a_cloud_without_normals_is_refused(tmp_path):
    path = tmp_path / "cloud.ply"
    path.write_text(CLOUD.read_text().replace(" nx", " ax"))
    with pytest.raises(UsageError, match="vertices with x, y, z and faces"):
        normals_of(path)


@pytest.mark.parametrize(
    "words, name",
    [
        (("quality", "--normals"), "mine.png"),
        (("quality", "--normals"), "mine.exr"),
        (("quality", "--normals"), "mine.npy"),
        (("quality", "--normals"), "mine.ply"),
        (("quality", "--mask", "mine.png", "--normals"), "mine.png"),
        (("quality", "--encoding"), "mine.glsl"),
        (("quality", "--encoding"), "mine.hlsl"),
        (("doctor",), "mine.wgsl"),
        (("frames", "--frames"), "mine.glb"),
        (("render", "--scene"), "mine.glb"),
        (("render", "--scene"), "mine.obj"),
        (("render", "--layout"), "mine.toml"),
        (("check",), "mine.toml"),
    ],
)
def test_git_lfs_pointer_is_a_one_line_error(run, tmp_path, monkeypatch, words, name):
    monkeypatch.chdir(tmp_path)
    (tmp_path / name).write_text(POINTER)
    status, out, err = run(*words, name)
    assert (status, out) == (2, "") and len(err.splitlines()) == 1, err
    assert name in err and "it is a Git LFS pointer: git lfs pull" in err
