"""Images of an object drawn with a layout: one frame, or the mean of several frames with subpixel offsets."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace

import numpy as np

from ....encodings.catalogue import LIGHT_BUFFERS
from ....encodings.codecs.codec import Codec
from ....gbuffer.frame.plan import Plan
from ....gbuffer.frame.resources import GBUFFER
from ....gbuffer.gl.device import Device
from ....gbuffer.layouts.layout import Layout, engines_space
from ....gbuffer.layouts.presets import LAYOUTS
from ....gbuffer.pipelines import PIPELINES
from ....gbuffer.render import Rendering, rendering
from ....gbuffer.scenes.scene import View
from .objects import OBJECTS, WHITE, Shown

PIPELINE = "deferred"
# The pass that reads the G-buffer: a metal has no light but what lies around.
SHADES = "screen"
# The noise that is added to a code before it is rounded: none; one for all frames; one for each.
NONE, STILL, MOVING = DITHERS = ("none", "still", "moving")


@dataclass(frozen=True)
class Accumulation:
    """The number of frames drawn for an image, and the noise added to the codes of its normals.

    Attributes:
        dither: one of DITHERS.
        frames: number of frames; the image is their mean.
    """

    dither: str = NONE
    frames: int = 1


class Frames:
    """Frames of an object with one layout, drawn once and released with the stack.

    Attributes:
        made: the rendering of each frame.
        covered: mask of the pixels in which at least one frame shows the object, (height, width).

    Raises:
        ShaderError, FormatError, LayoutError: the frames cannot be drawn.
    """

    def __init__(
        self,
        device: Device,
        stack: ExitStack,
        what: Shown,
        size: tuple[int, int],
        codec: Codec | None,
        seen: Accumulation,
    ):
        layout = layout_of(codec) if codec else LAYOUTS["fp32"]
        plan = Plan(size, 1, layout, LIGHT_BUFFERS["rgba32f"], 1, False, 1.0, antialiased=False)
        self.made: list[Rendering] = []
        self._what = what
        for frame, view in enumerate(views(what.view, size, seen.frames)):
            if codec and seen.dither != NONE:
                plan = replace(plan, dither=codec.dither(frame if seen.dither == MOVING else 0))
            # Each picture has a roughness of its own.
            scene = replace(what, view=view).scene(0.0)
            self.made.append(stack.enter_context(rendering(device, PIPELINES[PIPELINE], scene, plan)))
            self.made[-1].draw()
        self._covered = [rendered.gbuffer()[0][..., 2] != 0 for rendered in self.made]
        self.covered = np.any(self._covered, axis=0)

    def light(self, roughness: float) -> np.ndarray:
        """Return the mean of all frames at a roughness: linear light, float64 of shape (height, width, 3), black
        outside the object."""
        total = np.zeros((*self.covered.shape, 3))
        for rendered, covered in zip(self.made, self._covered, strict=True):
            if OBJECTS[self._what.name].is_metal:
                draw_again(rendered, roughness)
            else:
                rendered.frame.show(replace(self._what, view=rendered.frame.scene.view).scene(roughness))
                rendered.draw()
            total += np.where(covered[..., None], rendered.image(), 0.0)
        return total / len(self.made)


def layout_of(codec: Codec) -> Layout:
    """Return a layout that stores normals with a codec, in world space if engines use the encoding there, and
    everything else in floats."""
    return replace(LAYOUTS["fp32"], space=engines_space(codec.encoding)).with_codec(codec)


def draw_again(rendered: Rendering, roughness: float) -> None:
    """Draw the image of a metal with another roughness in a fifth of the time, by clearing the one target of the
    G-buffer that changes."""
    number = next(w.target for w in rendered.frame.plan.layout.words if w.component == "power")
    # Reflectance head on, and the roughness, which a metal/rough surface has in place of a power.
    rendered.frame.framebuffer([rendered.frame.textures(GBUFFER)[number]]).clear(*WHITE, roughness)
    rendered.passes[SHADES]()


def views(view: View, size: tuple[int, int], frames: int) -> Sequence[View]:
    """Return the view for each frame: through pixel centres, or for several frames through points spread over the
    pixel.

    Source: J. Halton, On the efficiency of certain quasi-random sequences, 1960; bases 2 and 3.
    """
    if frames == 1:
        return [view]
    places = [(halton(frame, 2) - 0.5, halton(frame, 3) - 0.5) for frame in range(1, frames + 1)]
    return [moved(view, size, x, y) for x, y in places]


def moved(view: View, size: tuple[int, int], x: float, y: float) -> View:
    """Return a view shifted by x pixels to the right and y pixels up, for an image of this size. The camera is
    rotated instead, which at such a small angle agrees to 1e-4 of a pixel."""
    pixel = float(np.degrees(np.arctan(2 * np.tan(np.radians(view.fov) / 2) / size[1])))
    return view.turned("yaw", -x * pixel).turned("pitch", y * pixel)


def halton(index: int, base: int) -> float:
    """Return element `index`, from 1, of the van der Corput sequence in a base: the digits of `index`, mirrored at
    the point, in (0, 1)."""
    fraction, share = 0.0, 1.0
    while index:
        index, digit = divmod(index, base)
        share /= base
        fraction += digit * share
    return fraction
