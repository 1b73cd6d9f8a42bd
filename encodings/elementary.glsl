// Trigonometry in half turns, logarithms and powers of two, beside elementary.py. ATAN_PI, SIN_PI, COS_PI, LOG2, EXP2
// and SQRT_HALF_BITS are its numbers.
#include "vec.glsl"

// atan(t) / pi for t in [-1, 1].
float atan_pi(float t) {
    const float k[] = ATAN_PI;
    float p = k[k.length() - 1];
    for (int i = k.length() - 2; i >= 0; --i) p = p * (t * t) + k[i];
    return t * p;
}

// atan2(y, x) / pi for y and x from 0 on.
float quadrant_pi(float y, float x) {
    float a = atan_pi(min(x, y) / max(max(x, y), TINY));
    return y > x ? 0.5 - a : a;
}

float atan2_pi(float y, float x) {
    float a = quadrant_pi(abs(y), abs(x));
    a = x < 0.0 ? 1.0 - a : a;
    return y < 0.0 ? -a : a;
}

// (sin(pi a), cos(pi a)) for a in [-1, 1].
vec2 sincos_pi(float a) {
    float quadrant = floor(2.0 * a + 0.5);
    float r = a - 0.5 * quadrant;
    const float ks[] = SIN_PI, kc[] = COS_PI;
    float s = ks[ks.length() - 1], c = kc[kc.length() - 1];
    for (int i = ks.length() - 2; i >= 0; --i) s = s * (r * r) + ks[i];
    for (int i = kc.length() - 2; i >= 0; --i) c = c * (r * r) + kc[i];
    s = r * s;
    bool odd = abs(quadrant) == 1.0;
    vec2 sc = odd ? vec2(c, s) : vec2(s, c);
    sc.x = quadrant < 0.0 || quadrant == 2.0 ? -sc.x : sc.x;
    sc.y = quadrant == 1.0 || abs(quadrant) == 2.0 ? -sc.y : sc.y;
    return sc;
}

// log2(x) for positive normal x, octaves counted from the square root of one half.
float log2_of(float x) {
    int bits = floatBitsToInt(x), octave = (bits - SQRT_HALF_BITS) >> 23;
    float m = intBitsToFloat(bits - (octave << 23));
    float s = (m - 1.0) / (m + 1.0);
    const float k[] = LOG2;
    float p = k[k.length() - 1];
    for (int i = k.length() - 2; i >= 0; --i) p = p * (s * s) + k[i];
    return float(octave) + s * p;
}

// 2^x for x in [-126, 127].
float exp2_of(float x) {
    float octave = floor(x + 0.5), r = x - octave;
    const float k[] = EXP2;
    float p = k[k.length() - 1];
    for (int i = k.length() - 2; i >= 0; --i) p = p * r + k[i];
    return power_of_two(octave) * p;
}
