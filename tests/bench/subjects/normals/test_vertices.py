"""The vertex normals of a mesh as a set: each normal once, with the error of the file's rounding."""

import json
from dataclasses import replace

import numpy as np
import pytest
from manual import ROOT
from typed import normal_sets_named, storages_named
from written import OBJ, TRIANGLE, Document, given, ply

from normalbench.bench.ground.options.option import Reading
from normalbench.bench.subjects.normals import own_errors
from normalbench.bench.subjects.normals.own_errors import all_roundings, own_error_deg
from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.vec import Vec3
from normalbench.gbuffer.scenes.files.mesh_file import Rounding
from normalbench.gbuffer.scenes.mesh import Mesh, sphere

ROUND = sphere(1.0, 24, 16)


# At a pole all slices have one normal, to the bit.
BALL = replace(ROUND, positions=ROUND.positions.round(9), normals=ROUND.normals.round(9))


CLOUD = ROOT / "tests" / "inputs" / "normals" / "points.ply"


def vertices(path, said=""):
    """Return the set of a file's vertices, and their normals."""
    (loaded,) = normal_sets_named(f"{path}#vertices{said}", 0, 0, Reading())
    n, covered = given(loaded)
    return loaded, n[covered]


def sorted_rows(n) -> np.ndarray:
    return np.array(sorted(np.round(np.asarray(n, np.float64), 5).tolist()))


def unit(n) -> np.ndarray:
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


def directions(count: int) -> np.ndarray:
    return unit(np.random.default_rng(5).normal(size=(count, 3)))


def ball_of(normals: np.ndarray, normalized: bool = True) -> Document:
    """Return a glTF document of points whose normals are stored in the type of the array."""
    document = Document()
    mesh = document.mesh(np.arange(3.0 * len(normals)).reshape(-1, 3), mode=0)
    attributes = document.json["meshes"][mesh]["primitives"][0]["attributes"]
    attributes["NORMAL"] = document.accessor(normals, normalized)
    document.node(mesh=mesh)
    document.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    return document


@pytest.mark.parametrize("how", ["glb", "data"])
def test_normals_are_in_object_space_and_counted_once_for_all_instances(tmp_path, how):
    """The mesh has two instances, one mirrored and one rotated."""
    document = Document()
    n = unit(np.array([(1, 2, 2), (0, 3, 4), (-2, 1, 2)], float))
    mesh = document.mesh(TRIANGLE, n, [(0, 1, 2)])
    document.node(mesh=mesh, scale=[-2, 1, 0.5])
    document.node(mesh=mesh, rotation=[0, 0, 0.5**0.5, 0.5**0.5])
    loaded, normals = vertices(document.write(tmp_path / ("a.glb" if how == "glb" else "a.gltf"), how))
    assert sorted_rows(normals) == pytest.approx(sorted_rows(n), abs=1e-6)
    assert loaded.name.endswith("#vertices") and loaded.code_space == "object" and loaded.own_error_deg is None


def test_duplicate_vertices_count_once_and_unused_vertices_do_not_count(tmp_path):
    """One of six vertices is unused, one repeats another with a different uv, and one repeats a normal elsewhere."""
    positions = [*TRIANGLE, (1, 0, 0), (0, 0, 9), (5, 5, 5)]
    normals = unit(np.array([(0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 1, 1)], float))
    document = Document()
    uv = np.arange(12.0).reshape(6, 2)
    document.node(mesh=document.mesh(positions, normals, [(0, 1, 2), (0, 3, 4)], TEXCOORD_0=uv))
    _, kept = vertices(document.write(tmp_path / "a.glb"))
    assert sorted_rows(kept).tolist() == sorted_rows([(0, 0, 1), (0, 1, 0), (1, 0, 0), (0, 0, 1)]).tolist()


def test_mesh_without_normals_does_not_affect_other_meshes_in_its_file(tmp_path):
    document = Document()
    n = unit(np.array([(1, 2, 2), (0, 3, 4), (-2, 1, 2)], float))
    document.node(mesh=document.mesh(TRIANGLE, None, [(0, 1, 2)]))
    document.node(mesh=document.mesh(TRIANGLE, n, [(0, 1, 2)]))
    _, normals = vertices(document.write(tmp_path / "a.glb"))
    assert sorted_rows(normals) == pytest.approx(sorted_rows(n), abs=1e-6)


