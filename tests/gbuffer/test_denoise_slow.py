"""The denoiser compared with NumPy, with surfaces of known normals, and with means of its rays."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import pytest
from drawing import FP32
from occluded import effect, plan_of

from normalbench.encodings.catalogue import ENCODINGS
from normalbench.encodings.codecs.codec import Codec
from normalbench.encodings.storages.storage import STORAGES
from normalbench.gbuffer.effects.denoise import EFFECT
from normalbench.gbuffer.effects.denoise.passes import FILTER, GUIDE, ROUGHNESS
from normalbench.gbuffer.pipelines import PIPELINES
from normalbench.gbuffer.render import rendering
from normalbench.gbuffer.scenes.mesh import plane, sphere
from normalbench.gbuffer.scenes.metal_rough import MetalRough
from normalbench.gbuffer.scenes.scene import Light, Scene, ScenePart, View, placed

SIZE = (64, 48)
# All of a 5 x 5 kernel but its middle.
WHOLE = 1 - 0.375**2
BALL, RADIUS = np.array([0.0, 1.0, 0.0]), 0.8
VIEW = View((0.3, 1.4, 4.0), (0.0, 0.8, 0.0), 40.0, 0.5, 40.0)


def scene_of(*parts: ScenePart, view: View = VIEW) -> Scene:
    materials = (MetalRough((0.8, 0.6, 0.4), 1.0, 0.3), MetalRough((0.5, 0.5, 0.5), roughness=0.6))
    lights = (Light("sun", (1.0, 0.9, 0.8), direction=(-0.48, -0.8, -0.36)),)
    return Scene(parts, materials, lights, (0.4, 0.45, 0.5), view, view)


FLOOR = ScenePart(plane(40.0, 40.0), placed((0.0, 0.0, 0.0)), np.array([1]))
ON_A_FLOOR = scene_of(FLOOR, ScenePart(sphere(RADIUS, 96, 64), placed(BALL), np.array([0])))
# Nothing but the floor is in the picture.
DOWN = View((0.0, 3.0, 0.1), (0.0, 0.0, 0.0), 40.0, 0.5, 40.0)
FLOOR_ALONE = scene_of(FLOOR, view=DOWN)


@dataclass
class Denoised:
    """Resources of the last of several frames, each (height, width, channels)."""

    noisy: list[np.ndarray]
    guide: np.ndarray
    roughness: np.ndarray
    history: np.ndarray
    weights: np.ndarray
    denoised: np.ndarray


def denoised(gl, scene: Scene, settings: str = "", frames: int = 1, layout=FP32) -> Denoised:
    chosen = effect(f"denoise:passes=1{settings}")
    with rendering(gl, PIPELINES["deferred"].with_effect(chosen.passes()), scene, plan_of(SIZE, layout)) as drawing:
        noisy = []
        for _ in range(frames):
            drawing.draw()
            noisy.append(drawing.read(EFFECT.noisy)[0].astype(np.float64))
        names = GUIDE, ROUGHNESS, EFFECT.history, EFFECT.weights, EFFECT.result
        return Denoised(noisy, *(drawing.read(name)[0].astype(np.float64) for name in names))


def depth_slope(depth: np.ndarray, axis: int) -> np.ndarray:
    """Return the change of depth by a pixel, by the neighbour that is less far off; rows go downwards."""
    padded = np.pad(depth, 1)
    rows, columns = depth.shape
    ahead, behind = (
        padded[1 - side * axis : 1 - side * axis + rows, 1 + side * (1 - axis) : 1 + side * (1 - axis) + columns]
        for side in (1, -1)
    )
    up, down = np.where(ahead > 0, ahead - depth, np.inf), np.where(behind > 0, depth - behind, np.inf)
    least = np.where(abs(up) < abs(down), up, down)
    return np.where(np.isfinite(least), least, 0)


def filtered(image: Denoised, normal_weight) -> tuple[np.ndarray, np.ndarray]:
    """Return one pass of the filter over the history, (height, width, 3), and the neighbours' weights."""
    depth, n, roughness = image.guide[..., 3], image.guide[..., :3], image.roughness[..., 0]
    slope = depth_slope(depth, 0), depth_slope(depth, 1)
    kernel, (rows, columns) = (0.375, 0.25, 0.0625), depth.shape
    sums, total = np.zeros((rows, columns, 3)), np.zeros((rows, columns))

    def moved(values: np.ndarray, x: int, y: int) -> np.ndarray:
        around = np.pad(values, [(2, 2), (2, 2), *[(0, 0)] * (values.ndim - 2)])
        return around[2 - y : 2 - y + rows, 2 + x : 2 + x + columns]

    for x in range(-2, 3):
        for y in range(-2, 3):
            z, r = moved(depth, x, y), moved(roughness, x, y)
            apart = FILTER["SLOPES"] * abs(slope[0] * x + slope[1] * y) + FILTER["LEAST_DEPTH"] * depth
            weight = kernel[abs(x)] * kernel[abs(y)] * (z > 0)
            with np.errstate(divide="ignore", invalid="ignore"):
                near = np.exp(-abs(depth - z) / apart)
            alike = 0.01 + 0.99 * np.clip(roughness * FILTER["ROUGHNESS_SHARE"], 0, 1)
            others = near * normal_weight(np.sum(n * moved(n, x, y), axis=-1), roughness)
            weight = weight * (1 if x == y == 0 else others * np.exp(-3 * abs(roughness - r) / alike))
            sums += weight[..., None] * moved(image.history[..., :3], x, y)
            total += weight
    covered = depth > 0
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(covered[..., None], sums / total[..., None], 0), np.where(covered, total - 0.375**2, 0)


