"""Resources that passes share: named textures whose formats and sizes follow from a frame's plan."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from ...encodings.storages.storage import FORMATS, R32F, Storage
from .plan import Plan, scaled

# The two formats that hold depth: one that shaders read, and the one that geometry is tested against.
DEPTH_MAP, DEPTH_STENCIL = "depth map", "depth and stencil"
DEPTH_STENCIL_BYTES = 5
# Whose size and samples a resource follows.
IMAGE, SURFACES = "image", "surfaces"
# Samples: those of what it follows.
AS_MANY = 0

Texel = Storage | str


def _light_texels(plan: Plan) -> tuple[Texel, ...]:
    return (plan.light_buffer.storage.target,) * plan.light_targets


def _next_light_texels(plan: Plan) -> tuple[Texel, ...]:
    return _light_texels(plan) if plan.light_buffer.blend == "read" else ()


def _linear_depth_texels(plan: Plan) -> tuple[Texel, ...]:
    return () if "depth" in plan.layout.components else (R32F,)


# Formats that a plan decides, as the texels of each texture; a resource without any is not there.
PLANNED: Mapping[str, Callable[[Plan], tuple[Texel, ...]]] = MappingProxyType(
    {
        "the layout's": lambda plan: tuple(target.storage for target in plan.layout.targets),
        "the light buffer's": _light_texels,
        "the light buffer's, where it is read": _next_light_texels,
        "linear depth": _linear_depth_texels,
        "shadows": lambda plan: (DEPTH_MAP,) * plan.shadows,
    }
)
KNOWN = (*FORMATS, *PLANNED, DEPTH_MAP, DEPTH_STENCIL)


@dataclass(frozen=True)
class Resource:
    """A texture, or several of the same size, that passes write and read.

    Attributes:
        name: the sampler that reads it; `<name>_before` reads the previous copy.
        format: one of KNOWN.
        scale: size relative to what `follows` names, or a fixed size in pixels.
        follows: what decides its size and samples: the IMAGE, or the G-buffer's SURFACES.
        samples: samples per pixel: 1, or AS_MANY.
        copies: 2 or more if it is read while it is written. The second copy is created at the first request.
        depth: number of slices of a volume; 0 for a two-dimensional texture.
        kept: whether the next frame reads it. Each frame then moves on by one copy, and may read before it writes.
        smooth: whether it is sampled with linear filtering.
        shares: the resource whose textures it reuses if size and samples agree; later passes may not read that
            resource.
    """

    name: str
    format: str
    scale: float | tuple[int, int] = 1.0
    follows: str = IMAGE
    samples: int = 1
    copies: int = 1
    depth: int = 0
    kept: bool = False
    smooth: bool = False
    shares: Resource | None = None

    def texels(self, plan: Plan) -> tuple[Texel, ...]:
        """Return the format of each of the resource's textures: a `Storage`, DEPTH_MAP or DEPTH_STENCIL. Empty if the
        plan leaves the resource out."""
        return PLANNED[self.format](plan) if self.format in PLANNED else (FORMATS.get(self.format, self.format),)

    def shape(self, plan: Plan) -> tuple[int, int, int]:
        """Return the width, the height and the samples per pixel that the resource has in a plan."""
        is_image = self.follows == IMAGE
        size, samples = (plan.size, plan.samples) if is_image else (plan.surface_size, plan.surface_samples)
        own = self.scale if isinstance(self.scale, tuple) else scaled(size, self.scale)
        return *own, samples if self.samples == AS_MANY else self.samples

    def is_shared(self, plan: Plan) -> bool:
        """Whether the resource uses the textures of `shares`, because size and samples are the same in this plan."""
        return self.shares is not None and self.shares.shape(plan) == self.shape(plan)

    def bytes_per_pixel(self, plan: Plan) -> float:
        """Return the bytes per pixel of the image for one copy, or for all copies if `kept`, with all samples; 0 if
        the size is given in pixels or the textures are shared."""
        if isinstance(self.scale, tuple) or self.is_shared(plan):
            return 0.0
        sizes = (sum(t.bits) // 8 if isinstance(t, Storage) else DEPTH_STENCIL_BYTES for t in self.texels(plan))
        part = self.scale if self.follows == IMAGE else self.scale * plan.surface_scale
        return sum(sizes) * (self.copies if self.kept else 1) * self.shape(plan)[2] * part**2

    @property
    def misfit(self) -> str | None:
        """Reason why the resource is invalid, as a predicate ("has the unknown format ..."); None if valid."""
        if self.format not in KNOWN:
            return f"has the unknown format {self.format!r}; known: {', '.join(KNOWN)}"
        if self.depth and (self.samples != 1 or not isinstance(self.scale, tuple)):
            return "is a volume, which has one sample and a size in pixels"
        if self.depth and not _is_plain(FORMATS.get(self.format)):
            return f"is a volume, which cannot have the format {self.format!r}"
        if self.copies < 1 or (self.kept and self.copies < 2):
            return f"has {self.copies} copies; a kept resource needs 2"
        return None


def _is_plain(storage: Storage | None) -> bool:
    """Whether devices support volumes of a format: every channel is unorm8, float16 or float32. False for None."""
    usual = {("unorm", 8), ("float", 16), ("float", 32)}
    return storage is not None and {(storage.kind, bits) for bits in storage.bits} <= usual
