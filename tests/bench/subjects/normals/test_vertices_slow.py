"""The vertex normals of a mesh as a set: each normal once, with the error of the file's rounding."""

import numpy as np
import pytest
from test_vertices import ball_of, directions, turned_deg, vertices
from written import Document

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.vec import Vec3


def test_meshoptimizers_map_is_read_from_the_file(tmp_path):
    """For an 8-bit map in bytes, neither the bits of the map nor the bytes alone explain the whole error."""
    pytest.importorskip("meshoptimizer")
    exact = directions(3000)
    square = np.stack([*ENCODINGS["octahedral"].encode(Vec3(*exact.T), Vec3(*exact.T))], axis=1)
    for bits, stride in ((8, 4), (6, 4), (10, 8)):
        full = 2 ** (bits - 1) - 1
        rows = np.concatenate([np.round(square * full), np.full((3000, 1), full), np.zeros((3000, 1))], axis=1)
        stored = rows.astype(np.int8 if stride == 4 else np.int16)
        loaded, normals = vertices(meshopt(stored, stride).write(tmp_path / f"{bits}.glb"))
        right = turned_deg(exact, normals)
        assert loaded.own_error_deg == pytest.approx(right, rel=0.06), (bits, loaded.own_error_deg, right)


def meshopt(stored: np.ndarray, stride: int) -> Document:
    """Return points whose normals are stored with the octahedral filter of EXT_meshopt_compression."""
    import meshoptimizer

    count = len(stored)
    data = bytes(meshoptimizer.encode_vertex_buffer(stored, count, stride))
    document = ball_of(np.zeros((count, 3), np.int8 if stride == 4 else np.int16))
    index = document.view(data)
    view = document.json["bufferViews"].pop(index)
    packed = {"buffer": 0, "byteOffset": view["byteOffset"], "byteLength": len(data), "count": count}
    packed |= {"byteStride": stride, "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL"}
    plain = {"buffer": 1, "byteLength": stride * count, "byteStride": stride}
    document.json["bufferViews"].append(plain | {"extensions": {"EXT_meshopt_compression": packed}})
    document.json["accessors"][-1]["bufferView"] = index
    document.others = [{"byteLength": stride * count}]
    document.json["extensionsRequired"].append("EXT_meshopt_compression")
    return document