def test_zero_length_and_nan_normals_are_left_out_and_counted(tmp_path, run):
    document = Document()
    n = [(0, 0, 2), (0, 0, 0), (np.nan, 0, 1), (0, -1e30, 1), (0.1, 0, 0)]
    document.node(mesh=document.mesh(np.arange(15.0).reshape(5, 3), n, mode=0))
    path = document.write(tmp_path / "a.glb")
    loaded, normals = vertices(path)
    assert (loaded.count, loaded.background, loaded.not_finite) == (5, 1, 2)
    assert sorted_rows(normals) == pytest.approx(np.array([(0, 0, 1), (1, 0, 0)]))
    status, out, err = run(
        *("quality", "--encoding", "octahedral", "--normals", f"{path}#vertices", "--backend", "jax"),
        *("--format", "json"),
    )
    assert status == 0 and "1 vertex normals of zero length and 2 NaN or infinite vertex normals are left out" in err
    (row,) = json.loads(out)
    assert (row["count"], row["background"], row["not_finite"]) == (2, 1, 2)
    assert (row["normals"], row["code_space"]) == ("a.glb#vertices", "object")


def test_each_kind_of_mesh_file_gives_its_normals(tmp_path):
    """An OBJ file's two materials share vertices; PLY files have any byte order."""
    (tmp_path / "a.obj").write_text(OBJ.replace("vn 0 0 2", "vn 0 3 4"))
    assert sorted_rows(vertices(tmp_path / "a.obj")[1]).tolist() == [[0, 0.6, 0.8]] * 4
    for order in ("ascii", "binary_little_endian", "binary_big_endian"):
        (tmp_path / "a.ply").write_bytes(ply(order, BALL.triangles.tolist(), BALL.positions, BALL.normals))
        # The poles are one vertex for all slices, and the last meridian is the first.
        assert len(vertices(tmp_path / "a.ply")[1]) == 24 * 15 + 2
    assert vertices(CLOUD)[1].tolist() == [[0, 0, 1], [0, 1, 0]]


def test_zero_length_normals_of_a_cloud_are_counted_and_splats_have_no_normals(tmp_path, run):
    """In Gaussian splats, nx, ny and nz are all 0."""
    path = tmp_path / "a.ply"
    path.write_text(CLOUD.read_text().replace("vertex 2", "vertex 3") + "2 0 0 0 0 0\n")
    (cloud,) = normal_sets_named(str(path), 0, 0, Reading())
    assert (cloud.count, cloud.background, cloud.code_space, cloud.has_rays) == (3, 1, "object", False)
    (seen,) = normal_sets_named(str(path), 0, 0, Reading(fov=60.0))
    assert (seen.code_space, seen.has_rays) == ("view", True)
    path.write_text(CLOUD.read_text().replace("0 0 1", "0 0 0").replace("0 1 0", "0 0 0"))
    for name, text in ((path, "none of its points has a normal"), (f"{path}#vertices", "none of its 2 vertex normals")):
        status, out, err = run("quality", "--encoding", "octahedral", "--normals", str(name))
        assert (status, out) == (2, "") and len(err.splitlines()) == 1 and text in err, err


def test_encoding_that_needs_a_view_ray_is_left_out_with_a_one_line_message(tmp_path, run):
    path = as_glb(tmp_path / "a.glb", BALL)
    words = ("quality", "--normals", f"{path}#vertices", "--backend", "jax", "--format", "json")
    status, out, err = run(*words, "--encoding", "octahedral,per_pixel_view")
    message = "per_pixel_view on a.glb#vertices: it needs the view ray, which normals in object space do not have"
    assert status == 0 and [row["encoding"] for row in json.loads(out)] == ["octahedral"]
    assert err == f"normalbench: left out: {message}\n"
    status, out, err = run(*words, "--encoding", "per_pixel_view")
    assert (status, out, err) == (2, "", f"normalbench: {message}\n")
    named = ("--encoding", "per_pixel_view")
    for words in (("mix", *named), ("pick", *named, "--storage", "rg8")):
        status, out, err = run(*words, "--normals", f"{path}#vertices")
        assert status == 2 and len(err.splitlines()) == 1 and "needs the view ray" in err, err


def as_glb(path, mesh: Mesh):
    document = Document()
    document.node(mesh=document.mesh(mesh.positions, mesh.normals, mesh.triangles))
    return document.write(path)


