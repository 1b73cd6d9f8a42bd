// Rounding in the shader, beside rounding.py, for a device that does not round as the codec asks. The kinds of format
// are UNORM 0, SNORM 1, half 2, small floats without a sign 3, and 32-bit floats 4, which stay as they are. The ways to
// round are nearest 0, truncate 1, and truncate_half 2.
#include "../sign.glsl"

float exact_power(int exponent) { return uintBitsToFloat(uint(exponent + 127) << 23); }

// x as a float of so many bits of exponent and mantissa. Without a sign there is nothing below 0, and what is finite
// stays finite; with a sign nearest makes infinite what is too large.
float round_float(float x, int exponent, int mantissa, bool is_signed, bool truncates) {
    int cut = 23 - mantissa, one = (1 << (exponent - 1)) - 1;
    uint word = floatBitsToUint(x), magnitude = word & 0x7FFFFFFFu, unit_bits = 1u << cut;
    if (magnitude > 0x7F800000u || (is_signed && magnitude == 0x7F800000u) || word == 0x7F800000u) return x;
    if (!is_signed && !(x > 0.0)) return 0.0;
    uint half_unit = truncates || cut == 0 ? 0u : (unit_bits >> 1) - 1u + (magnitude >> cut & 1u);
    float kept = uintBitsToFloat((magnitude + half_unit) & ~(unit_bits - 1u));
    // of eight bits of exponent those below the normal ones are float32's own
    if (exponent < 8 && abs(x) < exact_power(1 - one)) {
        float least = exact_power(1 - one - mantissa), steps = abs(x) / least;
        kept = (truncates ? floor(steps) : roundEven(steps)) * least;
    }
    float most = (2.0 - exact_power(-mantissa)) * exact_power(one);
    if (kept > most) kept = is_signed && !truncates ? uintBitsToFloat(0x7F800000u) : most;
    return is_signed && word != magnitude ? -kept : kept;
}

// The bits of a float of so many bits of exponent and mantissa, and back: they count its steps, from 0 on.
uint float_bits(float x, int exponent, int mantissa, bool is_signed, bool truncates) {
    int one = (1 << (exponent - 1)) - 1;
    float kept = round_float(x, exponent, mantissa, is_signed, truncates);
    uint word = floatBitsToUint(kept), magnitude = word & 0x7FFFFFFFu, endless = ((1u << exponent) - 1u) << mantissa;
    uint bits = (magnitude >> (23 - mantissa)) - (uint(127 - one) << mantissa);
    if (exponent < 8 && abs(kept) < exact_power(1 - one)) bits = uint(abs(kept) * exact_power(one - 1 + mantissa));
    // infinite, or no number
    if (magnitude >= 0x7F800000u) bits = magnitude > 0x7F800000u ? endless | 1u << (mantissa - 1) : endless;
    return is_signed && word != magnitude ? bits | 1u << (exponent + mantissa) : bits;
}

float float_value(uint bits, int exponent, int mantissa) {
    int one = (1 << (exponent - 1)) - 1;
    uint magnitude = bits & ((1u << (exponent + mantissa)) - 1u), octave = magnitude >> mantissa;
    float value = uintBitsToFloat((magnitude << (23 - mantissa)) + (uint(127 - one) << 23));
    if (exponent < 8 && octave == 0u) value = float(magnitude) * exact_power(1 - one - mantissa);
    if (octave + 1u == 1u << exponent) value = uintBitsToFloat(0x7F800000u | magnitude << (23 - mantissa));
    return bits != magnitude ? -value : value;
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
    if (kind == 2) return round_float(x, 5, 10, true, rounding != 0);
    if (kind == 3) return round_float(x, 5, bits - 5, false, rounding != 0);
    if (kind == 4) return x;
    return round_whole(clamp(x, kind == 0 ? 0.0 : -1.0, 1.0), scale, rounding) / scale;
}

// The unsigned integer of a magnitude, which is a whole number of steps, under the sign of c: where there is a sign the upper
// half of the integers is for the negative ones and for -0.
uint signed_code(float magnitude, float c, float scale, bool is_signed) {
    uint integer = uint(magnitude);
    return is_signed && sign_bit(c) ? integer + uint(floor(scale * 0.5)) + 1u : integer;
}

// The unsigned integer that stands for c in [0, 1] where `scale` stands for 1. A signed c in [-1, 1] lies in sign and
// magnitude.
uint fixed_code(float c, float scale, bool is_signed) {
    float magnitude = clamp(is_signed ? abs(c) : c, 0.0, 1.0) * (is_signed ? floor(scale * 0.5) : scale);
    return signed_code(roundEven(magnitude), c, scale, is_signed);
}

// integer / scale for a scale of 2^n - 1, rounded once: i / (2^n - 1) = i 2^-n + i 2^-2n + ... As a quotient a compiler may
// multiply by the rounded reciprocal, which is a whole step off where n is 24. A compiler that makes one product of the
// sum is off as well, so it is precise.
float share_of(uint integer, float scale) {
    float high = float(integer) * (1.0 / (scale + 1.0));
    precise float share = high + high * (1.0 / (scale + 1.0));
    return share;
}

// The number that an unsigned integer stands for.
float from_fixed_code(uint integer, float scale, bool is_signed) {
    if (!is_signed) return share_of(integer, scale);
    uint half_scale = uint(floor(scale * 0.5));
    bool is_negative = integer > half_scale;
    float magnitude = share_of(is_negative ? integer - half_scale - 1u : integer, float(half_scale));
    return is_negative ? with_sign_of(magnitude, -1.0) : magnitude;
}

