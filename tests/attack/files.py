"""Damaged pictures, meshes and archives."""

from __future__ import annotations

import io
import os
import zlib
from collections.abc import Callable
from functools import partial
from pathlib import Path
from unittest.mock import patch

import numpy as np
from damaged import in_this_process, mutated, revalued
from written import (
    OBJ,
    Document,
    as_document,
    chunk,
    dds_bytes,
    given,
    packed,
    planes_of,
    ply,
    png_bytes,
    some_normals,
    write_exr,
    write_image,
)

from normalbench.bench.ground.output.arrays import DamagedError, read_npy, read_npz
from normalbench.bench.ground.output.errors import UsageError
from normalbench.bench.subjects.codecs.tuned_names import tuned
from normalbench.bench.subjects.normals import pixel_files
from normalbench.bench.subjects.normals.captures import Reading, capture
from normalbench.bench.subjects.normals.vertices import vertices_of
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.gbuffer.scenes.files.read import MESHES as MESHES_BY_ENDING
from normalbench.gbuffer.scenes.files.read import file_scene, read_mesh_file, seen
from normalbench.gbuffer.scenes.files.source import SceneFileError
from normalbench.gbuffer.scenes.mesh import sphere
from normalbench.gbuffer.scenes.setting import Setting

from .kind import MEASURED, Attack, Kind, one_line

ENDINGS = {"png16": "png", "png8": "png", "tiff": "tif", "float tiff": "tif"}
PIXELS = ("png16", "png8", "npy", "exr", "tiff", "float tiff", "dds", "hdr", "webp")
MESHES = ("glb", "gltf", "gltf values", "obj", "mtl", "ply", "little ply", "big ply")
TUNED = "best_fit"


def picture(folder: Path, kind: str) -> bytes:
    """Return a file of 12 x 16 normals."""
    n = some_normals()[:12, :16]
    eight, path = packed(n, np.uint8), folder / f"whole.{ENDINGS.get(kind, kind)}"
    match kind:
        case "png16" | "png8":
            path.write_bytes(png_bytes(packed(n, np.uint16) if kind == "png16" else eight))
        case "npy":
            np.save(path, n)
        case "exr":
            write_exr(path, planes_of(n), compression="zip")
        case "dds":
            path.write_bytes(dds_bytes(np.dstack([eight, eight[..., 0]])))
        case "hdr" | "float tiff":
            write_image(path, abs(n))
        case _:
            write_image(path, eight, compression="lossless" if kind == "webp" else "zip")
    return path.read_bytes()


def pictures(kind: str, folder: Path) -> Attack:
    """Return an attack on pictures: half of the cases change any bytes, others the header or the content of a PNG.

    A changed PNG keeps correct checksums, so that its content is reached. The pixels are read in this process, which
    must neither die nor hang.
    """
    whole, path = picture(folder, kind), folder / f"a.{ENDINGS.get(kind, kind)}"

    def case(seed: int) -> str:
        rng = np.random.default_rng(seed)
        if seed % 2:
            path.write_bytes(mutated(whole, rng))
        elif "png" in kind:
            path.write_bytes(resealed(whole, rng))
        else:
            path.write_bytes(whole[:4] + mutated(whole[4:300], rng) + whole[300:])
        try:
            with patch.object(pixel_files, "_in_a_process", in_this_process):
                captured, _ = capture(path, Reading(nan_share=1.0, normalise=True))
            assert np.isfinite(given(captured)[0]).all()
        except UsageError as error:
            assert str(error).startswith(str(path)), str(error)
            return one_line(error)
        return MEASURED

    return case


def resealed(data: bytes, rng: np.random.Generator) -> bytes:
    """Return a PNG with a changed header or rows, and correct checksums for the new content."""
    head, rows = bytearray(data[16:29]), bytearray(zlib.decompress(data[41:-16]))
    if rng.random() < 0.3:
        head[rng.integers(3, 13)] = rng.integers(256)
    for _ in range(4):
        rows[rng.integers(len(rows))] = rng.integers(256)
    body = chunk(b"IHDR", bytes(head)) + chunk(b"IDAT", zlib.compress(bytes(rows))) + chunk(b"IEND", b"")
    return data[:8] + body


def mesh_files(folder: Path) -> dict[str, bytes]:
    """Return a file of each kind; the glTF file has its buffer next to it."""
    ball = sphere(1.0, 6, 4)
    document = as_document([ball], [True])
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}}]
    dress(document)
    child = document.node(camera=0, translation=[0, 0, 4], rotation=[0, 0, 0, 1])
    document.node(children=[child], scale=[1, 1, 1])
    faces = ball.triangles.tolist()
    (folder / "a buffer.bin").write_bytes(document.data)
    return {
        "glb": document.write(folder / "x.glb").read_bytes(),
        "gltf": document.write(folder / "x.gltf", "data").read_bytes(),
        "obj": OBJ.replace("mtllib", "mtllib colours.mtl\nmtllib").encode(),
        "mtl": b"newmtl red\nKd 1 0 0\nKs 0.5\nNs 4000\nd 0.5\nmap_Kd a.png\n",
        "ply": ply("ascii", faces, ball.positions, ball.normals),
        "little ply": ply("binary_little_endian", faces, ball.positions, ball.normals),
        "big ply": ply("binary_big_endian", [*faces, [0, 1, 2, 3]], ball.positions, ball.normals),
    }


