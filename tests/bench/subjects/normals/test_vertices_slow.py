"""The normals of a mesh's vertices as a set: which there are, once each, and what their file's rounding has cost."""

import numpy as np
import pytest
from test_vertices import ball_of, directions, turned_deg, vertices
from written import Document

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.vec import Vec3


def test_meshopts_map_is_read_from_the_file(tmp_path):
    """8 bits of a map in bytes: neither number alone says all of the error."""
    pytest.importorskip("meshoptimizer")
    exact = directions(3000)
    square = np.stack([*ENCODINGS["octahedral"].encode(Vec3(*exact.T), Vec3(*exact.T))], axis=1)
    for bits, stride in ((8, 4), (6, 4), (10, 8)):
        one = 2 ** (bits - 1) - 1
        rows = np.concatenate([np.round(square * one), np.full((3000, 1), one), np.zeros((3000, 1))], axis=1)
        stored = rows.astype(np.int8 if stride == 4 else np.int16)
        made, found = vertices(meshopt(stored, stride).write(tmp_path / f"{bits}.glb"))
        right = turned_deg(exact, found)
        assert made.own_error_deg == pytest.approx(right, rel=0.06), (bits, made.own_error_deg, right)


def meshopt(stored: np.ndarray, stride: int) -> Document:
    """Points whose normals lie in a file by EXT_meshopt_compression's octahedral filter."""
    import meshoptimizer

    count = len(stored)
    data = bytes(meshoptimizer.encode_vertex_buffer(stored, count, stride))
    document = ball_of(np.zeros((count, 3), np.int8 if stride == 4 else np.int16))
    at = document.view(data)
    view = document.json["bufferViews"].pop(at)
    packed = {"buffer": 0, "byteOffset": view["byteOffset"], "byteLength": len(data), "count": count}
    packed |= {"byteStride": stride, "mode": "ATTRIBUTES", "filter": "OCTAHEDRAL"}
    plain = {"buffer": 1, "byteLength": stride * count, "byteStride": stride}
    document.json["bufferViews"].append(plain | {"extensions": {"EXT_meshopt_compression": packed}})
    document.json["accessors"][-1]["bufferView"] = at
    document.others = [{"byteLength": stride * count}]
    document.json["extensionsRequired"].append("EXT_meshopt_compression")
    return document
