"""The contents of a glTF 2.0 file: its JSON, checked as it is used, and the numbers of its accessors.

Nothing in a file is trusted: every index, length and type is checked before it is used, and nothing is allocated
for a count that is too large.
"""

from __future__ import annotations

import struct
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from ....encodings.codecs.files import parsed_json
from .gltf_packed import DRACO, MESHOPT, unpacked_view
from .source import MAX_BYTES, MAX_VERTICES, TOO_LARGE, SceneFileError, checked_address, file_bytes, resource

GLB_MAGIC, GLB_JSON, GLB_BINARY = 0x46546C67, 0x4E4F534A, 0x004E4942
COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
INDEX_TYPES = ("<u1", "<u2", "<u4")
# Indices of a triangle list: each vertex may be in several triangles.
MAX_COUNT = 6 * MAX_VERTICES
# Extensions that are read, or whose lack is said in a note; files that require others are refused.
KNOWN = (
    "KHR_materials_",
    "KHR_texture_",
    "EXT_texture_",
    "KHR_lights_",
    "KHR_mesh_quantization",
    "KHR_animation_",
    DRACO,
    MESHOPT,
)
# Those of materials that are drawn.
DRAWN = ("KHR_materials_emissive_strength", "KHR_materials_ior")

Object = dict[str, Any]


