"""glTF files with packed meshes: the same meshes as from plain files, or a one-line error."""

import sys
from dataclasses import replace

import numpy as np
import pytest
from damaged import mutated
from written import Document

from normalbench.gbuffer.scenes.files.read import read_mesh_file
from normalbench.gbuffer.scenes.files.source import SceneFileError
from normalbench.gbuffer.scenes.mesh import Mesh, sphere

WHOLE = sphere(1.0, 12, 6)
# Without the triangles at its poles that have no area.
AREA = np.linalg.norm(np.cross(*np.diff(WHOLE.positions[WHOLE.triangles], axis=1).swapaxes(0, 1)), axis=1)
BALL = replace(WHOLE, triangles=WHOLE.triangles[AREA > 1e-6])
DRACO, MESHOPT = "KHR_draco_mesh_compression", "EXT_meshopt_compression"


def plain() -> Document:
    document = Document()
    document.node(mesh=document.mesh(BALL.positions, BALL.normals, BALL.triangles, TEXCOORD_0=BALL.uv))
    return document


def read(document: Document, tmp_path) -> Mesh:
    return read_mesh_file(document.write(tmp_path / "a.glb")).pieces[0].mesh


def corners(mesh: Mesh) -> np.ndarray:
    """Return the corners of all triangles, (triangles, 24), in an order that does not depend on that of the file."""
    vertices = np.concatenate([mesh.positions, mesh.normals, mesh.uv], axis=1)[mesh.triangles]
    # The uv tell a ball's vertices apart: each triangle starts by the one of the least.
    first = np.argmin(vertices[..., 6] + 100 * vertices[..., 7], axis=1)
    turned = np.stack(
        [np.take_along_axis(vertices, ((first + k) % 3)[:, None, None], axis=1)[:, 0] for k in range(3)], axis=1
    )
    rows = turned.reshape(-1, 24)
    return rows[np.lexsort(np.round(rows[:, [6, 7, 14, 15, 22, 23]], 3).T)]


# Quantised


@pytest.mark.parametrize("kind", [np.uint16, np.int16, np.uint8, np.int8])
@pytest.mark.parametrize("is_normalised", [True, False])
def test_quantised_attributes_are_decoded_as_specified(tmp_path, kind, is_normalised):
    """KHR_mesh_quantization: positions and uv as integers, plain or as shares of the largest; normals and tangents as
    signed shares. The remaining error is half a step."""
    most = np.iinfo(kind).max
    step = 1 / most if is_normalised else 1.0
    low = 0 if np.iinfo(kind).min == 0 else -1
    stored = np.round((BALL.positions - low) / (1 - low) * most).astype(kind)
    signed = np.dtype(kind.__name__.removeprefix("u"))
    short = np.round(BALL.normals * np.iinfo(signed).max).astype(signed)
    document = plain()
    attributes = document.json["meshes"][0]["primitives"][0]["attributes"]
    attributes["POSITION"] = document.accessor(stored, normalized=is_normalised)
    attributes["NORMAL"] = document.accessor(short, normalized=True)
    attributes["TEXCOORD_0"] = document.accessor(np.round(BALL.uv * most).astype(kind), normalized=is_normalised)
    document.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    mesh = read(document, tmp_path)
    assert np.allclose(mesh.positions, stored.astype(float) * step, atol=1e-12)
    assert np.allclose(mesh.uv * (1 if is_normalised else 1 / most), BALL.uv, atol=0.51 / most)
    assert np.sum(mesh.normals * BALL.normals, axis=1).min() > np.cos(2 / np.iinfo(signed).max)


# EXT_meshopt_compression

meshoptimizer = pytest.importorskip("meshoptimizer")


def meshopt(change=None, required: bool = True) -> Document:
    """Return the ball in meshopt form: floats and triangles packed, with the plain copy in a missing buffer."""
    document = plain()
    plain_data, packed = document.data, []
    document.data = b""
    for index, view in enumerate(document.json["bufferViews"]):
        body = plain_data[view["byteOffset"] : view["byteOffset"] + view["byteLength"]]
        accessor = document.json["accessors"][index]
        triangles = accessor["type"] == "SCALAR"
        stride = 4 if triangles else {"VEC3": 12, "VEC2": 8}[accessor["type"]]
        encode = meshoptimizer.encode_index_buffer if triangles else meshoptimizer.encode_vertex_buffer
        if triangles:
            data = encode(np.frombuffer(body, np.uint32), accessor["count"], len(BALL.positions))
        else:
            data = encode(np.frombuffer(body, np.float32).reshape(accessor["count"], -1), accessor["count"], stride)
        packed.append(bytes(data))
        fields = {"count": accessor["count"], "byteStride": stride, "mode": "TRIANGLES" if triangles else "ATTRIBUTES"}
        place = {"buffer": 0, "byteOffset": len(document.data), "byteLength": len(data)}
        document.data += bytes(data) + bytes(-len(data) % 4)
        view |= {"buffer": 1, "extensions": {MESHOPT: fields | place}}
    if required:
        document.json["extensionsRequired"] = [MESHOPT]
    if change:
        change(document.json["bufferViews"][0]["extensions"][MESHOPT], document)
    document.others = [{"byteLength": len(plain_data), "extensions": {MESHOPT: {"fallback": True}}}]
    return document


