"""The error of a method of ambient occlusion against rays through the scene's own triangles."""

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
    """A method's visibility minus that of rays, over pixels.

    Attributes:
        rms: its root mean square, without the scatter of the rays.
        mean: its mean; above 0 if the method is too bright.
        standard_error: that of `rms`, from the number of pixels and rays.
        least: the smallest difference that the rays can tell from zero: the RMS of their own standard errors.
        visibility: the mean visibility by rays.
    """

    rms: float
    mean: float
    standard_error: float
    least: float
    visibility: float


class Pixels(NamedTuple):
    """Some drawn pixels: world-space positions, moved towards the eye, normals, and visibility by the effect."""

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
    """Compare a method of ambient occlusion with rays of its own radius and fall-off, from the same fp32 G-buffer.

    Args:
        device: the device that draws the scene, with the deferred pipeline.
        chosen: the method and its settings; its effect is an `AmbientOcclusion`.
        scene: the scene, drawn from its own view.
        size: the size of the image.
        pixels: the number of pixels, chosen at random among the covered pixels; without hair, whose normal the
            G-buffer does not store.
        rays: the number of rays for each pixel.
        seed: the seed of the random choice and the rays.

    Raises:
        MissingError: embreex is not installed.
        EffectError: the effect is not a method of ambient occlusion.
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
    """Return the errors of visibilities, compared with the exact visibilities by rays. The noise of the rays, given
    as standard errors, is subtracted from the RMS."""
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
    random and without hair, with their positions and normals in world space."""
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
