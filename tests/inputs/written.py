"""Small files such as users have, written for tests: glTF and PNG follow their specifications."""

from __future__ import annotations

import base64
import json
import struct
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import OpenImageIO as oiio  # noqa: N813

NORMALS = np.array([(1, 2, 2), (1, 2, 2), (1, 2, 2)], np.float32)
TRIANGLE = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
POSITIONS = np.array([(1, 1, 2), (3, 0, 2), (1, 3, 1)], np.float32)


OBJ = """# a square of one quad, a triangle behind, one vertex index from each end
mtllib colours.mtl
v 0 0 0 1.0
v 2 0 0
v 2 2 0 0.5 0.5 0.5
v 0 2 0
vt 0 0
vn 0 0 2
usemtl red
f 1/1/1 2/1/1 3/1/1 \\
  4/1/1
usemtl blue
f -4//1 -3//-1 -2//1
"""


class Document:
    """A glTF document and its one buffer."""

    def __init__(self):
        self.json: dict[str, Any] = {"asset": {"version": "2.0"}, "accessors": [], "bufferViews": [], "meshes": []}
        self.json |= {"nodes": []}
        self.data = b""
        # Buffers beside the one that holds the data.
        self.others: list[dict[str, Any]] = []

    def accessor(self, values: np.ndarray, normalized: bool = False) -> int:
        """Add the numbers as an accessor with a view of its own."""
        kinds = {"f4": 5126, "u4": 5125, "u2": 5123, "u1": 5121, "i1": 5120, "i2": 5122}
        types = {1: "SCALAR", 2: "VEC2", 3: "VEC3", 4: "VEC4"}
        self.data += bytes(-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": values.nbytes}
        self.json["bufferViews"].append(view)
        width = values.shape[1] if values.ndim == 2 else 1
        entry = {"bufferView": len(self.json["bufferViews"]) - 1, "componentType": kinds[values.dtype.str[1:]]}
        entry |= {"count": len(values), "type": types[width], "normalized": normalized}
        self.json["accessors"].append(entry)
        self.data += values.tobytes()
        return len(self.json["accessors"]) - 1

    def view(self, data: bytes, **fields: Any) -> int:
        """Add a buffer view of these bytes."""
        self.data += bytes(-len(self.data) % 4)
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **fields})
        self.data += data
        return len(self.json["bufferViews"]) - 1

    def texture(self, picture: bytes | str, **sampler: Any) -> int:
        """Add a texture of an image's bytes or URI, with a sampler of its own if one is given."""
        image = {"uri": picture} if isinstance(picture, str) else {"bufferView": self.view(picture)}
        images, textures, samplers = (self.json.setdefault(name, []) for name in ("images", "textures", "samplers"))
        images.append(image)
        textures.append({"source": len(images) - 1})
        if sampler:
            samplers.append(sampler)
            textures[-1]["sampler"] = len(samplers) - 1
        return len(textures) - 1

    def material(self, **fields: Any) -> int:
        self.json.setdefault("materials", []).append(fields)
        return len(self.json["materials"]) - 1

    def mesh(self, positions, normals=None, triangles=None, **more: Any) -> int:
        """Add a mesh of one primitive; `more` are attributes, and "material" or "mode"."""
        attributes = {"POSITION": self.accessor(np.asarray(positions, np.float32))}
        if normals is not None:
            attributes["NORMAL"] = self.accessor(np.asarray(normals, np.float32))
        primitive: dict[str, Any] = {key: more.pop(key) for key in ("material", "mode") if key in more}
        attributes |= {name: self.accessor(np.asarray(values, np.float32)) for name, values in more.items()}
        if triangles is not None:
            primitive["indices"] = self.accessor(np.asarray(triangles, np.uint32).ravel())
        self.json["meshes"].append({"primitives": [primitive | {"attributes": attributes}]})
        return len(self.json["meshes"]) - 1

    def node(self, **fields: Any) -> int:
        self.json["nodes"].append(fields)
        return len(self.json["nodes"]) - 1

    def write(self, path: Path, how: str = "glb") -> Path:
        """Write the file: "glb", or glTF with its buffer "beside" it or as "data"."""
        uri = {"beside": {"uri": "a%20buffer.bin"}, "glb": {}}.get(how)
        if uri is None:
            uri = {"uri": "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()}
        text = json.dumps(self.json | {"buffers": [uri | {"byteLength": len(self.data)}, *self.others]}).encode()
        if how != "glb":
            (path.parent / "a buffer.bin").write_bytes(self.data)
            path.write_bytes(text)
            return path
        chunks = b""
        for kind, body in (
            (b"JSON", text + b" " * (-len(text) % 4)),
            (b"BIN\0", self.data + bytes(-len(self.data) % 4)),
        ):
            chunks += struct.pack("<I", len(body)) + kind + body
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks)
        return path


