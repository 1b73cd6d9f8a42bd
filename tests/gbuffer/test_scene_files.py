"""Users' meshes as scenes: normals under every transform, file formats and cameras."""

from dataclasses import replace

import numpy as np
import pytest
import trimesh
from drawing import draw
from written import NORMALS, OBJ, POSITIONS, TRIANGLE, Document, chained, ply

from normalbench.gbuffer.scenes.files.read import file_scene, file_view, read_mesh_file, seen
from normalbench.gbuffer.scenes.mesh import box, joined, sphere, tangents
from normalbench.gbuffer.scenes.scene import Material
from normalbench.gbuffer.scenes.setting import Setting


@pytest.mark.parametrize("how", ["glb", "beside", "data"])
def test_mirrored_non_uniformly_scaled_node_gives_hand_computed_normals(tmp_path, how):
    """The normal (1, 2, 2) is scaled by (-1/2, 1, 2) to (-1/2, 2, 4), which is (-1, 4, 8) / 9 when normalised; a
    quarter turn about z takes (x, y, z) to (-y, x, z). The tangent (2, 1, -2) is scaled like positions, by (-2, 1,
    1/2), and then turned. A mirror flips the tangent's sign, so that the bitangent stays on the side of the mirrored
    bitangent. The file's bitangent points up in the image, and the stored bitangent along v, which is down."""
    file = read_mesh_file(chained().write(tmp_path / ("a.glb" if how == "glb" else "a.gltf"), how))
    mesh = file.baked
    assert abs(mesh.normals - np.array([-4, -1, 8]) / 9).max() < 1e-15, mesh.normals
    # Four units in the last place of 4: the quarter turn's quaternion is rounded.
    assert abs(mesh.positions[:2] - [(0, 0, 4), (1, -4, 4)]).max() < 4 * np.spacing(4.0)
    (piece,) = file.pieces
    placed = tangents(piece.baked())
    assert abs(placed[:, :3] - np.array([-1, -4, -1]) / 18**0.5).max() < 1e-15, placed
    assert (placed[:, 3] == 1).all()
    n, t = np.array([1, 2, 2]) / 3, np.array([2, 1, -2]) / 3
    bitangent = piece.model[:3, :3] @ np.cross(n, t)
    kept_bitangent = placed[0, 3] * np.cross(mesh.normals[0], placed[0, :3])
    # At right angles to the normal by construction; the mirrored one lies on the same side.
    assert kept_bitangent @ bitangent < -0.3 * np.linalg.norm(bitangent)


def test_renderer_stores_the_hand_computed_normals(tmp_path, gl):
    """A square with the normal (1, 2, 2) / 3 in a mirrored, non-uniformly scaled node, seen from the z axis."""
    document = Document()
    square = [(-9, -9, 0), (9, -9, 0), (9, 9, 0), (-9, 9, 0)]
    mesh = document.mesh(square, [(1, 2, 2)] * 4, [(0, 1, 2), (0, 2, 3)])
    document.node(mesh=mesh, scale=[-2, 1, 0.5])
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": 1.0, "znear": 1, "zfar": 9}}]
    document.node(camera=0, translation=[0, 0, 5])
    file = read_mesh_file(document.write(tmp_path / "a.glb"))
    kept = draw(gl, "deferred", file_scene(file, Setting(lights=1))).gbuffer[1][..., :3]
    by_hand = np.array([-1, 4, 8]) / 9
    assert abs(kept - by_hand).max() < 2e-7, f"{abs(kept - by_hand).max():.2e} off"
    assert abs(seen(file, (64, 48)).normals - by_hand).max() < 1e-7


