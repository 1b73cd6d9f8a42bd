"""Four signed numbers with a shared exponent in 32 bits, similar to the three unsigned numbers of RGB9E5 (see
lpv_packed.glsl)."""

# A word counts in LEVELS: m_0 + LEVELS (m_1 + LEVELS (m_2 + LEVELS (m_3 + LEVELS x))), with the exponent x on top. Of
# 32 exponents and four mantissas of one size, 107 is the most levels that 32 bits hold: 32 x 107^4 < 2^32 < 32 x 108^4.
EXPONENTS, LEVELS = 32, 107
# The largest of the numbers lies between 2^(x - 1 - BIAS) and 2^(x - BIAS): from 2^-21 to 2^11.
BIAS = 20

PACKED_CONSTANTS = {"PACKED_EXPONENTS": EXPONENTS, "PACKED_LEVELS": LEVELS, "PACKED_BIAS": BIAS}
