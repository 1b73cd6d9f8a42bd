"""Data packed with two glTF extensions: primitives with KHR_draco_mesh_compression, buffer views with
EXT_meshopt_compression.

Each extension is unpacked by its own package, which is imported when a file needs it. The size of the result is
bounded before unpacking starts.
"""

from __future__ import annotations

import struct
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from .source import MAX_TRIANGLES, MAX_VERTICES, MissingPackageError

if TYPE_CHECKING:
    from .gltf_data import Gltf, Object

DRACO, MESHOPT = "KHR_draco_mesh_compression", "EXT_meshopt_compression"
INSTALL = "pip install normalbench[compressed]"
# Of a Draco file: its version (glTF has 2.2 alone), a mesh, and how its triangles are packed.
DRACO_HEAD = struct.Struct("<5sBBBBH")
DRACO_VERSION, DRACO_MESH, SEQUENTIAL, EDGEBREAKER, HAS_METADATA = (2, 2), 1, 0, 1, 0x8000
# Bytes of an element that each filter takes.
FILTERS = {"OCTAHEDRAL": ("oct", (4, 8)), "QUATERNION": ("quat", (8,)), "EXPONENTIAL": ("exp", range(4, 257, 4))}
MODES = {"ATTRIBUTES": range(4, 257, 4), "TRIANGLES": (2, 4), "INDICES": (2, 4)}


def _package(gltf: Gltf, name: str, place: str) -> Any:
    """Import and return an optional package. Raises MissingPackageError if it is not installed."""
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingPackageError(f"{gltf.path}: {place} needs {name}; {INSTALL}") from error


# EXT_meshopt_compression


def unpacked_view(gltf: Gltf, packed: Object, data: memoryview, most: int, place: str) -> tuple[bytes, int | None]:
    """Return a buffer view's bytes and the bits of its octahedral encoding; the bits are None for any other packing.

    Args:
        packed: the view's extension object.
        data: the packed bytes to which the extension refers.
        most: maximum number of bytes after unpacking.

    Raises:
        SceneFileError: the view is damaged or too large, or its package is missing (MissingPackageError).
    """
    mode, sieve = packed.get("mode"), packed.get("filter", "NONE")
    count, stride = (gltf.whole(packed, key, f"{place}.{MESHOPT}") for key in ("count", "byteStride"))
    sizes = MODES.get(mode, ()) if isinstance(mode, str) else ()
    name, filtered = FILTERS.get(sieve, (None, ())) if isinstance(sieve, str) else (None, ())
    if stride not in sizes or (sieve != "NONE" and (mode != "ATTRIBUTES" or stride not in filtered)):
        raise gltf.error(
            place, f"packs elements of {stride} bytes with mode {mode!r} and filter {sieve!r}, which is not supported"
        )
    if count * stride > most:
        raise gltf.error(place, f"unpacks to {count * stride} bytes; the limit leaves {most}", "export fewer objects")
    package = _package(gltf, "meshoptimizer", place)
    try:
        if mode == "ATTRIBUTES":
            decoded = package.decode_vertex_buffer(count, stride, data, np.dtype((np.void, stride))).view(np.uint8)
            bits = _octahedral_bits(decoded, count, stride) if name == "oct" else None
            elements = getattr(package, f"decode_filter_{name}")(decoded, count, stride) if name else decoded
            return elements.tobytes(), bits
        decode = package.decode_index_buffer if mode == "TRIANGLES" else package.decode_index_sequence
        return decode(count, 4, data).astype(f"<u{stride}").tobytes(), None
    except (ValueError, RuntimeError) as error:
        raise gltf.error(place, f"cannot be unpacked by {MESHOPT}") from error


def _octahedral_bits(packed: np.ndarray, count: int, stride: int) -> int | None:
    """Return the bits per number of an octahedral encoding; None if no element has a third number above 0. The third
    number represents 1 as 2^(bits - 1) - 1."""
    if not count:
        return None
    ones = np.frombuffer(packed.tobytes(), f"<i{stride // 4}").reshape(count, 4)[:, 2]
    return int(ones.max()).bit_length() + 1 if ones.max() > 0 else None


# KHR_draco_mesh_compression


def draco_primitive(gltf: Gltf, primitive: Object, place: str) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Return a primitive's triangles, (triangles, 3), and its attributes by name, (vertices, numbers), as stored.

    Raises:
        SceneFileError: the data are damaged or too large, or the package is missing (MissingPackageError).
    """
    extension = gltf.extension(primitive, DRACO, place)
    data = bytes(gltf.view_bytes(extension.get("bufferView"), f"{place}.{DRACO}"))
    _check_draco_size(gltf, data, place)
    package = _package(gltf, "DracoPy", place)
    try:
        mesh = package.decode(data)
        triangles = np.asarray(mesh.faces, np.int64).reshape(-1, 3)
        known = {attribute["unique_id"]: np.atleast_2d(attribute["data"]) for attribute in mesh.attributes}
    except Exception as error:  # the package has errors of several kinds
        raise gltf.error(place, f"cannot be unpacked by {DRACO}") from error
    attributes = {}
    for name, number in gltf.child(extension, "attributes", f"{place}.{DRACO}").items():
        if type(number) is not int or number not in known:
            raise gltf.error(f"{place}.{DRACO}", f"has no attribute {number!r}, to which {name[:40]} refers")
        attributes[name] = known[number]
    return triangles, attributes


def _check_draco_size(gltf: Gltf, data: bytes, place: str) -> None:
    """Raise SceneFileError if the header is not valid, or states a size that is too large."""
    try:
        magic, major, minor, kind, method, flags = DRACO_HEAD.unpack_from(data)
        if magic != b"DRACO" or (major, minor) != DRACO_VERSION or kind != DRACO_MESH:
            raise gltf.error(f"{place}.{DRACO}", f"is not a Draco {DRACO_VERSION[0]}.{DRACO_VERSION[1]} mesh")
        if flags & HAS_METADATA:
            raise gltf.error(f"{place}.{DRACO}", "has metadata", "export without it")
        # Edgebreaker first says which of its ways it goes, and has vertices before triangles.
        offset = DRACO_HEAD.size + (method == EDGEBREAKER)
        first, offset = _varint(data, offset)
        other, _ = _varint(data, offset)
    except (struct.error, IndexError) as error:
        raise gltf.error(f"{place}.{DRACO}", "is cut off") from error
    triangles, vertices = (other, first) if method == EDGEBREAKER else (first, other)
    if triangles > MAX_TRIANGLES or vertices > MAX_VERTICES:
        raise gltf.error(
            f"{place}.{DRACO}", f"states {triangles} triangles and {vertices} vertices", "export fewer objects"
        )


def _varint(data: bytes, offset: int) -> tuple[int, int]:
    """Return a number stored as seven bits per byte, the lowest bits first, and the offset after it."""
    value = shift = 0
    while True:
        value |= (data[offset] & 127) << shift
        shift, offset = shift + 7, offset + 1
        if data[offset - 1] < 128 or shift > 63:
            return value, offset