// An unsigned integer of `bits` bits laid across a texel's channels of `size` bits, from bit `first` on, the highest bits
// first: the part of it in a channel, and a channel's part of the integer.
uint part_in(uint integer, int first, int bits, int channel, int size) {
    int shift = size * (channel + 1) - first - bits;
    if (size * (channel + 1) <= first || shift >= size) return 0u;
    return (shift >= 0 ? integer << shift : integer >> -shift) & (~0u >> (32 - size));
}

uint part_from(uint held, int first, int bits, int channel, int size) {
    int shift = size * (channel + 1) - first - bits;
    if (size * (channel + 1) <= first || shift >= size) return 0u;
    return (shift >= 0 ? held >> shift : held << -shift) & (~0u >> (32 - bits));
}

#ifdef STORAGE_KIND
// Of one storage: STORAGE_KIND is its kind, STORAGE_BIASED 1 where a number c is kept as c/2 + 1/2; by channel
// STORAGE_SCALE, the integers that stand for 1, and STORAGE_BITS. STORAGE_PART is the bits of each channel that numbers
// lie across as integers, or 0 where each has a channel; then STORAGE_MOST are the largest integers. STORAGE_FLOATS is 1
// where floats lie there, of STORAGE_EXPONENT bits of exponent, and STORAGE_SIGNED. STORAGE_CENTRED is 1 where SNORM's
// integers lie in UNORM channels. SHADER_ROUNDS is 1 where the shader must round before the write, by channel as
// STORAGE_ROUNDING.
const float storage_scale[] = STORAGE_SCALE;
const int storage_bits[] = STORAGE_BITS;
#ifdef STORAGE_ROUNDS_TWICE
// A pass that stores a texel twice says otherwise of what is stored already.
int storage_rounding[] = STORAGE_ROUNDING;
#else
const int storage_rounding[] = STORAGE_ROUNDING;
#endif

vec4 round_texel(vec4 texel) {
    for (int i = 0; i < 4; ++i)
        texel[i] = round_number(texel[i], STORAGE_KIND, storage_scale[i], storage_bits[i], storage_rounding[i]);
    return texel;
}

vec4 biased(vec4 code) { return STORAGE_BIASED != 0 ? code * 0.5 + 0.5 : code; }
vec4 unbiased(vec4 texel) { return STORAGE_BIASED != 0 ? texel * 2.0 - 1.0 : texel; }

#if STORAGE_PART
const float PART_SCALE = float((1 << STORAGE_PART) - 1);

#if STORAGE_FLOATS
uint integer_of(float number, int i) {
    int mantissa = storage_bits[i] - STORAGE_EXPONENT - STORAGE_SIGNED;
    return float_bits(number, STORAGE_EXPONENT, mantissa, STORAGE_SIGNED != 0, storage_rounding[i] != 0);
}

float number_of(uint integer, int i) {
    return float_value(integer, STORAGE_EXPONENT, storage_bits[i] - STORAGE_EXPONENT - STORAGE_SIGNED);
}
#else
// A signed number's integer is `scale` more than itself, so that -1 is 0.
const uint ZERO = STORAGE_KIND == 1 ? 1u : 0u;

uint integer_of(float number, int i) {
    const float storage_most[] = STORAGE_MOST;
    float scale = storage_scale[i], inside = clamp(number, STORAGE_KIND == 0 ? 0.0 : -1.0, 1.0);
    float whole = min(round_whole(inside, scale, storage_rounding[i]), storage_most[i]);
    return uint(int(whole) + int(ZERO) * int(scale));
}

float number_of(uint integer, int i) {
    const float steps[] = STORAGE_STEP;
    return float(int(integer) - int(ZERO) * int(storage_scale[i])) * steps[i];
}
#endif

// The same numbers in one integer, the first in the lowest bits.
uint to_word(vec4 code) {
    vec4 numbers = biased(code);
    uint word = 0u;
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        word |= integer_of(numbers[i], i) << first;
        first += storage_bits[i];
    }
    return word;
}

vec4 from_word(uint word) {
    vec4 numbers = vec4(0.0);
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        numbers[i] = number_of(word >> first & ~0u >> (32 - storage_bits[i]), i);
        first += storage_bits[i];
    }
    return unbiased(numbers);
}

vec4 to_texel(vec4 code) {
    vec4 numbers = biased(code);
    uvec4 parts = uvec4(0u);
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        uint integer = integer_of(numbers[i], i);
        for (int c = 0; c < 4; ++c) parts[c] |= part_in(integer, first, storage_bits[i], c, STORAGE_PART);
        first += storage_bits[i];
    }
    return vec4(parts) / PART_SCALE;
}

vec4 from_texel(vec4 texel) {
    uvec4 parts = uvec4(texel * PART_SCALE + 0.5);
    vec4 numbers = vec4(0.0);
    int first = 0;
    for (int i = 0; i < STORAGE_CHANNELS; ++i) {
        uint integer = 0u;
        for (int c = 0; c < 4; ++c) integer |= part_from(parts[c], first, storage_bits[i], c, STORAGE_PART);
        numbers[i] = number_of(integer, i);
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
        float scale = storage_scale[i], inside = clamp(code[i], -1.0, 1.0), number = inside * scale;
        float whole = round_whole(inside, scale, storage_rounding[i]);
        texel[i] = ((SHADER_ROUNDS != 0 ? whole : number) + scale) / (2.0 * scale + 1.0);
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
