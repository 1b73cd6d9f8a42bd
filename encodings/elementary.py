"""Trigonometry and logarithms that both languages compute the same way.

GLSL guarantees almost no accuracy for `atan` and `sin` (Vulkan's precision table: 4096 units in the last place, and
an absolute error of 2^-11) and little for `log2` (an absolute error of 2^-21). Tables made with these functions would
measure the driver's polynomials, not the encodings. The functions here are near-minimax polynomials with float32
coefficients. Angles are in half turns: an angle of 1 is pi.
The GLSL twin of this file is `elementary.glsl`, which takes the coefficients from here.

float64, which GLSL does not have, represents the exact map: in float64 these functions are as accurate as the type
allows.
"""

from __future__ import annotations

import math

from .vec import TINY, jnp, maximum, minimum, power_of_two, select

# atan(sqrt s) / (pi sqrt s) on [0, 1], relative error below 5e-8; on [0, 1/16] sin(pi sqrt s) / sqrt s, relative error
# below 4e-8, and cos(pi sqrt s), absolute error below 1e-8. Lowest power first.
ATAN_PI = (
    0.31830987334251404,
    -0.10610246658325195,
    0.06363848596811295,
    -0.04521160572767258,
    0.03387114405632019,
    -0.0238869097083807,
    0.013589130714535713,
    -0.005114802625030279,
    0.0009071478270925581,
)
SIN_PI = (3.1415927410125732, -5.167707920074463, 2.5497610569000244, -0.5890122056007385)
COS_PI = (1.0, -4.934802055358887, 4.058707237243652, -1.3350446224212646, 0.23132970929145813)

# The same two as Taylor series, relative error below 1e-16 on [0, 1/16]: float64's.
SIN_PI_64 = tuple((-1) ** k * math.pi ** (2 * k + 1) / math.factorial(2 * k + 1) for k in range(8))
COS_PI_64 = tuple((-1) ** k * math.pi ** (2 * k) / math.factorial(2 * k) for k in range(9))

# log2(m) / s for s = (m - 1) / (m + 1) as a series in s^2 (that of the inverse hyperbolic tangent), relative error
# below 1e-8 for m in [sqrt(1/2), sqrt(2)]; 2^r as a series in r, relative error below 1e-8 on [-1/2, 1/2].
LOG2 = tuple(2 / math.log(2) / (2 * k + 1) for k in range(5))
EXP2 = tuple(math.log(2) ** k / math.factorial(k) for k in range(8))
# The bits of float32 sqrt(1/2): what is counted in whole octaves from there.
SQRT_HALF_BITS = 0x3F3504F3

CONSTANTS = {
    "ATAN_PI": ATAN_PI,
    "SIN_PI": SIN_PI,
    "COS_PI": COS_PI,
    "LOG2": LOG2,
    "EXP2": EXP2,
    "SQRT_HALF_BITS": SQRT_HALF_BITS,
}


def _horner(coefficients, s):
    total = coefficients[-1]
    for coefficient in reversed(coefficients[:-1]):
        total = total * s + coefficient
    return total


def atan_pi(t):
    """Return atan(t) / pi for t in [-1, 1]: float32 to a unit in the last place of 1/4; JAX computes float64."""
    t = jnp.asarray(t)
    return t * _horner(ATAN_PI, t * t) if t.dtype == jnp.float32 else jnp.arctan(t) / math.pi


def quadrant_pi(y, x):
    """Return atan2(y, x) / pi, in [0, 1/2], for non-negative arrays y and x; 0 at the origin."""
    if x.dtype != jnp.float32:
        return select((x == 0.0) & (y == 0.0), 0.0, jnp.arctan2(y, x) / math.pi)
    a = atan_pi(minimum(x, y) / maximum(maximum(x, y), TINY))
    return select(y > x, 0.5 - a, a)


def atan2_pi(y, x):
    """Return atan2(y, x) / pi in [-1, 1], within 2 units in the last place of 1; 0 at the origin."""
    y = jnp.asarray(y)
    # A number in Python has the type of what it goes with.
    x = jnp.asarray(x, y.dtype)
    if x.dtype != jnp.float32:
        a = select((x == 0.0) & (y == 0.0), 0.0, jnp.arctan2(abs(y), x) / math.pi)
        return select(y < 0.0, -a, a)
    a = quadrant_pi(abs(y), abs(x))
    a = select(x < 0.0, 1.0 - a, a)
    return select(y < 0.0, -a, a)


def sincos_pi(a):
    """Return (sin(pi a), cos(pi a)) for a in [-1, 1], within 2 units in the last place of 1."""
    a = jnp.asarray(a)
    is_short = a.dtype == jnp.float32
    quadrant = jnp.floor(2.0 * a + 0.5)
    r = a - 0.5 * quadrant
    s = r * _horner(SIN_PI if is_short else SIN_PI_64, r * r)
    c = _horner(COS_PI if is_short else COS_PI_64, r * r)
    odd = abs(quadrant) == 1.0
    sine, cosine = select(odd, c, s), select(odd, s, c)
    sine = select((quadrant < 0.0) | (quadrant == 2.0), -sine, sine)
    cosine = select((quadrant == 1.0) | (abs(quadrant) == 2.0), -cosine, cosine)
    return sine, cosine


def log2_of(x):
    """Return log2(x) for positive normal x. The float32 result is within 2 units in the last place of the result or,
    near 1, of x - 1. JAX computes float64, which represents the exact map."""
    x = jnp.asarray(x)
    if x.dtype != jnp.float32:
        return jnp.log2(x)
    bits = x.view(jnp.int32)
    octave = (bits - SQRT_HALF_BITS) >> 23
    m = (bits - (octave << 23)).view(jnp.float32)
    s = (m - 1.0) / (m + 1.0)
    return octave.astype(jnp.float32) + s * _horner(LOG2, s * s)


def exp2_of(x):
    """Return 2^x for x in [-126, 127]. Float32 is within 2 units in the last place; JAX computes float64."""
    if x.dtype != jnp.float32:
        return jnp.exp2(x)
    octave = jnp.floor(x + 0.5)
    return power_of_two(octave) * _horner(EXP2, x - octave)
