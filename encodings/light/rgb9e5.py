"""RGB9E5: three 9-bit mantissas with a shared 5-bit exponent, as the four bytes of an RGBA8 texel.

The format itself is rarely renderable; the four channels hold the same 32 bits. Codes do not add.
"""

from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import Vec3, Vec4, floor, floor_log2, jnp, maximum, minimum, power_of_two, select

BITS, BIAS = 9, 15
MOST = 65408.0  # (2^9 - 1) / 2^9 * 2^16
STEPS = 255.0


def encode(light: Vec4) -> Vec4:
    """Map light to four bytes in [0, 1]; negative light and NaN are treated as 0, light above 65408 as 65408."""
    # c = max(0, min(c, most)), which is 0 for NaN
    c = Vec3(*(minimum(maximum(channel, 0.0), MOST) for channel in light.xyz))
    largest = maximum(maximum(c.x, c.y), c.z)
    # x = max(-B - 1, floor(log2(max c))) + 1 + B, one more where the largest mantissa would round to 2^N
    x = maximum(floor_log2(largest), -1.0 - BIAS) + (1.0 + BIAS)
    full = floor(largest * power_of_two((BITS + BIAS) - x) + 0.5) >= 2.0**BITS
    x = select(full, x + 1.0, x)
    # m = floor(c / 2^(x - B - N) + 1/2)
    r, g, b = (floor(channel * power_of_two((BITS + BIAS) - x) + 0.5).astype(jnp.uint32) for channel in c)
    word = r | g << BITS | b << 2 * BITS | x.astype(jnp.uint32) << 3 * BITS
    return Vec4(*((word >> 8 * i & 0xFF).astype(jnp.float32) * (1.0 / STEPS) for i in range(4)))


def decode(e: Vec4) -> Vec4:
    """Return a texel's light; the fourth number is 0."""
    r, g, b, a = ((c * STEPS + 0.5).astype(jnp.uint32) for c in e)
    word = r | g << 8 | b << 16 | a << 24
    # L = m 2^(x - B - N)
    x = (word >> 3 * BITS).astype(jnp.float32)
    m = Vec3(*((word >> BITS * i & 2**BITS - 1).astype(jnp.float32) for i in range(3)))
    c = m * power_of_two(x - (BITS + BIAS))
    return Vec4(c.x, c.y, c.z, c.x * 0.0)


ENCODING = LightEncoding(
    name="rgb9e5",
    title="RGB9E5, packed into RGBA8",
    encode=encode,
    decode=decode,
    storages=("rgba8",),
    blend="read",
    has_alpha=False,
    limit=MOST,
    citation="EXT_texture_shared_exponent; OpenGL 4.6, section 8.25",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(0, 0),
    ulps_reason="whole numbers and powers of two",
    constants={"RGB9E5_BITS": BITS, "RGB9E5_BIAS": BIAS, "RGB9E5_MOST": MOST, "RGB9E5_STEPS": STEPS},
)
