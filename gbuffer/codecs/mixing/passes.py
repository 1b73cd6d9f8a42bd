"""Mixing of texels by real hardware: filtering, mip levels, resolving and blending, and decoding of the results."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ....encodings.codecs.codec import Codec
from ....encodings.storages.storage import R32F, STORAGES
from ...defines.materials import CONSTANTS
from ...gl.device import BY_ALPHA, Device, bind, read_pixels
from ...gl.handles import VertexArray
from ...gl.raw import blend_by
from ..codec_passes import Decoded, encoding_defines, rounding_defines
from ..harness import Textures, dithering, set_uniforms, uploaded

# Texels along a side of a patch: two levels of mips.
SIDE = 4
# Where a filter reads: half the size keeps pixels at quarters between its texels.
QUARTERS = (0.25, 0.75)


@dataclass(frozen=True)
class Meetings:
    """Texels to mix for each pixel of a small image: a patch of SIDE x SIDE texels, and how they are mixed.

    Attributes:
        normals: unit normals of the patches side by side, float32 of shape (SIDE height, SIDE width, 4).
        decals: unit normals of a detail drawn over each patch's first texel, (height, width, 4).
        views: one view-space position for all texels of a patch, (height, width, 4).
        shares: how far right and up a filter samples between a patch's first four texels, 0 to 1, (height, width,
            2).
        quarters: the same for upsampling, from QUARTERS, (height, width, 2).
        counts: number of samples with the patch's first normal; the others have its second, (height, width).
        alphas: blend factor of each row of pixels, (height,).
    """

    normals: np.ndarray
    decals: np.ndarray
    views: np.ndarray
    shares: np.ndarray
    quarters: np.ndarray
    counts: np.ndarray
    alphas: np.ndarray

    @property
    def size(self) -> tuple[int, int]:
        """Width and height in patches."""
        height, width, _ = self.views.shape
        return width, height

    @property
    def firsts(self) -> np.ndarray:
        """The first normal of each patch, (height, width, 4)."""
        return self.normals[::SIDE, ::SIDE]

    @property
    def seconds(self) -> np.ndarray:
        """The normal to the right of each patch's first normal, (height, width, 4)."""
        return self.normals[::SIDE, 1::SIDE]

    @property
    def places(self) -> np.ndarray:
        """The positions at which a filter samples, in texture coordinates, (height, width, 2). They are exact if
        width and height are powers of two."""
        width, height = self.size
        x, y = np.meshgrid(np.arange(width), np.arange(height))
        corners = np.stack([x, y], axis=-1) * SIDE + 0.5
        return (corners + self.shares) / (SIDE * width, SIDE * height)