BAD = {
    "a part that no file has": ("ball.glb#normals", "unknown part 'normals' of a mesh file; known: ball.glb#vertices"),
    "a file that is not there": ("lost.glb#vertices", "lost.glb: there is no such file"),
    "an image": ("frame.png#vertices", "unknown normal set 'frame.png#vertices'"),
    "no normals": ("bare.glb#vertices", "bare.glb: no vertex normals in it; export it with normals"),
    "no mesh": ("empty.glb#vertices", "empty.glb: no vertex normals in it; export it with normals"),
    "zeros alone": ("zeros.glb#vertices", "zeros.glb: none of its 3 vertex normals has a direction"),
    "no triangle": ("none.ply#vertices", "none.ply: neither vertices with x, y, z and faces with vertex_indices"),
    "an index too large": ("beyond.ply#vertices", "beyond.ply: the mesh: index 2 refers to vertex 9, but there are 3"),
    "options of captures": (
        "ball.glb#vertices --fov 60",
        "options for captures are given, but --normals ball.glb#vertices names no capture",
    ),
}


@pytest.mark.parametrize("what", BAD)
def test_bad_input_is_a_one_line_error(run, tmp_path, monkeypatch, what):
    monkeypatch.chdir(tmp_path)
    as_glb(tmp_path / "ball.glb", BALL)
    for name, normals in (("bare", None), ("zeros", np.zeros((3, 3)))):
        document = Document()
        document.node(mesh=document.mesh(TRIANGLE, normals, [(0, 1, 2)]))
        document.write(tmp_path / f"{name}.glb")
    Document().write(tmp_path / "empty.glb")
    (tmp_path / "none.ply").write_text(CLOUD.read_text().replace(" nx", " ax"))
    (tmp_path / "beyond.ply").write_bytes(ply("ascii", [[0, 1, 9]]))
    words, message = BAD[what]
    status, out, err = run("quality", "--encoding", "octahedral", "--normals", *words.split())
    assert (status, out) == (2, "") and len(err.splitlines()) == 1 and message in err, err


def test_gates_and_workers_find_the_file(tmp_path, monkeypatch, run):
    """The option's value counts as a file next to the gates, and the file is part of a step's identity."""
    from normalbench.bench.ground.user_files import file_of, files_in, with_files
    from normalbench.bench.run.measuring import files_of
    from normalbench.bench.tables.quality.table import QualityOptions

    as_glb(tmp_path / "ball.glb", BALL)
    gate = '[[gate]]\nencoding = "octahedral"\nstorage = "rg8"\nnormals = "ball.glb#vertices"\n'
    (tmp_path / "gates.toml").write_text(gate + 'angle_mean_deg = "at most 0.4"\n')
    status, out, err = run("check", str(tmp_path / "gates.toml"))
    assert status == 0, out + err
    monkeypatch.chdir(tmp_path)
    word = "ball.glb#vertices"
    assert str(file_of(word)) == "ball.glb" and files_in(word) == ["ball.glb"]
    assert with_files(word, {"ball.glb": "there/x.glb"}) == "there/x.glb#vertices"
    before = files_of(QualityOptions(normals=word))
    as_glb(tmp_path / "ball.glb", sphere(2.0, 5, 4))
    assert len(before["files"]) == 1 and files_of(QualityOptions(normals=word)) != before


def test_python_functions_accept_vertices(tmp_path):
    import normalbench

    path = as_glb(tmp_path / "a,b.glb", BALL)
    table = normalbench.quality(encoding="octahedral", storage="rg8", normals=f"{path}#vertices", backend="jax")
    (row,) = table.to_dict("records")
    assert row["count"] == 24 * 15 + 2 and row["normals"] == "a,b.glb#vertices"


def turned_deg(exact: np.ndarray, found: np.ndarray) -> float:
    """Return the mean angle between unit normals, in degrees."""
    return float(np.degrees(2 * np.arcsin(np.minimum(np.linalg.norm(exact - found, axis=1) / 2, 1))).mean())


@pytest.mark.parametrize("kind, noted", [(np.int8, True), (np.int16, False)])
def test_gltf_integers_report_their_own_error(tmp_path, capsys, kind, noted):
    """Measured against the exact normals, the error is 0.17 degrees in 8 bits and 1/258 of it in 16 bits."""
    exact, full = directions(3000), np.iinfo(kind).max
    path = ball_of(np.round(exact * full).astype(kind)).write(tmp_path / "a.glb")
    loaded, normals = vertices(path)
    right = turned_deg(exact, normals)
    assert right == pytest.approx(0.17 * 127 / full, rel=0.05)
    assert loaded.own_error_deg == pytest.approx(right, rel=0.05)
    err = capsys.readouterr().err
    message = (
        "its vertex normals have 8 bits and are off by about 0.17 degrees themselves: "
        "encodings with a mean error below 0.06"
    )
    assert (message in err) == noted and len(err.splitlines()) == noted, err