def test_node_matrix_is_column_major_and_applies_to_children(tmp_path):
    document = Document()
    child = document.node(mesh=document.mesh(POSITIONS, NORMALS), translation=[1, 0, 0])
    document.node(children=[child], matrix=[0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 3, 0, 5, 6, 7, 1])
    mesh = read_mesh_file(document.write(tmp_path / "a.glb")).baked
    # (1, 1, 2) moves to (2, 1, 2), turns to (-1, 2, 2), is stretched to (-1, 2, 6), and moves.
    assert np.allclose(mesh.positions[0], (4, 8, 13), atol=1e-15)
    by_hand = np.array([-2, 1, 2 / 3])
    assert np.allclose(mesh.normals, by_hand / np.linalg.norm(by_hand), atol=1e-15)


def test_rigid_transforms_become_instances_and_others_are_baked(tmp_path):
    document = Document()
    mesh = document.mesh(POSITIONS, NORMALS)
    for scale in ([1, 1, 1], [2, 2, 2], [-1, 1, 1], [1, 2, 1]):
        document.node(mesh=mesh, scale=scale)
    file = read_mesh_file(document.write(tmp_path / "a.glb"))
    parts = file_scene(file, Setting()).parts
    assert sorted(len(part.models) for part in parts) == [1, 1, 2]
    baked = joined(
        [replace(part.mesh, authored=None).placed(m[:3, :3].T, m[:3, 3]) for part in parts for m in part.models]
    )
    assert sorted(map(tuple, baked.positions)) == sorted(map(tuple, file.baked.positions))


def test_strips_fans_sparse_and_quantised_accessors_are_read(tmp_path):
    square = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)], np.float32)
    for mode, corners, expected in (
        (5, [0, 1, 2, 3], [(0, 1, 2), (1, 3, 2)]),
        (6, [0, 1, 3, 2], [(1, 3, 0), (3, 2, 0)]),
    ):
        document = Document()
        document.node(mesh=document.mesh(square, triangles=corners, mode=mode))
        baked = read_mesh_file(document.write(tmp_path / "a.glb")).baked
        assert baked.triangles.tolist() == [list(t) for t in expected]
        assert np.array_equal(baked.normals, np.tile([0.0, 0, 1], (4, 1))), "all wound one way"
    document = Document()
    mesh = document.mesh(square, triangles=[0, 1, 2])
    attributes = document.json["meshes"][mesh]["primitives"][0]["attributes"]
    attributes["NORMAL"] = document.accessor(np.array([(127, 0, 0)] * 4, np.int8), normalized=True)
    views = [document.accessor(np.array([2], np.uint8)), document.accessor(np.array([(0, 5, 0)], np.float32))]
    index, value = ({"bufferView": document.json["accessors"][v]["bufferView"]} for v in views)
    sparse = {"count": 1, "indices": index | {"componentType": 5121}, "values": value}
    document.json["accessors"][attributes["POSITION"]]["sparse"] = sparse
    document.node(mesh=mesh)
    baked = read_mesh_file(document.write(tmp_path / "a.glb")).baked
    assert np.array_equal(baked.normals, np.tile([1.0, 0, 0], (4, 1)))
    assert baked.positions.tolist() == [[0, 0, 0], [1, 0, 0], [0, 5, 0], [1, 1, 0]]


