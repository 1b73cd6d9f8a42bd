"""Users' meshes as scenes: generated normals, reading time, rendering and measuring."""

import json
import time
from dataclasses import replace

import numpy as np
import pytest
from drawing import FP32, apart, draw, scene_of
from PIL import Image
from written import Document, as_document

from normalbench.bench.subjects.normals.normal_names import mesh_set
from normalbench.bench.subjects.normals.normal_sets import playground
from normalbench.bench.tables.quality.measure import QualityCase, measure
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.scenes.built_in.playground import CAMERA, in_view_space
from normalbench.gbuffer.scenes.files.read import file_scene, read_mesh_file
from normalbench.gbuffer.scenes.mesh import sphere, tangents, wound
from normalbench.gbuffer.scenes.scene import Material
from normalbench.gbuffer.scenes.setting import Setting


def test_meshes_without_normals_get_smooth_normals_and_a_note(tmp_path, run):
    """On a sphere, generated normals are within 2° of the exact normals, also where a seam duplicates vertices."""
    ball = sphere(1.0, 40, 20)
    lines = [f"v {x} {y} {z}" for x, y, z in ball.positions] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in wound(ball)]
    (tmp_path / "ball.obj").write_text("\n".join(lines))
    mesh = read_mesh_file(tmp_path / "ball.obj").baked
    own = mesh.positions / np.linalg.norm(mesh.positions, axis=1, keepdims=True)
    assert np.degrees(np.arccos(np.sum(mesh.normals * own, axis=1).clip(-1, 1))).max() < 2
    document = Document()
    document.node(mesh=document.mesh(ball.positions, triangles=wound(ball)))
    document.write(tmp_path / "ball.glb")
    assert np.sum(read_mesh_file(tmp_path / "ball.glb").baked.normals * ball.normals, axis=1).min() > 0.999
    arguments = ("--encoding", "xy", "--storage", "rg8", "--backend", "jax", "--size", "64x48", "--format", "json")
    status, out, err = run("quality", "--normals", str(tmp_path / "ball.obj"), *arguments)
    assert status == 0 and "smooth normals were generated" in err and "no camera in it" in err, err
    (row,) = json.loads(out)
    assert row["normals"] == "ball.obj" and row["count"] + row["background"] == 64 * 48 and row["count"] > 1000


def test_obj_with_many_materials_and_a_long_line_is_read_quickly(tmp_path):
    """The reader neither copies all vertices for each material nor rescans a line at each continuation."""
    square = [f"v {i % 200} {i // 200} 0" for i in range(40_000)]
    faces = [f"usemtl {i}\nf {i + 1} {i + 2} {i + 202}" for i in range(300)]
    long = "f " + " \\\n".join(map(str, range(1, 40_001)))
    (tmp_path / "a.obj").write_text("\n".join([*square, *faces, long]))
    start = time.process_time()
    file = read_mesh_file(tmp_path / "a.obj")
    assert time.process_time() - start < 3
    assert len(file.pieces) == 300 and sum(len(piece.mesh.triangles) for piece in file.pieces) > 39_000


def test_procedural_scene_written_to_a_file_renders_the_same(tmp_path, gl):
    """The room's meshes, camera, lights and materials are used without shadows: the images agree to more than 60 dB.
    The difference comes from rounding vertices to float32 before they are moved."""
    room = scene_of("room")
    document = Document()
    document.json["materials"] = [{} for _ in room.materials]
    for part in room.parts:
        mesh = part.mesh
        for material in dict.fromkeys(part.materials.tolist()):
            # A file's bitangents go against v.
            arrays = {"TEXCOORD_0": mesh.uv, "TANGENT": tangents(mesh) * (1, 1, 1, -1)}
            mesh_index = document.mesh(mesh.positions, mesh.normals, mesh.triangles, material=material, **arrays)
            for model in part.models[part.materials == material]:
                document.node(mesh=mesh_index, matrix=model.T.ravel().tolist())
    scene = file_scene(read_mesh_file(document.write(tmp_path / "room.glb")), Setting())
    scene = replace(scene, materials=(*room.materials, Material()), lights=room.lights, ambient=room.ambient)
    scene = replace(scene, view=room.view, previous=room.previous)
    for pipeline in ("deferred", "hybrid"):
        images = [draw(gl, pipeline, source, FP32).image for source in (scene, room)]
        assert images[1].mean() > 0.05
        assert apart(*images) > 60, f"{pipeline}: {apart(*images):.1f} dB"


@pytest.mark.usefixtures("gl")
def test_render_accepts_scene_names_and_files_and_adds_lights_to_the_files(tmp_path, run):
    chained_file = tmp_path / "mine.glb"
    document = as_document([sphere(1.0, 24, 12)])
    document.write(chained_file)
    arguments = ("--encoding", "octahedral", "--size", "96x72", "--lights", "8", "--repeats", "1", "--format", "json")
    status, out, err = run("render", "--scene", f"gloss,{chained_file}", *arguments, "--images", str(tmp_path / "p"))
    rows = json.loads(out)
    assert status == 0 and [row["scene"] for row in rows] == ["gloss", "mine.glb"], err
    assert 40 < rows[1]["psnr_db"] < 90 and rows[1]["invalid"] == 0
    (name,) = (tmp_path / "p").glob("mine.glb-*final.png")
    pixels = np.asarray(Image.open(name)).astype(int)
    lit = pixels.max(axis=2) > 40
    assert 0.2 < lit.mean() < 0.8, f"{lit.mean():.2f} of the picture is lit"
    assert lit[36, 48] and not lit[0].any()


def test_playground_as_a_file_gives_the_same_figures(tmp_path):
    """The file has a camera. Rounding vertices to float32 moves edges by a few pixels and figures by 0.01 dB."""
    document = as_document(in_view_space())
    lens = {"yfov": np.radians(CAMERA.fov), "znear": CAMERA.near, "zfar": CAMERA.far}
    document.json["cameras"] = [{"type": "perspective", "perspective": lens}]
    document.node(camera=0)
    file_set, _ = mesh_set(document.write(tmp_path / "playground.glb"), "640x480")
    assert file_set.background == pytest.approx(playground().background, abs=20)
    for name in ("xy", "octahedral"):
        case = QualityCase(Codec(ENCODINGS[name], STORAGES["rgba8"]), file_set, "jax")
        figures = [measure(replace(case, normal_set=s))["psnr_db"] for s in (file_set, playground())]
        assert figures[0] == pytest.approx(figures[1], abs=0.01), name
