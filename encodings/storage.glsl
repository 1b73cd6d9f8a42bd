// Rounding in the shader, beside storage.py, for a device that does not round as the codec asks. The kinds of format
// are UNORM 0, SNORM 1, half 2, and other floats 3, which the shader leaves to the device.
#include "sign.glsl"

float round_half(float x, bool truncates) {
    const float STEP = exp2(24.0);  // below 2^-14 half floats are multiples of 2^-24
    uint bits = floatBitsToUint(x), magnitude = bits & 0x7FFFFFFFu, sign = bits & 0x80000000u;
    if (magnitude >= 0x7F800000u) return x;
    float small = (truncates ? trunc(x * STEP) : roundEven(x * STEP)) / STEP;
    if (truncates) {
        magnitude = min(magnitude & 0xFFFFE000u, 0x477FE000u);  // 65504
    } else {
        magnitude = (magnitude + 0xFFFu + (magnitude >> 13 & 1u)) & 0xFFFFE000u;
        magnitude = magnitude > 0x477FE000u ? 0x7F800000u : magnitude;
    }
    return abs(x) < exp2(-14.0) ? small : uintBitsToFloat(sign | magnitude);
}

// A texel's number as a format of this kind keeps it; scale is the integer that stands for 1.
float round_number(float x, int kind, float scale, bool truncates) {
    if (kind >= 2) return kind == 2 ? round_half(x, truncates) : x;
    float product = clamp(x, kind == 0 ? 0.0 : -1.0, 1.0) * scale;
    return (truncates ? trunc(product) : roundEven(product)) / scale;
}

// The unsigned integer that stands for c in [0, 1] where `scale` stands for 1. A signed c in [-1, 1] lies in sign and
// magnitude: the upper half of the integers is for the negative ones and for -0.
uint fixed_code(float c, float scale, bool is_signed) {
    float half_scale = floor(scale * 0.5);
    float magnitude = clamp(is_signed ? abs(c) : c, 0.0, 1.0) * (is_signed ? half_scale : scale);
    uint integer = uint(roundEven(magnitude));
    return is_signed && sign_bit(c) ? integer + uint(half_scale) + 1u : integer;
}

// integer / scale for a scale of 2^n - 1, rounded once: i / (2^n - 1) = i 2^-n + i 2^-2n + ... As a quotient a compiler may
// multiply by the rounded reciprocal, which is a whole step off where n is 24.
float share_of(uint integer, float scale) {
    float high = float(integer) * (1.0 / (scale + 1.0));
    return high + high * (1.0 / (scale + 1.0));
}

// The number that an unsigned integer stands for.
float from_fixed_code(uint integer, float scale, bool is_signed) {
    if (!is_signed) return share_of(integer, scale);
    uint half_scale = uint(floor(scale * 0.5));
    bool is_negative = integer > half_scale;
    float magnitude = share_of(is_negative ? integer - half_scale - 1u : integer, float(half_scale));
    return is_negative ? with_sign_of(magnitude, -1.0) : magnitude;
}

// An unsigned integer of `bits` bits laid across a texel's channels of 8, from bit `first` on, the highest bits first:
// the byte of a channel, and a channel's part of the integer.
uint byte_of(uint integer, int first, int bits, int channel) {
    int shift = 8 * (channel + 1) - first - bits;
    if (8 * (channel + 1) <= first || shift >= 8) return 0u;
    return (shift >= 0 ? integer << shift : integer >> -shift) & 0xFFu;
}

uint part_of(uint byte, int first, int bits, int channel) {
    int shift = 8 * (channel + 1) - first - bits;
    if (8 * (channel + 1) <= first || shift >= 8) return 0u;
    return (shift >= 0 ? byte >> shift : byte << -shift) & ((1u << bits) - 1u);
}

#ifdef STORAGE_KIND
// Of one storage: STORAGE_KIND is its kind, STORAGE_SCALE the integers that stand for 1, by channel; STORAGE_TRUNCATE is
// 1 for rounding toward zero, SHADER_ROUNDS is 1 where the shader must round before the write.

vec4 round_texel(vec4 texel) {
    const float scales[] = STORAGE_SCALE;
    for (int i = 0; i < 4; ++i) texel[i] = round_number(texel[i], STORAGE_KIND, scales[i], STORAGE_TRUNCATE != 0);
    return texel;
}

// Numbers in [-1, 1] to what is written to the target, and back from what is read.
vec4 to_texel(vec4 code) {
    vec4 texel = STORAGE_KIND == 0 ? code * 0.5 + 0.5 : code;
    return SHADER_ROUNDS != 0 ? round_texel(texel) : texel;
}

vec4 from_texel(vec4 texel) { return STORAGE_KIND == 0 ? texel * 2.0 - 1.0 : texel; }
#endif