def test_material_without_textures_uses_its_factors(tmp_path):
    document = Document()
    plain = {"baseColorFactor": [0.5, 0.25, 1, 0.5], "metallicFactor": 0, "roughnessFactor": 0.5}
    metal = {"baseColorFactor": [1, 0.5, 0, 0.5], "roughnessFactor": 0.25}
    strong = {"KHR_materials_emissive_strength": {"emissiveStrength": 25}, "KHR_materials_ior": {"ior": 2.0}}
    document.json["materials"] = [
        {"pbrMetallicRoughness": plain, "doubleSided": True, "alphaMode": "BLEND", "emissiveFactor": [0, 0, 2]},
        {"pbrMetallicRoughness": metal, "extensions": strong, "emissiveFactor": [1, 0.5, 0]},
        {"pbrMetallicRoughness": metal, "alphaMode": "MASK", "alphaCutoff": 0.2},
    ]
    for material in range(3):
        document.node(mesh=document.mesh(TRIANGLE, material=material))
    document.node(mesh=document.mesh(TRIANGLE))
    file = read_mesh_file(document.write(tmp_path / "a.glb"))
    first, second, third, none = file.materials
    assert (first.base, first.metalness, first.roughness) == ((0.5, 0.25, 1), 0, 0.5)
    assert (first.emission, first.alpha, first.cutoff, first.reflectance) == ((0, 0, 2), 0.5, 0, 0.04)
    assert (second.metalness, second.roughness, second.alpha, second.cutoff) == (1, 0.25, 1, 0)
    assert second.emission == (25, 12.5, 0) and second.reflectance == pytest.approx(1 / 9)
    # What is cut out is opaque: a picture's alpha x 0.5 < 0.2.
    assert (third.alpha, third.cutoff) == (1, pytest.approx(0.4))
    # glTF 2.0, 3.9.2: the defaults of a material.
    assert (none.base, none.metalness, none.roughness, none.emission) == ((1, 1, 1), 1, 1, (0, 0, 0))
    assert file.two_sided == (True, False, False, False) and file.notes.count("textures are ignored") == 0
    scene = file_scene(file, Setting())
    assert [(part.materials.tolist(), part.two_sided) for part in scene.parts] == [
        ([0], True),
        ([1], False),
        ([2], False),
        ([3], False),
    ]
    assert scene.is_metal_rough


def test_obj_quads_negative_indices_and_materials_are_read(tmp_path):
    (tmp_path / "a.obj").write_text(OBJ)
    (tmp_path / "colours.mtl").write_text("newmtl red\nKd 1 0 0\nKs 0.5\nNs 4000\nnewmtl blue\nKd 0 0 1\nd 0.5\n")
    file = read_mesh_file(tmp_path / "a.obj")
    quad, behind = (piece.mesh for piece in file.pieces)
    area = [np.cross(p[1] - p[0], p[2] - p[0])[2] / 2 for p in quad.positions[quad.triangles]]
    assert area == [2, 2] and np.array_equal(quad.normals, [(0, 0, 1)] * 4)
    assert sorted(map(tuple, behind.positions)) == [(0, 0, 0), (2, 0, 0), (2, 2, 0)]
    assert file.materials == (
        Material(albedo=(1, 0, 0), specular=(0.5, 0.5, 0.5), power=2048.0),
        Material(albedo=(0, 0, 1), alpha=0.5),
    )
    assert file.notes == ()


def test_negative_index_counts_back_from_its_own_line(tmp_path):
    """Two triangles with identical face lines have different vertices."""
    first, other = ("\n".join([f"v 0 0 {z}", f"v 1 0 {z}", f"v 0 1 {z}", "f -3 -2 -1"]) for z in (0, 5))
    (tmp_path / "a.obj").write_text(f"{first}\n{other}\n")
    mesh = read_mesh_file(tmp_path / "a.obj").baked
    assert sorted(mesh.positions[mesh.triangles][:, :, 2].tolist()) == [[0, 0, 0], [5, 5, 5]]


def test_repeated_obj_note_is_reported_once(tmp_path):
    (tmp_path / "a.obj").write_text(OBJ)
    (tmp_path / "colours.mtl").write_text("newmtl red\nmap_Kd a.png\nmap_Ks b.png\nnewmtl blue\nmap_Kd c.png\n")
    assert read_mesh_file(tmp_path / "a.obj").notes == ("textures are ignored; only colours are used",)


@pytest.mark.parametrize("order", ["ascii", "binary_little_endian", "binary_big_endian"])
@pytest.mark.parametrize(
    "faces, expected", [([[0, 1, 2]], 1), ([[0, 1, 2], [2, 0, 1]], 2), ([[0, 1, 2, 0], [0, 1, 2]], 2)]
)
def test_ply_is_read_in_every_byte_order(tmp_path, order, faces, expected):
    (tmp_path / "a.ply").write_bytes(ply(order, faces))
    mesh = read_mesh_file(tmp_path / "a.ply").baked
    assert np.array_equal(mesh.positions, POSITIONS) and np.allclose(mesh.normals, NORMALS / 3, atol=1e-15)
    assert len(mesh.triangles) == expected and mesh.triangles[0].tolist() == [0, 1, 2]


