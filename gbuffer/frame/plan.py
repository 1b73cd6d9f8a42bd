"""The plan of a frame."""

from __future__ import annotations

from dataclasses import dataclass

from ...encodings.codecs.light_codec import LightCodec
from ...encodings.storages.dither import Dither
from ..layouts.layout import Layout

# In 32-bit floats (Filament's clamp for them): what lights make of less is narrower than pixels tell.
LEAST_ROUGHNESS = 0.045


@dataclass(frozen=True)
class Plan:
    """The parts and settings of a frame.

    Attributes:
        size: width and height of the final image.
        samples: samples per pixel.
        layout, light_buffer: storage of the G-buffer and of the light.
        light_targets: 1 or 2; see `accumulation.glsl`.
        shadows: whether the sun has a shadow map.
        antialiased: whether normals that vary within a pixel make metallic-roughness surfaces rougher.
        least_roughness: lowest roughness for lights; the environment is reflected down to roughness 0.
        scale: size of the G-buffer and the light buffer relative to the image, for pipelines that allow it.
        apart: whether the G-buffer and the light buffer have that scale, and one sample per pixel; set by the
            pipeline.
        dither: the noise that is added to the normal's code; None for the layout's own noise.
        sampled_from: width and height of the frame that the pixels were sampled from; None if not sampled.
    """

    size: tuple[int, int]
    samples: int
    layout: Layout
    light_buffer: LightCodec
    light_targets: int
    shadows: bool
    scale: float
    apart: bool = False
    antialiased: bool = True
    least_roughness: float = LEAST_ROUGHNESS
    dither: Dither | None = None
    sampled_from: tuple[int, int] | None = None

    @property
    def noise(self) -> Dither | None:
        """Noise that is added to the numbers of the normal's code before rounding; None for no noise."""
        codec = self.layout.codec
        return codec.dither(0) if self.dither is None and codec.is_dithered else self.dither

    @property
    def surface_scale(self) -> float:
        """Size of the G-buffer relative to the image."""
        return self.scale if self.apart else 1.0

    @property
    def surface_size(self) -> tuple[int, int]:
        """Width and height of the G-buffer."""
        return scaled(self.size, self.surface_scale)

    @property
    def surface_samples(self) -> int:
        """Samples per pixel of the G-buffer."""
        return 1 if self.apart else self.samples


def scaled(size: tuple[int, int], scale: float) -> tuple[int, int]:
    """Return a width and height times `scale`, rounded, each at least 1."""
    return max(round(size[0] * scale), 1), max(round(size[1] * scale), 1)