def chained() -> Document:
    """Return a child scaled by (-2, 1, 1/2) in a parent that turns by 90° about z and moves by (1, 2, 3)."""
    document = Document()
    mesh = document.mesh(POSITIONS, NORMALS, TANGENT=[(2, 1, -2, 1)] * 3, TEXCOORD_0=np.eye(3)[:, :2])
    child = document.node(mesh=mesh, scale=[-2, 1, 0.5])
    document.node(children=[child], rotation=[0, 0, 0.5**0.5, 0.5**0.5], translation=[1, 2, 3])
    return document


def png_bytes(pixels: np.ndarray, filters: list[int] | None = None, interlaced: int = 0) -> bytes:
    """Return a PNG file of uint8 or uint16 pixels (height, width, channels), its rows filtered in turn as listed."""
    height, width, channels = pixels.shape
    depth, step = pixels.itemsize * 8, pixels.itemsize * channels
    rows = np.frombuffer(pixels.astype(pixels.dtype.newbyteorder(">")).tobytes(), np.uint8).reshape(height, -1)
    kinds = [(filters or [0])[y % len(filters or [0])] for y in range(height)]
    above = np.zeros_like(rows[0])
    packed = bytearray()
    for kind, row in zip(kinds, rows, strict=True):
        packed += bytes([kind]) + (row.tobytes() if kind == 0 else _filtered(kind, row, above, step))
        above = row
    colour = {1: 0, 2: 4, 3: 2, 4: 6}[channels]
    head = struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, interlaced)
    parts = (b"IHDR", head), (b"IDAT", zlib.compress(bytes(packed))), (b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + b"".join(chunk(*part) for part in parts)


def chunk(kind: bytes, body: bytes) -> bytes:
    return struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))


