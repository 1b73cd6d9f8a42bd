"""Bad mesh files: each is a one-line error, and nothing outside its folder is read."""

import json
import os

import numpy as np
import pytest
from damaged import refusal
from written import NORMALS, POSITIONS, TRIANGLE, Document, chained, ply

from normalbench.gbuffer.scenes.files import source
from normalbench.gbuffer.scenes.files.read import read_mesh_file
from normalbench.gbuffer.scenes.files.source import SceneFileError


def broken(change) -> Document:
    document = chained()
    change(document.json)
    return document


def first_primitive(json):
    return json["meshes"][0]["primitives"][0]


def with_indices(document: Document, values) -> Document:
    first_primitive(document.json)["indices"] = document.accessor(np.array(values, np.uint32))
    return document


BAD_GLTF = {
    "an index out of range": (
        lambda: with_indices(chained(), [0, 1, 3]),
        ["index 2 refers to vertex 3", "there are 3"],
    ),
    "a cycle": (lambda: broken(lambda j: j["nodes"][0].update(children=[1])), ["nodes[0]", "cycle"]),
    "a node that is its own child": (
        lambda: broken(lambda j: j["nodes"].append({"children": [2]})),
        ["nodes[2]", "cycle"],
    ),
    "two parents": (lambda: broken(lambda j: j["nodes"].append({"children": [0]})), ["nodes[0]", "child of"]),
    "no such node": (lambda: broken(lambda j: j["nodes"][1].update(children=[7])), ["nodes[7]", "of nodes is 2"]),
    "a view beyond the buffer": (lambda: broken(lambda j: j["bufferViews"][0].update(byteLength=9999)), ["is cut off"]),
    "too many": (lambda: broken(lambda j: j["accessors"][0].update(count=10**9)), ["1000000000 vertices", "2^22"]),
    "a negative count": (lambda: broken(lambda j: j["accessors"][0].update(count=-1)), ["count is -1"]),
    "of another type": (lambda: broken(lambda j: j["accessors"][0].update(type="MAT4")), ["POSITION", "'MAT4'"]),
    "an extension that is not read": (
        lambda: broken(lambda j: j.update(extensionsRequired=["EXT_mesh_gpu_instancing"])),
        ["gpu_instancing", "without"],
    ),
    "glTF 1": (lambda: broken(lambda j: j["asset"].update(version="1.0")), ["'1.0'", "glTF 2.0"]),
    "no triangles": (lambda: broken(lambda j: first_primitive(j).update(mode=0)), ["nothing to draw"]),
    "no numbers": (lambda: broken(lambda j: j["nodes"][0].update(scale=["a", 1, 1])), ["nodes[0].scale", "3 numbers"]),
    "scaled to nothing": (lambda: broken(lambda j: j["nodes"][0].update(scale=[0, 0, 0])), ["nothing to draw"]),
    "an image on the network": (
        lambda: broken(lambda j: j.update(images=[{"uri": "https://example.org/a.png"}])),
        ["images[0]", "nothing is downloaded"],
    ),
    "not finite": (lambda: not_finite(), ["position of vertex 0", "nan"]),
}


def not_finite() -> Document:
    document = Document()
    document.node(mesh=document.mesh([(np.nan, 0, 0), *TRIANGLE[1:]]))
    return document


@pytest.mark.parametrize("what", BAD_GLTF)
def test_bad_gltf_is_a_one_line_error(tmp_path, run, what):
    make, parts = BAD_GLTF[what]
    err = refusal(run, make().write(tmp_path / "bad.glb"))
    assert all(part in err for part in parts), err


ADDRESSES = {
    "up": ("../secret.bin", "is outside the file's folder"),
    "up, hidden": ("inner/%2e%2e/%2E%2e/secret.bin", "is outside the file's folder"),
    "up, by backslashes": ("..\\secret.bin", "is outside the file's folder"),
    "absolute": ("/etc/hostname", "is outside the file's folder"),
    "absolute, hidden": ("%2Fetc/hostname", "is outside the file's folder"),
    "a link": ("link.bin", "is outside the file's folder"),
    "a link to a folder": ("folder/secret.bin", "is outside the file's folder"),
    "the network": ("http://example.org/a.bin", "nothing is downloaded"),
    "a share": ("//example.org/a.bin", "nothing is downloaded"),
    "a file address": ("file:///etc/hostname", "nothing is downloaded"),
    "a drive": ("C:/a.bin", "nothing is downloaded"),
    "a pipe": ("pipe", "not a plain file"),
    "the folder": (".", "it is a folder; name a file"),
    "missing": ("missing.bin", "no such file"),
    "bad base64": ("data:;base64,%%%", "data: address is damaged"),
    "no base64": ("data:,hello", "data: address is damaged"),
    "a zero": ("a\0b", "is outside the file's folder"),
}