@pytest.mark.parametrize("bits", [6, 8, 10, 12])
def test_an_octahedral_map_is_detected_with_its_error(bits):
    """Draco and meshoptimizer pack normals in an octahedral map of few bits; exact normals show no such grid."""
    exact = directions(2000)
    (storage,) = storages_named(f"snorm:{bits}:{bits}")
    codec = Codec(ENCODINGS["octahedral"], storage)
    decoded = codec.round_trip(Vec3(*exact.T.astype(np.float32)), Vec3(*np.zeros((3, 2000), np.float32)))
    packed = np.stack([np.asarray(component) for component in decoded], axis=1).astype(np.float64)
    (rounding,) = all_roundings(packed, ())
    assert rounding == Rounding(2 ** (bits - 1) - 1, is_octahedral=True)
    assert own_error_deg(packed, [rounding]) == pytest.approx(turned_deg(exact, packed), rel=0.05)
    short = unit(np.round(packed * 32767) / 32767)
    assert all_roundings(short, [Rounding(32767)]) == (rounding, Rounding(32767))
    assert all_roundings(exact, ()) == ()


def test_few_normals_or_normals_along_axes_are_not_taken_for_a_map():
    """A box fits every grid and is exact, so no map is reported."""
    box = np.repeat(np.concatenate([np.eye(3), -np.eye(3)]), 100, axis=0)
    assert all_roundings(box, ()) == () and own_error_deg(box, [Rounding(127)]) == 0
    few = unit(np.array([(a, b, 7 - abs(a) - abs(b)) for a in range(-3, 4) for b in range(-3, 4)], float))
    assert len(few) < own_errors.DIFFERENT and all_roundings(few, ()) == ()


@pytest.mark.parametrize(
    "kind, order", [("char", "ascii"), ("uchar", "ascii"), ("char", "binary_big_endian"), ("short", "ascii")]
)
def test_integer_normals_of_points_are_read_with_their_error(tmp_path, run, kind, order):
    """A signed 127 means 1; unsigned 0 to 255 mean -1 to 1. Files are read as clouds and as vertices."""
    exact = directions(2000)
    full = {"char": 127, "uchar": 255, "short": 32767}[kind]
    stored = np.round((exact + 1) / 2 * 255) if kind == "uchar" else np.round(exact * full)
    head = f"ply\nformat {order} 1.0\nelement vertex 2000\n"
    head += "".join(f"property {kind} {name}\n" for name in ("nx", "ny", "nz")) + "end_header\n"
    text = "\n".join(" ".join(map(str, row)) for row in stored.astype(int)).encode() + b"\n"
    path = tmp_path / "points.ply"
    path.write_bytes(head.encode() + (text if order == "ascii" else stored.astype(">i1").tobytes()))
    (cloud,) = normal_sets_named(str(path), 0, 0, Reading())
    for loaded in (cloud, vertices(path)[0]):
        n, covered = given(loaded)
        right = turned_deg(exact, unit(n[covered].astype(float)))
        assert right == pytest.approx(0.17 * 127 / min(full, 32767) * (2 if kind == "uchar" else 1), rel=0.06)
        assert loaded.own_error_deg == pytest.approx(right, rel=0.06) and loaded.code_space == "object"
    _, _, err = run("quality", "--encoding", "octahedral", "--normals", str(path), "--backend", "jax")
    assert ("its normals have 8 bits and are off by about 0.17 degrees" in err) == (kind != "short"), err


def test_rendered_mesh_reports_the_error_of_its_vertices(tmp_path):
    """Vertex errors partly cancel inside a triangle, on average by at most a factor of sqrt(1/2); the error is
    measured against the same image with float normals."""
    ball = sphere(1.0, 48, 32)
    exact, coarse = Document(), Document()
    for document, kind in ((exact, None), (coarse, np.int8)):
        mesh = document.mesh(ball.positions, ball.normals, ball.triangles)
        if kind:
            stored = np.round(ball.normals * 127).astype(kind)
            index = document.accessor(stored, True)
            document.json["meshes"][mesh]["primitives"][0]["attributes"]["NORMAL"] = index
        document.node(mesh=mesh)
    coarse.json["extensionsRequired"] = ["KHR_mesh_quantization"]
    paths = [d.write(tmp_path / f"{name}.glb") for d, name in ((exact, "exact"), (coarse, "coarse"))]
    sets = normal_sets_named(",".join(map(str, paths)), 0, 0, Reading(size="160x120"))
    (right, covered), (rounded, _) = map(given, sets)
    off = turned_deg(right[covered].astype(float), rounded[covered].astype(float))
    assert sets[0].own_error_deg is None and sets[1].own_error_deg is not None
    assert 0.7 < off / sets[1].own_error_deg < 1.05, (off, sets[1].own_error_deg)