class Gltf:
    """A glTF or GLB file.

    Attributes:
        path: the file's path; paths in the file are relative to its folder.
        json: the JSON document.
        octahedral_bits: bits of the octahedral map that packs a buffer view, by the view's index; filled in as
            views are unpacked.
    """

    def __init__(self, path: Path):
        self.path = path
        data = file_bytes(path)
        self._binary: bytes | None = None
        text = self._json_chunk(data) if data[:4] == struct.pack("<I", GLB_MAGIC) else data
        try:
            self.json = parsed_json(text)
        except ValueError as error:
            raise self.error("its JSON", f"cannot be read ({error})") from error
        if not isinstance(self.json, dict):
            raise self.error("its JSON", "is not an object")
        self._buffers: dict[int, bytes] = {}
        self._unpacked: dict[int, bytes] = {}
        self.octahedral_bits: dict[object, int] = {}
        self._check_version()
        for index in range(len(self.list_of(self.json, "images", "the file"))):
            image = self.entry("images", index, f"images[{index}]")
            # Pictures that no material has are not read, but a file that would fetch them is refused all the same.
            if "uri" in image:
                checked_address(path, image["uri"], f"images[{index}]")

    def error(self, place: str, what: str, remedy: str = "export it again") -> SceneFileError:
        """Return an error, for the caller to raise, with the one-line message "PATH: PLACE WHAT; REMEDY"."""
        return SceneFileError(f"{self.path}: {place} {what}; {remedy}")

    def _json_chunk(self, data: bytes) -> bytes:
        """Return the JSON chunk of a GLB file, and keep its binary chunk. Raises SceneFileError."""
        if len(data) < 20:
            raise self.error("its header", "is cut off")
        _, version, length = struct.unpack_from("<III", data)
        if version != 2 or not 20 <= length <= len(data):
            raise self.error("its header", f"states version {version} and {length} bytes; the file has {len(data)}")
        chunks: dict[int, bytes] = {}
        offset = 12
        while offset + 8 <= length:
            size, kind = struct.unpack_from("<II", data, offset)
            if offset + 8 + size > length:
                raise self.error(f"the chunk at byte {offset}", "is cut off")
            chunks.setdefault(kind, data[offset + 8 : offset + 8 + size])
            offset += 8 + size + -size % 4
        self._binary = chunks.get(GLB_BINARY)
        if GLB_JSON not in chunks:
            raise self.error("the file", "has no JSON chunk")
        return chunks[GLB_JSON]

    def _check_version(self) -> None:
        asset = self.json.get("asset")
        version = asset.get("version") if isinstance(asset, dict) else None
        if not isinstance(version, str) or not version.startswith("2."):
            raise self.error("asset.version", f"is {version!r}", "only glTF 2.0 is supported")
        for name in self.list_of(self.json, "extensionsRequired", "the file"):
            if not isinstance(name, str) or not name.startswith(KNOWN):
                raise self.error("extensionsRequired", f"lists {name!r}, which is not supported", "export without it")

    # The document, checked as it is asked for.

    def list_of(self, holder: Object, key: str, place: str) -> list[Any]:
        """Return the list under a key of an object, empty if missing. Raises SceneFileError if it is not a list."""
        entries = holder.get(key, [])
        if not isinstance(entries, list):
            raise self.error(f"{place}.{key}", "is not a list")
        return entries

    def entry(self, kind: str, index: object, place: str) -> Object:
        """Return object number `index` of the document's list `kind`, such as "meshes". Raises SceneFileError if the
        index is not valid."""
        known = self.list_of(self.json, kind, "the file")
        if type(index) is not int or not 0 <= index < len(known):
            raise self.error(place, f"refers to {kind}[{_shown_text(index)}], but the length of {kind} is {len(known)}")
        if not isinstance(known[index], dict):
            raise self.error(f"{kind}[{index}]", "is not an object")
        return known[index]

    def child(self, holder: Object, key: str, place: str) -> Object:
        """Return the object under a key of another object, empty if missing. Raises SceneFileError if it is not an
        object."""
        child = holder.get(key, {})
        if not isinstance(child, dict):
            raise self.error(f"{place}.{key}", "is not an object")
        return child

    def extension(self, holder: Object, name: str, place: str) -> Object:
        """Return an object's extension of this name, empty if missing. Raises SceneFileError."""
        return self.child(self.child(holder, "extensions", place), name, f"{place}.extensions")

    def requires(self, name: str) -> bool:
        """Whether the file requires this extension."""
        return name in self.list_of(self.json, "extensionsRequired", "the file")

    def whole(self, holder: Object, key: str, place: str, default: int | None = None) -> int:
        """Return the integer, 0 or more, under a key of an object, or the default if the key is missing. Raises
        SceneFileError for any other value, and if key and default are missing."""
        value = holder.get(key, default)
        if type(value) is not int or not 0 <= value < 2**40:
            raise self.error(f"{place}.{key}", f"is {_shown_text(value)}, not a whole number")
        return value

    def number(self, holder: Object, key: str, place: str, default: float) -> float:
        return self.numbers({key: [holder.get(key, default)]}, key, place, (default,))[0]

    def numbers(self, holder: Object, key: str, place: str, default: tuple[float, ...]) -> tuple[float, ...]:
        """Return the finite numbers under a key of an object, as many as in `default`, or `default` if the key is
        missing. Raises SceneFileError if the file's numbers are not valid."""
        values = holder.get(key, list(default))
        if not isinstance(values, list) or len(values) != len(default) or not all(map(_is_number, values)):
            raise self.error(f"{place}.{key}", f"is {_shown_text(values)}, not {len(default)} numbers below 1e15")
        return tuple(map(float, values))

    # Numbers in buffers.

    def accessor(self, index: object, width: int, place: str) -> np.ndarray:
        """Return an accessor's decoded numbers, float64 of shape (count, width).

        Raises:
            SceneFileError: the accessor has the wrong width, or extends beyond its buffer.
        """
        return self._accessor(index, width, place)

    def indices(self, index: object, place: str) -> np.ndarray:
        """Return an index accessor's numbers, int64 of shape (count,). Raises SceneFileError."""
        accessor = self.entry("accessors", index, place)
        if COMPONENTS.get(_hashable_or_none(accessor.get("componentType"))) not in INDEX_TYPES:
            raise self.error(place, "must be unsigned integers")
        return self._accessor(index, 1, place)[:, 0].astype(np.int64)

    def count(self, index: object, place: str) -> int:
        """Return an accessor's number of elements, from its header alone."""
        return self.whole(self.entry("accessors", index, place), "count", place)

    def _accessor(self, index: object, width: int, place: str) -> np.ndarray:
        accessor = self.entry("accessors", index, place)
        kind = COMPONENTS.get(_hashable_or_none(accessor.get("componentType")))
        count = self.whole(accessor, "count", place)
        if kind is None or WIDTHS.get(_hashable_or_none(accessor.get("type"))) != width:
            raise self.error(place, f"has the type {_shown_text(accessor.get('type'))}, which is not supported here")
        if count > MAX_COUNT:
            raise self.error(place, f"has {count} elements; the maximum is {MAX_COUNT}", "export fewer objects")
        if "bufferView" in accessor:
            start = self.whole(accessor, "byteOffset", place, 0)
            elements = self._view_elements(accessor["bufferView"], start, kind, count, width, place)
        else:
            elements = np.zeros((count, width), kind)
        if "sparse" in accessor:
            elements = self._sparse_elements(self.child(accessor, "sparse", place), elements, place)
        return meant_numbers(elements, accessor.get("normalized") is True)

    def _sparse_elements(self, sparse: Object, dense: np.ndarray, place: str) -> np.ndarray:
        """Return a copy of an accessor's elements with the elements in `sparse` replaced. Raises SceneFileError."""
        count = self.whole(sparse, "count", f"{place} (sparse)")
        where, what = (self.child(sparse, key, place) for key in ("indices", "values"))
        kind = COMPONENTS.get(_hashable_or_none(where.get("componentType")))
        if kind not in INDEX_TYPES or count > len(dense):
            raise self.error(f"{place} (sparse)", "is damaged")
        starts = [self.whole(part, "byteOffset", f"{place} (sparse)", 0) for part in (where, what)]
        index = self._view_elements(where.get("bufferView"), starts[0], kind, count, 1, place)[:, 0].astype(np.int64)
        values = self._view_elements(what.get("bufferView"), starts[1], dense.dtype.str, count, dense.shape[1], place)
        if np.any(index >= len(dense)):
            raise self.error(f"{place} (sparse)", f"has index {index.max()}; the accessor has {len(dense)} elements")
        dense = dense.copy()
        dense[index] = values
        return dense

    def _view_elements(self, index: object, start: int, kind: str, count: int, width: int, place: str) -> np.ndarray:
        """Return elements of a buffer view, (count, width), as stored."""
        view = self.entry("bufferViews", index, place)
        where = f"{place}, bufferViews[{index}]"
        data = self.view_bytes(index, place)
        size = np.dtype(kind).itemsize
        stride = self.whole(view, "byteStride", where, 0) or size * width
        end = start + (stride * (count - 1) + size * width if count else 0)
        if stride < size * width or end > len(data):
            raise self.error(where, f"holds {len(data)} bytes, but {end} are needed", "it is cut off: export it again")
        if not count:
            return np.zeros((0, width), kind)
        return np.ndarray((count, width), kind, data, start, (stride, size))

    def view_bytes(self, index: object, place: str) -> bytes | memoryview:
        """Return the bytes of a buffer view, unpacked if it is packed with EXT_meshopt_compression.

        Raises:
            SceneFileError: the view exceeds its buffer or cannot be unpacked.
        """
        view = self.entry("bufferViews", index, place)
        assert isinstance(index, int)
        where = f"{place}, bufferViews[{index}]"
        packed = self.extension(view, MESHOPT, where)
        if not packed or not self._is_packed(view, where):
            return self._slice(view, where)
        if index not in self._unpacked:
            most = MAX_BYTES - sum(map(len, self._unpacked.values()))
            self._unpacked[index], bits = unpacked_view(self, packed, self._slice(packed, where), most, where)
            if bits is not None:
                self.octahedral_bits[index] = bits
        return self._unpacked[index]

    def _is_packed(self, view: Object, where: str) -> bool:
        """Whether a view must be unpacked, because the file has no unpacked copy of it."""
        buffer = self.entry("buffers", view.get("buffer"), where)
        return self.requires(MESHOPT) or ("uri" not in buffer and view.get("buffer") != 0)

    def _slice(self, view: Object, where: str) -> memoryview:
        """Return the part of a buffer to which a view refers, as stored. Raises SceneFileError if the buffer is too
        short."""
        offset, length = (
            self.whole(view, key, where, default) for key, default in (("byteOffset", 0), ("byteLength", None))
        )
        data = self._buffer(view.get("buffer"), where)
        if offset + length > len(data):
            left = max(len(data) - offset, 0)
            raise self.error(where, f"holds {left} bytes, but {length} are needed", "it is cut off: export it again")
        return memoryview(data)[offset : offset + length]

    def _buffer(self, index: object, place: str) -> bytes:
        buffer = self.entry("buffers", index, place)
        assert isinstance(index, int)
        if index not in self._buffers:
            if "uri" in buffer:
                data = resource(self.path, buffer["uri"], f"buffers[{index}]")
            elif index == 0 and self._binary is not None:
                data = self._binary
            else:
                raise self.error(f"buffers[{index}]", "has no uri, and the file has no binary chunk")
            self._buffers[index] = data
        return self._buffers[index]

    @cached_property
    def notes(self) -> list[str]:
        """Notes on features of the file that are not drawn."""
        notes = []
        meshes = _dicts(self.json.get("meshes"))
        primitives = [primitive for mesh in meshes for primitive in _dicts(mesh.get("primitives"))]
        if self.json.get("skins"):
            notes.append("skins are not applied: meshes keep their bind pose")
        if any("targets" in p for p in primitives):
            notes.append("morph targets are not applied")
        if any("COLOR_0" in _dict(p.get("attributes")) for p in primitives):
            notes.append("vertex colours are ignored")
        named = {*self._names("extensionsUsed"), *self._names("extensionsRequired")}
        notes += [
            f"{name} is ignored" for name in sorted(named) if name.startswith("KHR_materials_") and name not in DRAWN
        ]
        return notes

    def _names(self, key: str) -> list[str]:
        return [name for name in self.list_of(self.json, key, "the file") if isinstance(name, str)]


def _dict(value: object) -> Object:
    return value if isinstance(value, dict) else {}


def _dicts(value: object) -> list[Object]:
    return [item for item in value if isinstance(item, dict)] if isinstance(value, list) else []


def meant_numbers(stored: np.ndarray, is_normalised: bool) -> np.ndarray:
    """Return normalised integers as numbers in [0, 1] or [-1, 1], other numbers unchanged; float64."""
    # A NaN of the signalling kind is one all the same, and is found where numbers are checked.
    with np.errstate(invalid="ignore"):
        numbers = stored.astype(np.float64)
    if not is_normalised or stored.dtype.kind == "f":
        return numbers
    return np.maximum(numbers / np.iinfo(stored.dtype).max, -1.0)


def _is_number(value: object) -> bool:
    return type(value) in (int, float) and abs(value) < TOO_LARGE  # pyright: ignore


def _hashable_or_none(value: object) -> Any:
    return value if isinstance(value, int | str) else None


def _shown_text(value: object) -> str:
    text = repr(value) if not isinstance(value, list | dict) else f"a list or object of {len(value)}"
    return text if len(text) <= 40 else f"{text[:37]}..."
