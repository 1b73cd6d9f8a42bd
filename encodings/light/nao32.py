"""NAO32: the logarithm of the luminance in 16 bits, and two chromaticities in 8 bits each (LogLuv in RGBA8).

Le counts half stops from 2^-63.5 up: the third channel holds its integer part, the fourth its fraction. Codes do not
add.
"""

from pathlib import Path

from ..codecs.light_encoding import LightEncoding
from ..vec import TINY, Vec3, Vec4, exp2, floor, light_or_none, log2, maximum, minimum, select

# Rows are what red, green and blue contribute to (X', Y, XYZ'); the second matrix is the inverse, to float32's digits
# where the published one has four: a light that is read and written 256 times would drift by those.
MATRIX = (0.2209, 0.3390, 0.4184, 0.1138, 0.6780, 0.7319, 0.0102, 0.1130, 0.2969)
INVERSE = (
    *(6.001365418, -2.700757396, -1.799551879),
    *(-1.332003696, 3.102943281, -5.772091079),
    *(0.30078306, -1.088194225, 5.626816171),
)
STEPS = 255.0
BIAS = 127.0


def _product(v: Vec3, m: tuple[float, ...]) -> Vec3:
    return Vec3(*(v.x * m[i] + v.y * m[3 + i] + v.z * m[6 + i] for i in range(3)))


def encode(light: Vec4) -> Vec4:
    """Map light to [0, 1]; negative values and NaN are treated as 0, and light below 2^-63.5 is lost."""
    # (X', Y, XYZ') = L M, x = X' / XYZ', y = Y / XYZ'
    p = _product(light_or_none(light).xyz, MATRIX)
    x, y = p.x / maximum(p.z, TINY), p.y / maximum(p.z, TINY)
    # Le = 2 log2 Y + 127, e = (x, y, floor(Le) / 255, Le - floor(Le))
    le = minimum(maximum(2.0 * log2(maximum(p.y, TINY)) + BIAS, 0.0), STEPS)
    return Vec4(x, y, floor(le) * (1.0 / STEPS), le - floor(le))


def decode(e: Vec4) -> Vec4:
    """Return a texel's light; the fourth number is 0."""
    # Y = 2^((Le - 127) / 2), XYZ' = Y / y, X' = x XYZ'; nothing for Le = 0
    le = e.z * STEPS + e.w
    y = select(le > 0.0, exp2((le - BIAS) * 0.5), 0.0)
    xyz = y / maximum(e.y, 1.0 / STEPS)
    # L = max((X', Y, XYZ') M^-1, 0)
    c = _product(Vec3(e.x * xyz, y, xyz), INVERSE)
    return Vec4(maximum(c.x, 0.0), maximum(c.y, 0.0), maximum(c.z, 0.0), c.x * 0.0)


ENCODING = LightEncoding(
    name="nao32",
    title="NAO32: LogLuv in RGBA8",
    encode=encode,
    decode=decode,
    storages=("rgba8",),
    blend="read",
    has_alpha=False,
    limit=2.0 ** ((STEPS - BIAS) / 2.0) / (MATRIX[1] + MATRIX[4] + MATRIX[7]),
    citation="M. Salvi, Heavenly Sword's NAO32; C. Ericson, Converting RGB to LogLuv in a fragment shader, 2007",
    glsl=Path(__file__).with_suffix(".glsl"),
    ulps=(128, 128),
    ulps_reason="Le is 127 for a light of 1, its unit in the last place 22 of the light's; log2 and exp2 have theirs",
    constants={"NAO32_MATRIX": MATRIX, "NAO32_INVERSE": INVERSE, "NAO32_STEPS": STEPS, "NAO32_BIAS": BIAS},
)