def power(cosine: np.ndarray, _: np.ndarray) -> np.ndarray:
    return np.maximum(cosine, 0) ** 128


def cone(cosine: np.ndarray, roughness: np.ndarray) -> np.ndarray:
    share = 0.75 * 0.15**2
    angle = np.maximum(np.arctan(roughness * np.sqrt(share / (1 - share))), 1.5 / 255)
    t = np.clip(1 - np.arccos(np.clip(cosine, -1, 1)) / angle, 0, 1)
    return t * t * (3 - 2 * t)


@pytest.mark.parametrize("weights, in_numpy, tolerance", [("power", power, 2e-4), ("cone", cone, 2e-2)])
def test_a_pass_of_the_filter_is_that_of_numpy(gl, weights, in_numpy, tolerance):
    """arccos of float32 near 1 is good to 0.02 degrees, which a cone of a few degrees shows."""
    image = denoised(gl, ON_A_FLOOR, f":weights={weights}")
    expected, neighbours = filtered(image, in_numpy)
    assert abs(image.weights[..., 0] - neighbours).max() <= tolerance
    scale = np.maximum(expected, 1)
    assert (abs(image.denoised[..., :3] - expected) / scale).max() <= 10 * tolerance


def test_guides_are_the_normals_of_a_ball_in_world_space(gl):
    """n = (P - C) / R, with P from the depth and the camera."""
    image = denoised(gl, ON_A_FLOOR)
    (rows, columns), axes = image.guide.shape[:2], VIEW.matrix()[:3, :3]
    tall = np.tan(np.radians(VIEW.fov) / 2)
    x, y = (np.arange(columns) + 0.5) * 2 / columns - 1, 1 - (np.arange(rows) + 0.5) * 2 / rows
    rays = np.stack(np.broadcast_arrays(x * tall * columns / rows, (y * tall)[:, None], -1.0), axis=-1)
    places = np.array(VIEW.eye) + (rays * image.guide[..., 3:]) @ axes
    from_ball = places - BALL
    on_ball = abs(np.linalg.norm(from_ball, axis=-1) - RADIUS) < 0.002
    assert on_ball.sum() > 200
    off = np.linalg.norm(image.guide[..., :3] - from_ball / RADIUS, axis=-1)[on_ball]
    assert off.max() < 0.05, f"up to {np.degrees(off.max()):.2f} degrees off; the mesh has facets of 3.75 degrees"


@pytest.mark.parametrize("rounding, is_whole", [("nearest", True), ("dithered", False)])
def test_a_flat_floor_loses_no_neighbour_unless_its_codes_are_dithered(gl, rounding, is_whole):
    """All of its pixels have one code: the weight of every neighbour is 1 up to depth's."""
    layout = FP32.with_codec(Codec(ENCODINGS["octahedral"], STORAGES["rg8"], rounding))
    exact, coded = (denoised(gl, FLOOR_ALONE, layout=each).weights[2:-2, 2:-2] for each in (FP32, layout))
    assert (exact > 0.4).all() and (exact <= WHOLE + 1e-6).all()
    lost = float(np.maximum(exact - coded, 0).max())
    assert (lost <= 1e-5) == is_whole, f"{lost:.2g} of the neighbours' weight is lost"


def test_the_history_is_the_mean_of_the_rays_of_a_still_camera(gl):
    image = denoised(gl, ON_A_FLOOR, frames=6)
    covered = image.guide[..., 3] > 0
    assert (image.history[covered, 3] == 6).all()
    assert abs(image.history[..., :3] - np.mean(image.noisy, axis=0)[..., :3])[covered].max() < 1e-3
    first, second, *_ = image.noisy
    assert (first != second)[covered].any(axis=-1).mean() > 0.1, "each frame has its own noise"


@pytest.mark.parametrize("clamp", ["box", "variance"])
def test_a_clamped_history_is_within_the_rays_around_it(gl, clamp):
    """Light that changes from one frame to the next is not kept: the clamp brings the history to this frame's rays."""
    image = denoised(gl, ON_A_FLOOR, f":clamp={clamp}:of=occlusion", frames=2)
    around = [np.roll(image.noisy[-1][..., 0], (y, x), (0, 1)) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    inside, value = image.guide[..., 3] > 0, image.history[..., 0]
    inside[[0, -1]] = inside[:, [0, -1]] = False
    least, most = np.min(around, axis=0), np.max(around, axis=0)
    assert ((value >= least - 1e-5) & (value <= most + 1e-5))[inside].mean() > 0.99


def test_a_surface_that_appears_has_no_history(gl):
    """A camera that moves to the right sees what the ball hid, to the left of it, and more on the right."""
    chosen = effect("denoise:passes=1")
    with rendering(gl, PIPELINES["deferred"].with_effect(chosen.passes()), ON_A_FLOOR, plan_of(SIZE)) as drawing:
        drawing.draw()
        right = VIEW.matrix()[0, :3] * 0.15
        view = replace(VIEW, eye=tuple(VIEW.eye + right), target=tuple(VIEW.target + right))
        drawing.draw(replace(ON_A_FLOOR, view=view, previous=VIEW))
        frames, guide = drawing.read(EFFECT.history)[0][..., 3], drawing.read(GUIDE)[0]
    fresh = (frames == 1) & (guide[..., 3] > 0)
    assert 0.01 < fresh.mean() < 0.2 and fresh[-1, -1] and not fresh[-1, 10]
