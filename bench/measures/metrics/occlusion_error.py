"""The error of an ambient occlusion method, compared with rays cast against the scene's own triangles."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....gbuffer.effects.effect import ChosenEffect, EffectError
from ....gbuffer.effects.occlusion.passes import AmbientOcclusion
from ....gbuffer.frame.plan import Plan
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import rendering
from ....gbuffer.scenes.scene import KINDS, Scene
from .visibility import NEARER, RayCaster, triangles_of

if TYPE_CHECKING:
    from jaxtyping import Float

PIXELS, RAYS = 4096, 1024
HAIR = KINDS.index("hair")


class OcclusionError(NamedTuple):
    """The difference between a method's visibility and the visibility by rays, over pixels.

    Attributes:
        rms: the root mean square of the difference, without the noise of the rays.
        mean: the mean of the difference; above 0 if the method is too bright.
        standard_error: the standard error of `rms`, from the number of pixels and rays.
        least: the smallest difference that the rays can tell from zero: the RMS of their own standard errors.
        visibility: the mean visibility by rays.
    """

    rms: float
    mean: float
    standard_error: float
    least: float
    visibility: float


class Pixels(NamedTuple):
    """World-space positions of drawn pixels, moved towards the eye, their normals, and the effect's visibility."""

    positions: Float[np.ndarray, "pixels 3"]
    normals: Float[np.ndarray, "pixels 3"]
    visibility: Float[np.ndarray, " pixels"]


def method_error(
    device: Device,
    chosen: ChosenEffect,
    scene: Scene,
    size: tuple[int, int],
    pixels: int = PIXELS,
    rays: int = RAYS,
    seed: int = 0,
) -> OcclusionError:
    """Compare an ambient occlusion method with rays of the same radius and fall-off, from the same fp32 G-buffer.

    Args:
        device: the device that draws the scene, with the deferred pipeline.
        chosen: the method and its settings; its effect is an `AmbientOcclusion`.
        scene: the scene, drawn from its own view.
        size: the size of the image.
        pixels: the number of pixels, chosen at random from the covered pixels except hair, whose normal the G-buffer
            does not store.
        rays: the number of rays per pixel.
        seed: the seed for the random choice and the rays.

    Raises:
        MissingError: embreex is not installed.
        EffectError: the effect is not an ambient occlusion method.
    """
    method = chosen.effect
    if not isinstance(method, AmbientOcclusion):
        raise EffectError(f"effect {method.name} is not an ambient occlusion method")
    caster, drawn = RayCaster(triangles_of(scene)), drawn_pixels(device, chosen, scene, size, pixels, seed)
    radius = dict(chosen.values)["radius"]
    exact = caster.visible(drawn.positions, drawn.normals, rays, lambda far: method.falls_off(far / radius), seed)
    return compared(drawn.visibility, exact.visibility, exact.error)


def compared(
    visibilities: Float[np.ndarray, " pixels"], exact: Float[np.ndarray, " pixels"], error: Float[np.ndarray, " pixels"]
) -> OcclusionError:
    """Return the error of visibilities compared with the exact visibilities by rays. The noise of the rays, given as
    standard errors, is subtracted from the RMS."""
    difference, noise = visibilities - exact, float(np.mean(error**2))
    square = difference**2
    rms = float(np.sqrt(max(np.mean(square) - noise, 0.0)))
    # rms = sqrt(mean of squares): its error is that of the mean over 2 rms
    scatter = float(square.std(ddof=1) / np.sqrt(len(square))) if len(square) > 1 else np.inf
    return OcclusionError(
        rms=rms,
        mean=float(difference.mean()),
        standard_error=scatter / (2 * max(rms, np.sqrt(noise), 1e-9)),
        least=float(np.sqrt(noise)),
        visibility=float(exact.mean()),
    )


def drawn_pixels(
    device: Device, chosen: ChosenEffect, scene: Scene, size: tuple[int, int], pixels: int, seed: int
) -> Pixels:
    """Draw an effect over an fp32 G-buffer, and return its visibility at up to `pixels` covered pixels, chosen at
    random from those without hair, with the pixels' positions and normals in world space."""
    plan = Plan(size, 1, LAYOUTS["fp32"], LIGHT_BUFFERS["rgba32f"], 1, False, 1.0)
    pipeline = PIPELINES["deferred"].with_effect(chosen.passes())
    with rendering(device, pipeline, scene, plan) as renderer:
        renderer.draw()
        position, direction, *_ = renderer.gbuffer()
        visibility = renderer.read(chosen.effect.result)[0].reshape(position.shape[:2])
    there = np.flatnonzero((position[..., 2] != 0) & (direction[..., 3] != HAIR))
    lot = np.random.default_rng(seed).permutation(there)[:pixels]
    return Pixels(
        *_rays_in_world(scene, position.reshape(-1, 4)[lot, :3], direction.reshape(-1, 4)[lot, :3]),
        visibility.ravel()[lot],
    )


def _rays_in_world(
    scene: Scene, position: Float[np.ndarray, "pixels 3"], direction: Float[np.ndarray, "pixels 3"]
) -> tuple[Float[np.ndarray, "pixels 3"], Float[np.ndarray, "pixels 3"]]:
    to_world = np.linalg.inv(scene.view.matrix())
    nearer = position.astype(np.float64) * (1 - NEARER)
    return nearer @ to_world[:3, :3].T + to_world[:3, 3], direction.astype(np.float64) @ to_world[:3, :3].T
