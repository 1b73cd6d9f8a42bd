// Rounding in the shader, beside rounding.py, for a device that does not round as the codec asks. The kinds of format
// are UNORM 0, SNORM 1, half 2, small floats 3, and 32-bit floats 4, which stay as they are. The ways to round are
// nearest 0, truncate 1, and truncate_half 2.
#include "../sign.glsl"

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

// An unsigned float of `bits` bits, five of them the exponent's: 11 or 10.
float round_small_float(float x, int bits, bool truncates) {
    int cut = 23 - (bits - 5);
    uint word = floatBitsToUint(x), unit_bits = 1u << cut;
    if (x != x || word == 0x7F800000u) return x;
    if (!(x > 0.0)) return 0.0;
    float step = exp2(float(cut - 23 - 14)), most = exp2(16.0) - exp2(float(cut - 23 + 15));
    float small = (truncates ? floor(x / step) : roundEven(x / step)) * step;
    uint half_unit = truncates ? 0u : (unit_bits >> 1) - 1u + (word >> cut & 1u);
    float normal = uintBitsToFloat((word + half_unit) & ~(unit_bits - 1u));
    return min(x < exp2(-14.0) ? small : normal, most);
}

// x in [-1, 1] as a whole number, `scale` standing for 1.
float round_whole(float x, float scale, int rounding) {
    if (rounding == 0) return roundEven(x * scale);
    return clamp(trunc(x * (rounding == 2 ? scale + 0.5 : scale)), -scale, scale);
}

// The two numbers that a fixed-point channel can hold around c, the lower one first.
vec2 numbers_around(float c, float scale, bool is_biased) {
    float below = floor((is_biased ? clamp(c * 0.5 + 0.5, 0.0, 1.0) : clamp(c, -1.0, 1.0)) * scale);
    vec2 texels = vec2(below, min(below + 1.0, scale)) / scale;
    return is_biased ? texels * 2.0 - 1.0 : texels;
}

// A texel's number as a format of this kind keeps it; scale is the integer that stands for 1, bits are the channel's.
float round_number(float x, int kind, float scale, int bits, int rounding) {
    if (kind == 2) return round_half(x, rounding != 0);
    if (kind == 3) return round_small_float(x, bits, rounding != 0);
    if (kind == 4) return x;
    return round_whole(clamp(x, kind == 0 ? 0.0 : -1.0, 1.0), scale, rounding) / scale;
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
// Of one storage: STORAGE_KIND is its kind, STORAGE_BIASED 1 where a number c is kept as c/2 + 1/2; by channel
// STORAGE_SCALE, the integers that stand for 1, and STORAGE_BITS. STORAGE_PACKED is 1 where numbers are integers across
// channels of 8 bits, STORAGE_CENTRED where SNORM's lie in UNORM channels. SHADER_ROUNDS is 1 where the shader must round before the write, by channel as STORAGE_ROUNDING.
const float storage_scale[] = STORAGE_SCALE;
const int storage_bits[] = STORAGE_BITS, storage_rounding[] = STORAGE_ROUNDING;

vec4 round_texel(vec4 texel) {
    for (int i = 0; i < 4; ++i)
        texel[i] = round_number(texel[i], STORAGE_KIND, storage_scale[i], storage_bits[i], storage_rounding[i]);
    return texel;
}

vec4 biased(vec4 code) { return STORAGE_BIASED != 0 ? code * 0.5 + 0.5 : code; }
vec4 unbiased(vec4 texel) { return STORAGE_BIASED != 0 ? texel * 2.0 - 1.0 : texel; }

#if STORAGE_PACKED
const float BYTE_SCALE = exp2(8.0) - 1.0;
// A signed number's integer is `scale` more than itself, so that -1 is 0.
const uint PACKED_ZERO = STORAGE_KIND == 1 ? 1u : 0u;

vec4 to_texel(vec4 code) {
    vec4 numbers = biased(code);
    uvec4 bytes = uvec4(0u);
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        float scale = storage_scale[i], number = clamp(numbers[i], STORAGE_KIND == 0 ? 0.0 : -1.0, 1.0);
        uint integer = uint(int(round_whole(number, scale, storage_rounding[i])) + int(PACKED_ZERO) * int(scale));
        for (int c = 0; c < 4; ++c) bytes[c] |= byte_of(integer, first, storage_bits[i], c);
        first += storage_bits[i];
    }
    return vec4(bytes) / BYTE_SCALE;
}

vec4 from_texel(vec4 texel) {
    uvec4 bytes = uvec4(texel * BYTE_SCALE + 0.5);
    const float steps[] = STORAGE_STEP;
    vec4 numbers = vec4(0.0);
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        uint integer = 0u;
        for (int c = 0; c < 4; ++c) integer |= part_of(bytes[c], first, storage_bits[i], c);
        numbers[i] = float(int(integer) - int(PACKED_ZERO) * int(storage_scale[i])) * steps[i];
        first += storage_bits[i];
    }
    return unbiased(numbers);
}
#elif STORAGE_CENTRED
// The integers of SNORM, `scale` more than themselves: of 2 scale + 1 steps the one in the middle is 0. What is read is a
// whole number of steps, so that 0 comes back as it is.
vec4 to_texel(vec4 code) {
    vec4 texel;
    for (int i = 0; i < 4; ++i) {
        float scale = storage_scale[i], number = clamp(code[i], -1.0, 1.0) * scale;
        texel[i] = ((SHADER_ROUNDS != 0 ? roundEven(number) : number) + scale) / (2.0 * scale + 1.0);
    }
    return texel;
}

vec4 from_texel(vec4 texel) {
    const float steps[] = STORAGE_STEP;
    vec4 code;
    for (int i = 0; i < 4; ++i)
        code[i] = (roundEven(texel[i] * (2.0 * storage_scale[i] + 1.0)) - storage_scale[i]) * steps[i];
    return code;
}
#else
// Numbers in [-1, 1] to what is written to the target, and back from what is read.
vec4 to_texel(vec4 code) { return SHADER_ROUNDS != 0 ? round_texel(biased(code)) : biased(code); }
vec4 from_texel(vec4 texel) { return unbiased(texel); }
#endif
#endif
