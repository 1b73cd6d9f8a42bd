// The functions both languages need, beside vec.py. TINY, BRIGHTEST and FLOAT_BIAS come from there.
#include "sign.glsl"

// v at length 1, and the first axis where v is zero.
vec2 unit(vec2 v) { return dot(v, v) > TINY ? v * inversesqrt(dot(v, v)) : vec2(1.0, 0.0); }
vec3 unit(vec3 v) { return dot(v, v) > TINY ? v * inversesqrt(dot(v, v)) : vec3(1.0, 0.0, 0.0); }

// 1 or -1, and 1 for either zero, so that a fold has no seam of zeros.
vec2 sign_not_zero(vec2 v) { return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

float sign_not_zero(float v) { return v < 0.0 ? -1.0 : 1.0; }

// The number in [-1, 1] that stands for a whole number from 0 to levels - 1, and back to the nearest one.
float number_of(float index, int levels) { return index * (2.0 / float(levels - 1)) - 1.0; }
float index_of(float number, int levels) { return floor((number * 0.5 + 0.5) * float(levels - 1) + 0.5); }

// v itself, or (0, 0, 1) where it is not a direction: zero, NaN or infinite.
vec3 direction_or_forward(vec3 v) {
    float length2 = dot(v, v);
    return length2 > TINY && length2 < 1.0 / TINY ? v : vec3(0.0, 0.0, 1.0);
}

// A signed depth, its magnitude at most far; NaN and infinity become far, the sign bit stays.
float depth_or_far(float depth, float far) {
    float magnitude = abs(depth);
    return with_sign_of(magnitude <= far ? magnitude : far, depth);
}

// The floor of the logarithm to base 2, and a whole power of two, both exact.
float floor_log2(float x) { return float(floatBitsToUint(x) >> 23) - float(FLOAT_BIAS); }
float power_of_two(float x) { return intBitsToFloat(int(x) + FLOAT_BIAS << 23); }

// Light itself, 0 where it is negative or NaN, and no more than BRIGHTEST.
vec4 light_or_none(vec4 light) {
    return vec4(light.x > 0.0 ? min(light.x, BRIGHTEST) : 0.0, light.y > 0.0 ? min(light.y, BRIGHTEST) : 0.0,
                light.z > 0.0 ? min(light.z, BRIGHTEST) : 0.0, light.w > 0.0 ? min(light.w, BRIGHTEST) : 0.0);
}