@pytest.mark.parametrize("required", [True, False])
def test_meshopt_gives_the_same_mesh_as_the_plain_file(tmp_path, required):
    """The extension may also be optional, without a plain copy."""
    unpacked, expected = (corners(read(document, tmp_path)) for document in (meshopt(required=required), plain()))
    assert np.array_equal(unpacked, expected)


def filtered(name: str, stored: np.ndarray, width: int, components: int, normalised: bool) -> Document:
    """Return the ball with normals packed through a filter."""
    document = plain()
    data = bytes(meshoptimizer.encode_vertex_buffer(stored, len(stored), stored.itemsize * stored.shape[1]))
    stride = stored.itemsize * stored.shape[1]
    fields = {"count": len(stored), "byteStride": stride, "mode": "ATTRIBUTES", "filter": name}
    index = document.view(data)
    view = document.json["bufferViews"].pop(index)
    packed = {"buffer": 0, "byteOffset": view["byteOffset"], "byteLength": len(data)}
    document.json["bufferViews"].append(
        {
            "buffer": 1,
            "byteLength": stride * len(stored),
            "byteStride": stride,
            "extensions": {MESHOPT: fields | packed},
        }
    )
    accessor = {"bufferView": index, "componentType": components, "count": len(stored), "type": f"VEC{width}"}
    document.json["accessors"].append(accessor | {"normalized": normalised})
    document.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = len(document.json["accessors"]) - 1
    document.others = [{"byteLength": stride * len(stored)}]
    return document


def test_the_octahedral_filter_gives_normals(tmp_path):
    """The extension specifies x and y of the octahedron, and 1 as the third number, as signed bytes."""
    n = BALL.normals / abs(BALL.normals).sum(axis=1, keepdims=True)
    folded = (1 - abs(n[:, 1::-1])) * np.where(n[:, :2] < 0, -1, 1)
    xy = np.where(n[:, 2:] < 0, folded, n[:, :2])
    stored = np.round(np.concatenate([xy, np.ones_like(xy[:, :1]), 0 * xy[:, :1]], axis=1) * 127).astype(np.int8)
    mesh = read(filtered("OCTAHEDRAL", stored, 3, 5120, True), tmp_path)
    assert np.sum(mesh.normals * BALL.normals, axis=1).min() > np.cos(np.radians(1.2))


def test_the_exponential_filter_gives_floats(tmp_path):
    """The extension specifies a 24-bit integer, times 2 to the power of an 8-bit exponent."""
    exponent = -20
    whole = np.round(BALL.normals * 2.0**-exponent).astype(np.int64)
    stored = ((exponent & 255) << 24 | (whole & 0xFFFFFF)).astype(np.uint32)
    mesh = read(filtered("EXPONENTIAL", stored, 3, 5126, False), tmp_path)
    assert np.allclose(mesh.normals, BALL.normals, atol=2.0**-20)


BAD_MESHOPT = {
    "a stride": (lambda e, _: e.update(byteStride=6), ["elements of 6 bytes", "not supported"]),
    "a mode": (lambda e, _: e.update(mode="POINTS"), ["'POINTS'"]),
    "a filter": (lambda e, _: e.update(filter="OCTAHEDRAL"), ["elements of 12 bytes", "'OCTAHEDRAL'"]),
    "too many": (lambda e, _: e.update(count=10**9), ["unpacks to 12000000000 bytes"]),
    "too few": (lambda e, _: e.update(count=3), ["cannot be unpacked"]),
    "cut off": (lambda e, _: e.update(byteLength=20), ["cannot be unpacked by EXT_meshopt_compression"]),
    "no count": (lambda e, _: e.pop("count"), ["count is None"]),
    "beyond the buffer": (lambda e, _: e.update(byteOffset=10**6), ["cut off"]),
}


@pytest.mark.parametrize("what", BAD_MESHOPT)
def test_bad_meshopt_view_is_a_one_line_error(tmp_path, what):
    change, parts = BAD_MESHOPT[what]
    with pytest.raises(SceneFileError) as refusal:
        read(meshopt(change), tmp_path)
    assert all(part in str(refusal.value) for part in ("a.glb", *parts)) and "\n" not in str(refusal.value)


# KHR_draco_mesh_compression