@pytest.mark.parametrize("what", ADDRESSES)
def test_nothing_is_read_outside_the_folder_or_from_the_network(tmp_path, run, opened, what):
    address, reason = ADDRESSES[what]
    folder = tmp_path / "scene"
    folder.mkdir()
    (tmp_path / "secret.bin").write_bytes(bytes(999))
    (folder / "link.bin").symlink_to(tmp_path / "secret.bin")
    (folder / "folder").symlink_to(tmp_path)
    os.mkfifo(folder / "pipe")
    document = chained()
    text = json.dumps(document.json | {"buffers": [{"uri": address, "byteLength": len(document.data)}]})
    (folder / "a.gltf").write_text(text)
    (folder / "a.obj").write_text(f"mtllib {address.replace(chr(0), '')}\nv 0 0 0\n" if "link" in what else "f 1 2 3\n")
    opened.clear()
    for name in ("a.gltf", "a.obj") if "link" in what else ("a.gltf",):
        err = refusal(run, folder / name)
        assert reason in err, err
    assert opened and not any(name.endswith(("secret.bin", "hostname", "pipe")) for name in opened), opened


BAD_TEXTS = {
    "an OBJ index": ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", ["line 4", "index 4", "there are 3"]),
    "OBJ index 0": ("a.obj", "v 0 0 0\nf 0 1 1\n", ["line 2", "index 0"]),
    "an OBJ number": ("a.obj", "v 0 zero 0\n", ["line 1", "'zero'"]),
    "an OBJ line": ("a.obj", "vertex 0 0 0\n", ["line 1", "not a line of an OBJ file"]),
    "no faces": ("a.obj", "v 0 0 0\n", ["nothing to draw"]),
    "an OBJ NaN": ("a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", ["position of vertex 0", "nan"]),
    "an OBJ library outside": (
        "a.obj",
        "mtllib ../a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        ["is outside the file's folder"],
    ),
    "flat triangles": ("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", ["no triangle has an area"]),
    "no PLY": ("a.ply", "plywood", ["no PLY header"]),
    "a PLY without faces": (
        "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n0\n",
        ["faces"],
    ),
    "a PLY of too many": (
        "a.ply",
        ply("ascii", [[0, 1, 2]]).decode().replace("vertex 3", "vertex 99999999"),
        ["cut off"],
    ),
    "a PLY list counted by floats": (
        "a.ply",
        ply("ascii", [[0, 1, 2]]).decode().replace("list uchar", "list float"),
        ["a list count must be an integer"],
    ),
    "no glTF": ("a.gltf", "{", ["its JSON", "cannot be read"]),
    "a deep glTF": ("a.gltf", "[" * 100_000, ["its JSON", "cannot be read"]),
    "a glTF list": ("a.gltf", "[]", ["is not an object"]),
    "a PLY index": ("a.ply", ply("ascii", [[0, 1, 3]]).decode(), ["refers to vertex 3", "there are 3"]),
    "a negative PLY index": ("a.ply", ply("ascii", [[0, 1, -1]]).decode(), ["refers to vertex -1"]),
}


@pytest.mark.parametrize("what", BAD_TEXTS)
def test_bad_text_is_a_one_line_error(tmp_path, run, what):
    name, text, parts = BAD_TEXTS[what]
    (tmp_path / name).write_text(text)
    err = refusal(run, tmp_path / name)
    assert all(part in err for part in parts), err


@pytest.mark.parametrize("cut", [0, 3, 11, 19, 40, 300, -1])
def test_truncated_glb_is_a_one_line_error(tmp_path, run, cut):
    whole = chained().write(tmp_path / "a.glb").read_bytes()
    (tmp_path / "a.glb").write_bytes(whole[:cut])
    assert "export it again" in refusal(run, tmp_path / "a.glb")


def test_every_instance_of_a_mesh_counts_toward_the_limit(tmp_path, monkeypatch):
    """Ten nodes with the same mesh count ten times."""
    document = Document()
    mesh = document.mesh(POSITIONS, NORMALS)
    for _ in range(10):
        document.node(mesh=mesh)
    path = document.write(tmp_path / "a.glb")
    monkeypatch.setattr(source, "MAX_VERTICES", 29)
    with pytest.raises(SceneFileError, match="30 vertices"):
        read_mesh_file(path)


def test_two_files_with_the_same_name_are_refused(run, tmp_path):
    for folder in ("a", "b"):
        (tmp_path / folder).mkdir()
        chained().write(tmp_path / folder / "x.glb")
    both = ",".join(str(tmp_path / folder / "x.glb") for folder in ("a", "b"))
    for arguments in (("quality", "--normals", both), ("render", "--scene", both)):
        status, out, err = run(*arguments)
        if status != 3:
            assert (status, out) == (2, "") and "two files have the same name, x.glb" in err and err.count("\n") == 1