def _filtered(kind: int, row: np.ndarray, above: np.ndarray, step: int) -> bytes:
    """Return one filtered row, byte by byte, as in the specification."""
    out = bytearray()
    for i, value in enumerate(row):
        a, b, c = (int(row[i - step]), int(above[i]), int(above[i - step])) if i >= step else (0, int(above[i]), 0)
        p = a + b - c
        nearest = min(((abs(p - a), 0, a), (abs(p - b), 1, b), (abs(p - c), 2, c)))[2]
        out.append((int(value) - (0, a, b, (a + b) // 2, nearest)[kind]) % 256)
    return bytes(out)


def as_document(meshes, materials=()) -> Document:
    document = Document()
    document.json["materials"] = [{"doubleSided": two_sided} for two_sided in materials]
    for index, mesh in enumerate(meshes):
        more = {"material": index} if materials else {}
        document.node(mesh=document.mesh(mesh.positions, mesh.normals, mesh.triangles, TEXCOORD_0=mesh.uv, **more))
    return document


def ply(order: str, faces: list[list[int]], vertices: np.ndarray = POSITIONS, normals: np.ndarray = NORMALS) -> bytes:
    """Return a PLY file with a column and an element that are not needed."""
    head = f"ply\nformat {order} 1.0\ncomment by a test\nelement vertex {len(vertices)}\n"
    head += "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz")) + "property uchar red\n"
    head += f"element edge 1\nproperty int a\nelement face {len(faces)}\nproperty list uchar int vertex_indices\n"
    rows = [(*map(float, (*p, *n)), 7) for p, n in zip(vertices, normals, strict=True)]
    if order == "ascii":
        lines = [" ".join(map(str, row)) for row in rows] + ["5"] + [" ".join(map(str, (len(f), *f))) for f in faces]
        return (head + "end_header\n" + "\n".join(lines) + "\n").encode()
    sign = "<" if "little" in order else ">"
    body = np.array(rows, [*((f"{i}", sign + "f4") for i in range(6)), ("red", "u1")]).tobytes()
    body += np.array([5], sign + "i4").tobytes()
    for face in faces:
        body += bytes([len(face)]) + np.array(face, sign + "i4").tobytes()
    return (head + "end_header\n").encode() + body


NAMED = {"float16": "half", "float32": "float", "float64": "double", "uint32": "uint"}


def image_spec(height: int, width: int, channels: list[tuple[str, Any]], **attributes) -> oiio.ImageSpec:
    """Return a specification for OpenImageIO: channels by name and type."""
    kinds = [oiio.TypeDesc(NAMED.get(str(kind), str(kind))) for _, kind in channels]
    spec = oiio.ImageSpec(width, height, len(channels), kinds[0])
    spec.channelnames, spec.channelformats = [name for name, _ in channels], kinds
    for key, value in ({"oiio:UnassociatedAlpha": 1} | attributes).items():
        spec.attribute(key, value)
    return spec


def write_image(path: Path, pixels: np.ndarray, **attributes) -> Path:
    """Write pixels, (height, width, channels), to a file with OpenImageIO."""
    file, names = oiio.ImageOutput.create(str(path)), "RGBA" if pixels.shape[2] > 1 else "Y"
    spec = image_spec(*pixels.shape[:2], [(name, pixels.dtype) for name in names[: pixels.shape[2]]], **attributes)
    assert file.open(str(path), spec) and file.write_image(pixels) and file.close(), file.geterror()
    return path


def write_exr(path: Path, planes: dict[str, Any], **attributes) -> Path:
    """Write an OpenEXR file with planes by name, or with several parts that each have such planes."""
    parts = planes if isinstance(next(iter(planes.values())), dict) else {"": planes}
    specs = []
    for name, part in parts.items():
        channels = [(channel, plane.dtype) for channel, plane in part.items()]
        named = {"oiio:subimagename": name} if name else {}
        specs.append(image_spec(*next(iter(part.values())).shape, channels, **named, **attributes))
        # All parts of a file have one display window.
        specs[-1].full_width, specs[-1].full_height = specs[0].width, specs[0].height
    file = oiio.ImageOutput.create(str(path))
    assert file.open(str(path), tuple(specs)), file.geterror()
    for number, (spec, part) in enumerate(zip(specs, parts.values(), strict=True)):
        assert number == 0 or file.open(str(path), spec, "AppendSubimage"), file.geterror()
        assert file.write_image(np.stack([*part.values()], axis=-1)), file.geterror()
    file.close()
    return path


def dds_bytes(pixels: np.ndarray) -> bytes:
    """Return a DDS file of uint8 pixels (height, width, 4), not compressed, as Direct3D's A8R8G8B8."""
    height, width, _ = pixels.shape
    masks = (0xFF0000, 0xFF00, 0xFF, 0xFF000000)
    head = struct.pack("<4s7I44x", b"DDS ", 124, 0x100F, height, width, 4 * width, 0, 0)
    head += struct.pack("<8I", 32, 0x41, 0, 32, *masks) + struct.pack("<5I", 0x1000, 0, 0, 0, 0)
    return head + pixels[..., [2, 1, 0, 3]].tobytes()


def planes_of(n: np.ndarray, names: tuple[str, ...] = ("N.X", "N.Y", "N.Z")) -> dict[str, np.ndarray]:
    return {name: n[..., axis] for axis, name in enumerate(names)}


def some_normals(seed: int = 0) -> np.ndarray:
    """Return unit normals, mostly towards the viewer, float32, (48, 64, 3)."""
    n = np.random.default_rng(seed).normal((0, 0, 2), size=(48, 64, 3))
    return (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)


def packed(n: np.ndarray, kind) -> np.ndarray:
    """Return normals as whole numbers; pixels without a normal are 0."""
    full = np.iinfo(kind).max
    stored = np.round((n.astype(np.float64) * 0.5 + 0.5) * full).astype(kind)
    stored[~n.any(axis=-1)] = 0
    return stored


def given(made) -> tuple[np.ndarray, np.ndarray]:
    """Return a set's normals, (count, 3), and which of them count."""
    chunks = [load() for load in made.loads()]
    n = np.concatenate([np.stack([np.asarray(p) for p in c.n], axis=-1) for c in chunks])
    return n[: made.count], np.concatenate([np.asarray(c.covered) for c in chunks])[: made.count]