def draco(change=None) -> Document:
    import DracoPy

    document = plain()
    data = DracoPy.encode(
        BALL.positions.astype(np.float32),
        BALL.triangles.astype(np.uint32),
        preserve_order=True,
        normals=BALL.normals,
        tex_coord=BALL.uv,
        quantization_bits=16,
    )
    unique_ids = {int(a["attribute_type"]): a["unique_id"] for a in DracoPy.decode(data).attributes}
    primitive = document.json["meshes"][0]["primitives"][0]
    ids = {"POSITION": unique_ids[0], "NORMAL": unique_ids[1], "TEXCOORD_0": unique_ids[3]}
    primitive["extensions"] = {DRACO: {"bufferView": document.view(data), "attributes": ids}}
    points = len(DracoPy.decode(data).points)
    for name in ids:
        accessor = document.json["accessors"][primitive["attributes"][name]]
        accessor.pop("bufferView")
        accessor["count"] = points
    document.json["accessors"][primitive["indices"]].pop("bufferView")
    document.json["extensionsRequired"] = [DRACO]
    if change:
        change(document, primitive)
    return document


def test_draco_gives_the_same_mesh_as_the_plain_file(tmp_path):
    """The meshes agree within the quantisation: 16 bits for positions and uv, 8-bit octahedral normals by default."""
    unpacked, expected = (corners(read(document, tmp_path)) for document in (draco(), plain()))
    assert unpacked.shape == expected.shape
    apart = abs(unpacked - expected).reshape(-1, 8)
    assert apart[:, [0, 1, 2, 6, 7]].max() < 5e-5 and apart[:, 3:6].max() < 0.03, apart.max(axis=0)


def test_a_draco_file_with_a_plain_copy_is_read_without_its_package(tmp_path, monkeypatch):
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    document = plain()
    primitive = document.json["meshes"][0]["primitives"][0]
    primitive["extensions"] = {DRACO: {"bufferView": 0, "attributes": {"POSITION": 0}}}
    document.json["extensionsUsed"] = [DRACO]
    assert np.array_equal(corners(read(document, tmp_path)), corners(read(plain(), tmp_path)))


BAD_DRACO = {
    "cut off": (lambda d, _: d.json["bufferViews"][-1].update(byteLength=5), ["is cut off"]),
    "halved": (lambda d, _: d.json["bufferViews"][-1].update(byteLength=60), ["cannot be unpacked by KHR_draco"]),
    "another file": (lambda _, p: p["extensions"][DRACO].update(bufferView=0), ["is not a Draco 2.2 mesh"]),
    "an attribute": (lambda _, p: p["extensions"][DRACO]["attributes"].update(NORMAL=9), ["no attribute 9", "NORMAL"]),
    "a count": (lambda d, _: d.json["accessors"][0].update(count=3), ["POSITION", "not 3 x 3"]),
    "no view": (lambda _, p: p["extensions"][DRACO].pop("bufferView"), ["bufferViews[None]"]),
    "too many": (lambda d, _: many_triangles(d), ["triangles and", "export fewer objects"]),
}


def many_triangles(document: Document) -> None:
    """Write 2^35 vertices into the header."""
    offset = document.json["bufferViews"][-1]["byteOffset"] + 10
    head = document.data[: offset + 1]
    document.data = head + b"\xff\xff\xff\xff\x7f" + document.data[offset + 6 :]


@pytest.mark.parametrize("what", BAD_DRACO)
def test_bad_draco_primitive_is_a_one_line_error(tmp_path, what):
    change, parts = BAD_DRACO[what]
    with pytest.raises(SceneFileError) as refusal:
        read(draco(change), tmp_path)
    assert all(part in str(refusal.value) for part in ("a.glb", *parts)) and "\n" not in str(refusal.value)


# Both


@pytest.mark.parametrize("make, package", [(draco, "DracoPy"), (meshopt, "meshoptimizer")])
def test_missing_package_error_says_what_to_install(tmp_path, monkeypatch, make, package):
    document = make()
    monkeypatch.setitem(sys.modules, package, None)
    with pytest.raises(SceneFileError, match=rf"a\.glb: .*needs {package}; pip install normalbench\[compressed\]"):
        read(document, tmp_path)


@pytest.mark.parametrize("make", [draco, meshopt])
def test_damaged_packed_files_are_read_or_refused(tmp_path, make):
    """Only the packed data are damaged."""
    document = make()
    rng = np.random.default_rng(0)
    whole, refused = document.data, 0
    for _ in range(60):
        document.data = mutated(whole, rng)
        try:
            read(document, tmp_path)
        except SceneFileError as error:
            refused += 1
            assert "\n" not in str(error)
    assert refused > 10, refused


def test_missing_package_gives_exit_status_3(tmp_path, monkeypatch, run):
    """The status is the same as for other missing packages."""
    path = draco().write(tmp_path / "a.glb")
    monkeypatch.setitem(sys.modules, "DracoPy", None)
    status, out, err = run("quality", "--normals", str(path), "--backend", "jax")
    assert (status, out) == (3, "") and err.count("\n") == 1
    assert err == f"normalbench: {path}: meshes[0].primitives[0] needs DracoPy; pip install normalbench[compressed]\n"
