"""Colours over their largest channel, as square roots in 8 bits each, and that channel as the bits of a half float.

Five bytes. A 16-bit number holds the bits of the half float as an integer. Codes do not add.
"""

from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..storages.storage import FORMS
from ..vec import TINY, Vec3, Vec4, jnp, maximum, minimum, sqrt

# The largest half, its bits (31 exponents of 1024 halves each, from 0 on), and the largest integer of 16.
MOST, MOST_BITS, STEPS = FORMS[16].largest, 31.0 * 1024.0 - 1.0, 65535.0


def encode(light: Vec4) -> Vec4:
    """Map light to [0, 1]: the square roots of the colour over its largest channel and, in w, the half-float bits of
    that channel. Negative light and NaN are treated as 0, light above 65504 as 65504."""
    c = Vec3(*(minimum(maximum(channel, 0.0), MOST) for channel in light.xyz))
    half = maximum(maximum(c.x, c.y), c.z).astype(jnp.float16)
    bits, m = half.view(jnp.uint16).astype(jnp.float32), half.astype(jnp.float32)
    # e = (sqrt(L / m), the bits of m)
    part = 1.0 / maximum(m, TINY)
    root = Vec3(*(sqrt(minimum(channel * part, 1.0)) for channel in c))
    return Vec4(root.x, root.y, root.z, bits * (1.0 / STEPS))


def decode(e: Vec4) -> Vec4:
    """Return a texel's light; the fourth number is 0. The bits of infinity and NaN are read as the largest half."""
    bits = minimum(e.w * STEPS + 0.5, MOST_BITS)
    m = bits.astype(jnp.uint16).view(jnp.float16).astype(jnp.float32)
    # L = e.rgb^2 m
    c = Vec3(*(root * root * m for root in e.xyz))
    return Vec4(c.x, c.y, c.z, c.x * 0.0)


ENCODING = LightEncoding(
    name="chroma_half",
    title="square roots of colours 8:8:8 and a half float, in five bytes",
    encode=encode,
    decode=decode,
    storages=("rgb16_8_8_8_16",),
    blend="read",
    has_alpha=False,
    limit=MOST,
    citation="NVIDIAGameWorks/dxvk-remix (57425f8), gbuffer_memory_polymorphic_surface_material_interaction.slangh",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(4, 2),
    ulps_reason="a reciprocal, a product and a root; two products",
    constants={"CHROMA_HALF_MOST": MOST, "CHROMA_HALF_BITS": MOST_BITS, "CHROMA_HALF_STEPS": STEPS},
)
