"""The renderer's light, shadows and positions, compared with formulas in float64."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import relighting
from drawing import BLINN_PHONG, EXACT, SIZE, apart, draw, drawn, scene_of
from relighting import relight, surfaces
from test_relighting import BLOCK, SUN, block_over_floor, line_up

from normalbench.gbuffer.frame.resources import SHADOW_SIZE
from normalbench.gbuffer.frame.scene_buffers import sun_matrix
from normalbench.gbuffer.layouts.presets import LAYOUTS
from normalbench.gbuffer.passes.shadow_map import SHADOW_OFFSET
from normalbench.gbuffer.scenes.built_in.playground import in_view_space
from normalbench.gbuffer.scenes.mesh import joined
from normalbench.gbuffer.scenes.rasterise import Camera, rasterise


def test_special_materials_can_emit_light(gl):
    """Every ball of the line-up emits light, under all lamps and the sun: at least 80 dB against the formulas."""
    scene = line_up()
    glowing = tuple(replace(m, emissive=(0.1, 0.2 + 0.1 * i, 0.3)) for i, m in enumerate(scene.materials))
    scene = replace(scene, materials=glowing, ambient=(0.1, 0.05, 0.02))
    seen = surfaces(scene, draw(gl, "prepass", scene).gbuffer)
    expected = relighting.image(scene, seen, relight(scene, seen, None))
    for pipeline in EXACT:
        decibels = apart(draw(gl, pipeline, scene).image, expected)
        assert decibels >= 80, f"{pipeline}: {decibels:.1f} dB"


def test_the_shadow_map_stores_the_far_sides_of_casters(gl):
    """Except near outlines and edges, each texel stores the depth at which the sun's ray through its centre leaves
    the box. The depth is offset by a multiple of that side's slope, by either measure that OpenGL allows, and by
    steps of 24-bit depth. Where the ray misses the box, the depth is 1."""
    scene = block_over_floor()
    depths = draw(gl, "deferred", scene, shadows=True).shadow_map
    matrix = sun_matrix(scene)
    column, row = np.meshgrid(np.arange(SHADOW_SIZE) + 0.5, np.arange(SHADOW_SIZE) + 0.5)
    start = np.stack([column / SHADOW_SIZE, row / SHADOW_SIZE, np.zeros_like(row)], axis=2) - matrix[:3, 3]
    start = start @ np.linalg.inv(matrix[:3, :3]).T
    low, high = ((side - start) / np.array(SUN) for side in BLOCK)
    enters, leaves = np.minimum(low, high).max(axis=2), np.maximum(low, high)
    # Depth goes with the way along the ray.
    per_way = matrix[2, :3] @ np.array(SUN)
    way = leaves.min(axis=2)
    texel = 1 / np.linalg.norm(matrix[:2, :3], axis=1).min() / SHADOW_SIZE
    passes_by = enters > way + 10 * texel
    assert passes_by.sum() > 10_000 and (depths[passes_by] == 1).all(), "something is in the way of a free ray"
    slopes, steps = SHADOW_OFFSET
    for axis in range(3):
        here = (leaves.argmin(axis=2) == axis) & (way > enters + 10 * texel)
        here &= np.sort(leaves, axis=2)[..., 1] > way + 10 * texel
        across = np.linalg.inv(matrix[:3, :3]).T @ np.eye(3)[axis]
        slope = abs(across[:2] / across[2]) / SHADOW_SIZE
        offsets = depths[here] - way[here] * per_way
        # Corners lie on a grid of 1/256 texel, as a GPU snaps them: half of it, along each axis, moves a side.
        snapped = slope.sum() / 512
        least = slopes * slope.max() - snapped - 1e-6
        most = slopes * np.linalg.norm(slope) + 2 * steps * 2.0**-24 + snapped + 1e-6
        assert here.sum() > 5000
        assert offsets.min() >= least and offsets.max() <= most, (
            f"side {axis}: {offsets.min():.3g} to {offsets.max():.3g} behind, not {least:.3g} to {most:.3g}"
        )


def test_positions_from_either_depth_agree(gl):
    """Positions are reconstructed from z/w by the inverse projection, and from linear depth along the eye's ray. A
    step of 2^-24 in z/w is d^2 (f - n) / (f n) 2^-24 in depth; positions agree to eight such steps plus 2^-20 of the
    depth. From pixel to pixel, depth changes by a pixel's extent over the cosine, and screen positions are accurate
    to 2^-16 of a pixel."""
    for name in BLINN_PHONG:
        scene = scene_of(name)
        near, far = scene.view.near, scene.view.far
        linear, normals = drawn(gl, "deferred", name, False).gbuffer[:2]
        native = draw(gl, "deferred", scene, layout=LAYOUTS["hybrid"]).gbuffer[0]
        covered = linear[..., 3] > 0
        position = linear[covered][:, :3].astype(np.float64)
        depth, away = -position[:, 2], np.linalg.norm(position, axis=1)
        cosine = abs(np.sum(normals[covered][:, :3] * position, axis=1)) / away
        slope = depth * 2 * np.tan(np.radians(scene.view.fov / 2)) / SIZE[1] / np.maximum(cosine, 1e-3)
        step = depth**2 * (far - near) / (far * near) * 2.0**-24
        error = np.linalg.norm(native[covered][:, :3].astype(np.float64) - position, axis=1)
        allowed = (8 * step + depth * 2.0**-20 + slope * 2.0**-16) * away / depth
        assert np.all(error <= allowed), f"{name}: {np.max(error / allowed):.2f} of what is allowed"


def test_positions_match_the_software_rasteriser(gl):
    """On the playground, positions agree to 0.01 of a pixel's extent along the surface plus 1e-5 of the depth; OpenGL
    moves vertices by up to 1/512 of a pixel. Up to one pixel in 500, at edges, may show another surface."""
    scene = scene_of("playground")
    reference = rasterise(joined(in_view_space()), Camera(*SIZE, scene.view.fov, scene.view.near, scene.view.far))
    seen = drawn(gl, "deferred", "playground", False).gbuffer
    covered = (seen[0][..., 3] > 0) & reference.covered
    assert np.mean((seen[0][..., 3] > 0) != reference.covered) < 0.002
    position = reference.positions.astype(np.float64)
    depth = -position[..., 2]
    error = np.linalg.norm(seen[0][..., :3] - position, axis=2)
    # One pixel covers `extent` across the line of sight, and that over the cosine along the surface.
    extent = depth * 2 * np.tan(np.radians(scene.view.fov / 2)) / SIZE[1]
    cosine = abs(np.sum(reference.normals * position, axis=2)) / np.linalg.norm(position, axis=2)
    allowed = 0.01 * extent / np.maximum(cosine, 0.02) + 1e-5 * depth
    wrong = covered & (error > allowed)
    assert wrong.sum() <= covered.sum() / 500, f"{wrong.sum()} of {covered.sum()} pixels"
    turned = covered & (np.sum(seen[1][..., :3] * reference.normals, axis=2) < np.cos(np.radians(1.0)))
    assert turned.sum() <= covered.sum() / 500, f"{turned.sum()} of {covered.sum()} normals"
