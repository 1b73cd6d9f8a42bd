// Logarithmic depth, beside logarithmic.py.
#include "../elementary.glsl"

float logarithmic_encode_depth(float depth, float near, float far) {
    // l = log2(d / near) / log2(far / near)
    return log2_of(max(depth, near) / near) / log2_of(far / near);
}

float logarithmic_decode_depth(float number, float near, float far) {
    // d = near 2^(l log2(far / near))
    return near * exp2_of(number * log2_of(far / near));
}
