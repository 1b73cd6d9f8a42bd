"""A codec in half arithmetic on the device: its own GLSL with 16-bit types, with an emulated storage in between."""

from __future__ import annotations

from pathlib import Path

import jax.numpy as jnp
import numpy as np

from .....encodings.codecs.codec import Codec
from .....encodings.storages.rounding import store_texel
from .....gbuffer.codecs.codec_passes import encoding_defines
from .compute import computed
from .source import HalfSource

SHADER = Path(__file__).with_name("half.comp")


class HalfPasses:
    """A codec's encoder and decoder in 16-bit types.

    Raises:
        ShaderError: the codec's GLSL cannot be read or lacks one of the two functions.
    """

    def __init__(self, codec: Codec):
        encoding = codec.encoding
        size = encoding.components + encoding.sign_bits
        defines = encoding_defines(encoding, as_half=True)
        defines |= {"HALF_CODE": f"f16vec{size}", "BIASED": int(codec.storage.is_biased), "SHADER_ROUNDS": 0}
        names = {"ENCODING": encoding.glsl}
        self._codec = codec
        self._encode, self._decode = (HalfSource(SHADER, defines | {"ENCODES": side}, names) for side in (1, 0))

    def round_trip(self, n: np.ndarray, views: np.ndarray) -> np.ndarray:
        """Return normals after encode, storage and decode in half arithmetic, float32 of shape (count, 3).

        Args:
            n, views: normals and view-space positions, float32 of shape (count, 4).

        Raises the exceptions of `compute.computed`.
        """
        texels = computed(self._encode, n, views)
        return computed(self._decode, self._stored_texels(texels), views)[:, :3]

    def _stored_texels(self, texels: np.ndarray) -> np.ndarray:
        codec, stored = self._codec, texels.copy()
        for channel in range(codec.encoding.components):
            number = jnp.asarray(texels[:, channel])
            kept = store_texel(number, codec.storage, channel, codec.rounding_of(channel))
            stored[:, channel] = np.asarray(kept)
        return stored
