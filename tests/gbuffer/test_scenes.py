"""Meshes and the software rasteriser."""

import numpy as np
import pytest

from normalbench.gbuffer.scenes import mesh as shapes
from normalbench.gbuffer.scenes import rasterise as rasteriser
from normalbench.gbuffer.scenes.mesh import Mesh
from normalbench.gbuffer.scenes.models.teapot import HEIGHT, control_points, teapot
from normalbench.gbuffer.scenes.rasterise import Camera, rasterise

CAMERA = Camera(width=160, height=120, fov=60.0, near=0.1, far=100.0)


def test_the_teapot_has_the_published_outline():
    """32 patches; 3.15 high, the spout's lip at x = 3.4334, the handle at -2.99, 4 wide (Newell 1975)."""
    assert control_points().shape == (32, 4, 4, 3)
    pot = teapot(24)
    assert pot.positions[:, 2].min() == 0 and pot.positions[:, 2].max() == pytest.approx(HEIGHT)
    assert pot.positions[:, 0].max() == pytest.approx(3.4334, abs=0.01)
    assert pot.positions[:, 0].min() == pytest.approx(-3.0, abs=0.01)
    assert abs(pot.positions[:, 1]).max() == pytest.approx(2.0, abs=0.01)


def test_the_teapots_normals_point_out():
    pot = teapot(8)
    assert np.allclose(np.linalg.norm(pot.normals, axis=1), 1)
    lid, bottom = pot.positions[:, 2].argmax(), pot.positions[:, 2].argmin()
    assert pot.normals[lid][2] > 0.99 and pot.normals[bottom][2] < -0.99
    belly = np.flatnonzero(abs(pot.positions[:, 2] - 0.9) < 1e-6)
    # The handle's lower end touches the belly at (-2, 0); its own normals there are another matter.
    belly = belly[(np.linalg.norm(pot.positions[belly, :2], axis=1) > 1.99) & (pot.positions[belly, 0] > -1.9)]
    assert len(belly) >= 48
    assert np.all(np.sum(pot.normals[belly, :2] * pot.positions[belly, :2], axis=1) > 0)


def test_mesh_upload_is_built_once(monkeypatch):
    """Each vertex has position, normal, tangent and uv, the last twice; the next frame uploads the same array."""
    ball = shapes.sphere(2.0, 8, 4)
    vertices, triangles = ball.uploaded
    expected = np.concatenate([ball.positions, ball.normals, shapes.tangents(ball), ball.uv, ball.uv], axis=1)
    np.testing.assert_array_equal(vertices, expected.astype(np.float32))
    np.testing.assert_array_equal(triangles, shapes.wound(ball))
    assert vertices.dtype == np.float32 and triangles.dtype == np.int32
    monkeypatch.setattr(shapes, "tangents", None)
    assert ball.uploaded[0] is vertices


def test_patches_meet():
    """Adjacent patches share all four control points of their common edge, along the profile and around it."""
    turned = control_points()[:24].reshape(6, 4, 4, 4, 3)
    rim, upper, lower, knob, lid, bottom = turned
    for above, below in ((rim, upper), (upper, lower), (knob, lid)):
        assert np.allclose(above[:, 3], below[:, 0])
    assert np.allclose(lower[:, 3], bottom[:, 3])
    for ring in turned:
        assert np.allclose(ring[:, :, 3], np.roll(ring, -1, axis=0)[:, :, 0])
    limbs = control_points()[24:].reshape(2, 2, 2, 4, 4, 3)
    for first, second in limbs:
        assert np.allclose(first[:, 3], second[:, 0]), "handle and spout continue from one patch to the next"


def test_placement_transforms_normals_by_the_inverse_transpose():
    ball = shapes.sphere(1.0, 16, 8)
    flattened = ball.placed(np.diag([1.0, 1.0, 0.25]), (0, 0, 0))
    tangent = np.cross(flattened.normals, [0.3, -0.5, 0.8])
    # A normal of an ellipsoid is the gradient of its quadric.
    gradient = flattened.positions * (1, 1, 16)
    assert np.allclose(np.sum(gradient * tangent, axis=1), 0, atol=1e-9)