@pytest.mark.parametrize("ending", ["glb", "gltf", "obj", "ply"])
def test_files_written_by_trimesh_are_read_back_correctly(tmp_path, ending):
    """The positions and normals of a ball match those in trimesh."""
    ball = trimesh.creation.icosphere(2)
    normals = ball.vertex_normals
    if ending in ("glb", "gltf"):
        exported = trimesh.Scene([ball]).export(file_type=ending, include_normals=True)
        files = {f"a.{ending}": exported} if ending == "glb" else {**exported, "a.gltf": exported["model.gltf"]}
    else:
        options = {"include_normals": True} if ending == "obj" else {"vertex_normal": True}
        text = ball.export(file_type=ending, **options)
        files = {f"a.{ending}": text.encode() if isinstance(text, str) else text}
    for name, data in files.items():
        (tmp_path / name).write_bytes(data)
    file = read_mesh_file(tmp_path / f"a.{ending}")
    order, own = (np.lexsort(np.round(p, 5).T) for p in (ball.vertices, file.baked.positions))
    assert file.notes == () and len(file.baked.triangles) == len(ball.faces)
    assert np.allclose(file.baked.positions[own], ball.vertices[order], atol=1e-6)
    assert np.allclose(file.baked.normals[own], normals[order], atol=1e-6)


@pytest.mark.parametrize("size", [(80, 60), (60, 60)])
def test_a_scene_without_a_camera_is_framed(tmp_path, size):
    """The whole scene is in the image and between the clip planes, and it fills a good part of the image."""
    document = Document()
    slab = box(7.0, 2.0, 1.0).placed(np.eye(3), (100.0, -20.0, 3.0))
    document.node(mesh=document.mesh(slab.positions, slab.normals, slab.triangles))
    file = read_mesh_file(document.write(tmp_path / "a.glb"))
    view = file_view(file)
    placed = np.c_[file.baked.positions, np.ones(24)] @ (view.projection(size[0] / size[1]) @ view.matrix()).T
    clip = placed[:, :3] / placed[:, 3:]
    assert abs(clip).max() < 1 and abs(clip[:, :2]).max() > 0.7
    seen_now = seen(file, size)
    edge = [seen_now.covered[0], seen_now.covered[-1], seen_now.covered[:, 0], seen_now.covered[:, -1]]
    assert seen_now.covered.mean() > 0.1 and not np.concatenate(edge).any()


def test_the_files_own_camera_is_used_with_its_roll(tmp_path):
    """The camera looks along +x with +z up and a 90° field of view; the upper half of the image has larger z."""
    document = Document()
    document.json["cameras"] = [{"type": "perspective", "perspective": {"yfov": np.pi / 2, "znear": 0.1}}]
    # Columns: right = -y, up = +z, back = -x; at (-5, 0, 0).
    document.node(camera=0, matrix=[0, -1, 0, 0, 0, 0, 1, 0, -1, 0, 0, 0, -5, 0, 0, 1])
    ball = sphere(1.0, 24, 12)
    document.node(mesh=document.mesh(ball.positions, ball.normals, ball.triangles), translation=[0, 0, 2])
    file = read_mesh_file(document.write(tmp_path / "a.glb"))
    shown = seen(file, (80, 80))
    rows, columns = np.nonzero(shown.covered)
    # The ball's middle is seen at 2 / 5 of the half height above the middle.
    assert pytest.approx(rows.mean(), abs=1.5) == 39.5 * (1 - 0.4) and columns.mean() == pytest.approx(39.5, abs=0.5)
    rims = shown.normals[[rows.min() + 1, rows.max() - 1], 40, 1]
    assert rims[0] > 0.3 and rims[1] < -0.3, f"the upper rim faces up in the picture, the lower one down: {rims}"
    assert shown.normals[int(rows.mean()), 40, 2] > 0.8