class MixPasses:
    """A codec whose texels are mixed on an OpenGL device; a context manager that releases its resources there.

    Args:
        meetings: the texels to mix.
        samples: number of samples per pixel in a resolve.

    Attributes:
        samples: the number of samples that the device provides.
        meetings: the texels to mix.

    Raises:
        ShaderError: the encoding's GLSL does not compile.
        FormatError: the device cannot render to the storage's format.
    """

    def __init__(self, device: Device, codec: Codec, meetings: Meetings, samples: int):
        encoding, storage = codec.encoding, codec.storage
        channels = [codec.rounding_of(channel) for channel in range(storage.channels)]
        _, rounds = rounding_defines(device, storage, codec.rounding, channels)
        self.samples = device.given_samples(samples)
        self._defines = encoding_defines(encoding) | rounds | dithering(None)[0]
        self._defines |= {"SAMPLES": self.samples, "FILTER_COSINE": CONSTANTS["FILTER_COSINE"]}
        self._names = {"ENCODING": encoding.glsl}
        self._device, self.meetings, self._size = device, meetings, meetings.size
        self._formats = {"": storage.target} | ({"signed_": R32F} if encoding.sign_bits else {})
        with ExitStack() as stack:
            self._tables = uploaded(device, stack, encoding.tables())
            self._views = uploaded(device, stack, {"views": meetings.views})
            self._passes: dict[str, VertexArray] = {}
            self._stack = stack
            self._texels = self._encoded_textures(
                meetings.normals, np.repeat(np.repeat(meetings.views, SIDE, 0), SIDE, 1)
            )
            self._stack = stack.pop_all()

    def __enter__(self):
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def _pass_array(self, shader: str) -> VertexArray:
        """Return the full-screen pass of a fragment shader, which is compiled at the first call and kept."""
        if shader not in self._passes:
            vertex_array = self._device.fragment_pass(shader, self._defines, self._names)
            self._passes[shader] = self._device.owned(self._stack, vertex_array)
        return self._passes[shader]

    def _targets(self, size: tuple[int, int], depths: str, texels: str, samples: int = 1) -> Textures:
        """Return a code's targets by their names in shaders: `texels`, and with sign bits also `depths`."""
        device = self._device
        targets = {
            depths if name else texels: device.target(size, form, samples) for name, form in self._formats.items()
        }
        return {name: device.owned(self._stack, texture) for name, texture in targets.items()}

    def _encoded_textures(self, normals: np.ndarray, views: np.ndarray) -> Textures:
        height, width, _ = normals.shape
        targets = self._targets((width, height), "signed_depths", "texels")
        with self._given_textures(normals=normals, views=views) as given:
            self._device.render(self._pass_array("encode.frag"), list(targets.values()), **given, **self._tables)
        return targets

    @contextmanager
    def _given_textures(self, **arrays: np.ndarray) -> Iterator[Textures]:
        """Yield arrays as textures with the same names, and release them at the end."""
        with ExitStack() as stack:
            yield uploaded(self._device, stack, arrays)

    def _decoded_pass(self, shader: str, size: tuple[int, int], given: Textures, **uniforms: int) -> Decoded:
        """Return the normals that a pass decodes, (height, width, 3), and the numbers that it decodes them from."""
        device, passed = self._device, self._pass_array(shader)
        set_uniforms(passed.program, {"level": 0, **uniforms})
        with ExitStack() as stack:
            targets = [device.owned(stack, device.target(size, STORAGES["rgba32f"])) for _ in range(2)]
            device.render(passed, targets, **{**self._views, **given}, **self._tables)
            normals, numbers = (read_pixels(texture) for texture in targets)
        return Decoded(normals[..., :3], numbers)

    def texels(self) -> Decoded:
        """Return all texels of the patches, decoded but not mixed; arrays of shape (SIDE height, SIDE width, ...)."""
        width, height = self._size
        views = np.repeat(np.repeat(self.meetings.views, SIDE, 0), SIDE, 1)
        with self._given_textures(views=views) as given:
            return self._decoded_pass(
                "mix_texel.frag", (SIDE * width, SIDE * height), {**self._texels, **given}, stride=1
            )

    def filtered(self) -> Decoded:
        """Return each patch's normal, and the numbers that it is decoded from: its first 2 x 2 texels as the
        sampler's bilinear filter mixes them."""
        for texture in self._texels.values():
            self._device.smooth(texture)
        with self._given_textures(places=self.meetings.places.astype(np.float32)) as given:
            return self._decoded_pass("mix_filter.frag", self._size, {**self._texels, **given})

    def mip(self, level: int) -> Decoded:
        """Return each patch's normal, and the numbers that it is decoded from: the patch's first texel in a mip level
        that the device generated. Level 1 averages 2 x 2 texels, level 2 averages 4 x 4."""
        for texture in self._texels.values():
            self._device.build_mips(texture)
        return self._decoded_pass("mix_texel.frag", self._size, self._texels, stride=SIDE >> level, level=level)

    def _sampled(self) -> Textures:
        """Return the samples of each pixel, encoded from each patch's first two normals, as textures by their names
        in shaders."""
        textures = self._targets(self._size, "signed_samples", "samples", self.samples)
        counts = self.meetings.counts[..., None].astype(np.float32)
        with self._given_textures(normals=self.meetings.firsts, others=self.meetings.seconds, counts=counts) as given:
            targets, passed = list(textures.values()), self._pass_array("mix_samples.frag")
            self._device.render(passed, targets, **given, **self._views, **self._tables)
        return textures

    def resolved(self) -> Decoded:
        """Return each patch's normal, and the numbers that it is decoded from: the device's average of the codes in a
        pixel's samples, which hold the patch's first two normals."""
        sampled, pixels = self._sampled(), self._targets(self._size, "signed_depths", "texels")
        for source, target in zip(sampled.values(), pixels.values(), strict=True):
            self._device.resolve(source, target)
        return self._decoded_pass("mix_texel.frag", self._size, pixels, stride=1)

    def resolved_decoded(self) -> Decoded:
        """Return each patch's normal as the mean of the samples of `resolved`, each decoded first; no numbers."""
        return self._decoded_pass("mix_resolve.frag", self._size, self._sampled())

    def blended(self, decals: np.ndarray) -> Decoded:
        """Return each patch's normal, and the numbers that it is decoded from: the code of the patch's first normal
        after the device has blended `decals`, normals of shape (height, width, 4), over it."""
        targets = self._encoded_textures(self.meetings.firsts, self.meetings.views)
        passed, device = self._pass_array("encode.frag"), self._device
        framebuffer = device.owned(self._stack, device.framebuffer(list(targets.values())))
        with self._given_textures(normals=decals) as given:
            device.blend(BY_ALPHA)
            framebuffer.use()
            bind(passed.program, {**given, **self._views, **self._tables})
            for alpha, start, rows in bands(self.meetings.alphas):
                blend_by(alpha)
                framebuffer.viewport = (0, start, self._size[0], rows)
                passed.render(vertices=3)
        device.idle.use()
        return self._decoded_pass("mix_texel.frag", self._size, targets, stride=1)

    def blended_decoded(self) -> Decoded:
        """Return each patch's normal, and the numbers that it is decoded from: the code that a shader stores after it
        has decoded the patch's first two normals and blended the second over the first."""
        pair = (self.meetings.firsts, self.meetings.seconds)
        base, over = (self._encoded_textures(normals, self.meetings.views) for normals in pair)
        over = {name.replace("texels", "decals").replace("depths", "decals"): t for name, t in over.items()}
        targets = self._targets(self._size, "signed_depths", "texels")
        alphas = np.repeat(self.meetings.alphas[:, None, None], self._size[0], 1).astype(np.float32)
        with self._given_textures(alphas=alphas) as given:
            textures = {**base, **over, **given, **self._views, **self._tables}
            self._device.render(self._pass_array("mix_blend.frag"), list(targets.values()), **textures)
        return self._decoded_pass("mix_texel.frag", self._size, targets, stride=1)

    def upsampled(self) -> Decoded:
        """Return each patch's normal from a discontinuity-sensitive filter of its first 2 x 2 texels; no numbers."""
        with self._given_textures(shares=self.meetings.quarters.astype(np.float32)) as given:
            return self._decoded_pass("mix_upsample.frag", self._size, {**self._texels, **given}, stride=SIDE)


def bands(alphas: np.ndarray) -> Iterator[tuple[float, int, int]]:
    """Yield each run of neighbouring rows with the same alpha: the alpha, the first row and the row count."""
    starts = np.flatnonzero(np.diff(alphas, prepend=np.nan))
    for start, end in zip(starts, [*starts[1:], len(alphas)], strict=True):
        yield float(alphas[start]), int(start), int(end - start)


# By operation, how the device does it.
BY_DEVICE: Mapping[str, Callable[[MixPasses], Decoded]] = MappingProxyType(
    {
        "filter": MixPasses.filtered,
        "mip_2x2": lambda passes: passes.mip(1),
        "mip_4x4": lambda passes: passes.mip(2),
        "resolve": MixPasses.resolved,
        "resolve_decoded": MixPasses.resolved_decoded,
        "blend": lambda passes: passes.blended(passes.meetings.seconds),
        "blend_decoded": MixPasses.blended_decoded,
        "detail": lambda passes: passes.blended(passes.meetings.decals),
        "upsample": MixPasses.upsampled,
    }
)