def test_rotation_is_roll_then_pitch_then_yaw_for_row_vectors():
    quarter = np.pi / 2
    x, y, z = np.eye(3)
    assert np.allclose(x @ shapes.rotation(0, 0, quarter), y)
    assert np.allclose(y @ shapes.rotation(0, quarter, 0), z)
    assert np.allclose(z @ shapes.rotation(quarter, 0, 0), x)
    assert np.allclose(x @ shapes.rotation(quarter, 0, quarter), y)
    assert np.allclose(x @ shapes.rotation(0, quarter, quarter), z)


def test_a_sphere_is_drawn_at_its_position_and_faces_the_eye():
    """Positions and normals of a finely tessellated sphere are compared with the ray's analytic hit."""
    ball = shapes.sphere(1.0, 256, 128).placed(np.eye(3), (0, 0, -4))
    seen = rasterise(ball, CAMERA)
    half = np.tan(np.radians(30))
    column, row = np.meshgrid(np.arange(160) + 0.5, np.arange(120) + 0.5)
    ray = np.stack([(column / 80 - 1) * half * 160 / 120, (1 - row / 60) * half, -np.ones_like(row)], axis=-1)
    ray /= np.linalg.norm(ray, axis=-1, keepdims=True)
    along = -4 * ray[..., 2]
    inside = along**2 - 15
    well_inside = inside > 0.05
    hit = ray * (along - np.sqrt(np.maximum(inside, 0)))[..., None]
    assert np.all(seen.covered[well_inside]) and not np.any(seen.covered[inside < -0.01])
    assert np.allclose(seen.positions[well_inside], hit[well_inside], atol=2e-3)
    assert np.allclose(seen.normals[well_inside], (hit - (0, 0, -4))[well_inside], atol=2e-3)


def test_the_nearest_surface_wins_in_any_order():
    near = shapes.box(1, 1, 0.1).placed(np.eye(3), (0, 0, -3))
    far = shapes.box(4, 4, 0.1).placed(np.eye(3), (0, 0, -6))
    a, b = (rasterise(shapes.joined(order), CAMERA) for order in ([near, far], [far, near]))
    assert np.array_equal(a.positions, b.positions)
    assert a.positions[60, 80, 2] == pytest.approx(-2.95)
    assert a.positions[60, 50, 2] == pytest.approx(-5.95)


def test_a_floor_that_passes_under_the_eye_has_no_holes():
    """Triangles that reach behind the eye need no clipping; shared edges leave no cracks."""
    floor = shapes.box(200, 0.1, 200).placed(np.eye(3), (0, -1.05, 0))
    seen = rasterise(floor, CAMERA)
    assert seen.covered[70:].all(), f"{(~seen.covered[70:]).sum()} holes"
    assert np.allclose(seen.positions[seen.covered][:, 1], -1, atol=1e-4)
    assert not seen.covered[:59].any()


def test_the_background_has_no_normal():
    seen = rasterise(shapes.box(0.1, 0.1, 0.1).placed(np.eye(3), (0, 0, -3)), CAMERA)
    assert not seen.normals[~seen.covered].any()
    assert np.all(seen.positions[~seen.covered] == (0, 0, -100))


def test_skipping_squares_that_no_triangle_meets_loses_no_pixels(monkeypatch):
    """Random large triangles, many of which reach behind the eye."""
    rng = np.random.default_rng(5)
    corners = rng.uniform((-9, -9, -12), (9, 9, 2), (40, 3, 3)).reshape(-1, 3)
    normals = rng.normal(size=(120, 3))
    mesh = Mesh(corners, normals, np.arange(120).reshape(40, 3), np.zeros((120, 2)))
    tried: list[np.ndarray] = []

    def all_squares(inverse, boxes, camera):
        tried.append(is_met(inverse, boxes, camera))
        return np.ones(len(boxes), bool)

    raster, is_met = rasterise(mesh, CAMERA), rasteriser._is_met
    monkeypatch.setattr(rasteriser, "_is_met", all_squares)
    expected = rasterise(mesh, CAMERA)
    for name in ("normals", "positions", "covered"):
        np.testing.assert_array_equal(getattr(raster, name), getattr(expected, name))
    assert 0.2 < tried[0].mean() < 0.6, "what is drawn anyway says nothing"