def dress(document: Document) -> None:
    """Add a picture as two maps of the first material, and a light."""
    picture = {"index": document.texture(png_bytes(packed(some_normals()[:4, :4], np.uint8)), wrapS=33071)}
    moved = {"extensions": {"KHR_texture_transform": {"offset": [0, 1], "rotation": 1.0, "scale": [2, 2]}}}
    document.json["materials"][0] |= {
        "alphaMode": "MASK",
        "alphaCutoff": 0.1,
        "normalTexture": picture | moved | {"scale": 2.0},
        "pbrMetallicRoughness": {"baseColorTexture": picture, "metallicFactor": 0.5, "roughnessFactor": 0.5},
    }
    lights = [{"type": "spot", "intensity": 3.0, "range": 9.0, "spot": {"innerConeAngle": 0.1, "outerConeAngle": 0.4}}]
    document.json["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    document.node(extensions={"KHR_lights_punctual": {"light": 0}}, translation=[0, 0, 3])


def meshes(kind: str, folder: Path) -> Attack:
    """Return an attack on mesh files: the scene can be drawn, or is refused in one line."""
    change = revalued if "values" in kind else mutated
    kind = kind.removesuffix(" values")
    data, path = mesh_files(folder)[kind], folder / f"a.{'obj' if kind == 'mtl' else kind.split()[-1]}"
    target = folder / "colours.mtl" if kind == "mtl" else path
    os.chdir(folder)

    def case(seed: int) -> str:
        path.write_text(OBJ)
        target.write_bytes(change(data, np.random.default_rng(seed)))
        look_at_vertices(path)
        try:
            file = read_mesh_file(path)
            assert np.isfinite(seen(file, (16, 12)).normals).all()
            assert file_scene(file, Setting(lights=2)).parts
        except SceneFileError as error:
            assert str(error).startswith(str(path)), str(error)
            return one_line(error)
        return MEASURED

    return case


def look_at_vertices(path: Path) -> None:
    """Check that vertex normals have unit length, or that the file is refused in one line."""
    if path.suffix not in MESHES_BY_ENDING:
        return
    try:
        lengths = np.linalg.norm(vertices_of(path).normals, axis=1)
        assert len(lengths) and np.allclose(lengths, 1), lengths
    except UsageError as error:
        assert str(error).startswith(str(path)), str(error)
        one_line(error)


ARRAYS = {"mean": np.arange(24, dtype=np.float32).reshape(2, 3, 4), "count": np.array(7)}


def flipped(data: bytes, rng: np.random.Generator) -> bytes:
    """Return data with one bit changed, a part cut out, or the end missing."""
    changed, index = bytearray(data), int(rng.integers(len(data)))
    match rng.integers(3):
        case 0:
            changed[index] ^= 1 << int(rng.integers(8))
        case 1:
            del changed[index : index + int(rng.integers(1, 9))]
        case _:
            del changed[index:]
    return bytes(changed)


def written(save: Callable[[io.BytesIO], None]) -> bytes:
    stream = io.BytesIO()
    save(stream)
    return stream.getvalue()


def read_table(path: Path) -> None:
    tuned(f"{TUNED}:table={path}")


def archives(kind: str, folder: Path) -> Attack:
    """Return an attack on sphere maps, their arrays, and the tables that `tune` writes."""
    look_up = ENCODINGS[TUNED].look_up
    assert look_up
    whole, read = {
        "npz": (written(lambda file: np.savez_compressed(file, **ARRAYS)), lambda path: read_npz(path, list(ARRAYS))),
        "npy": (written(lambda file: np.save(file, ARRAYS["mean"])), lambda path: read_npy(path, 4096)),
        "table": (written(lambda file: np.save(file, ENCODINGS[TUNED].tables()[look_up.sampler])), read_table),
    }[kind]
    path = folder / f"a.{'npz' if kind == 'npz' else 'npy'}"

    def case(seed: int) -> str:
        path.write_bytes(flipped(whole, np.random.default_rng(seed)))
        try:
            read(path)
        except DamagedError:
            return "refused"
        except UsageError as error:
            return one_line(error)
        return MEASURED

    return case


KINDS = (
    *(Kind(f"picture: {kind}", partial(pictures, kind), 3000, 60) for kind in PIXELS),
    *(Kind(f"mesh: {kind}", partial(meshes, kind), 1800, 60, reads_here_only=True) for kind in MESHES),
    *(Kind(f"archive: {kind}", partial(archives, kind), 12_000, 300, chunk=2000) for kind in ("npz", "npy", "table")),
)
