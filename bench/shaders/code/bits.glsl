// The bits of finite floats of fewer than 32 bits.
#include "storage.glsl"

// The bits of a half float.
uint half_bits(float x, bool truncates) {
    float rounded = round_float(x, 5, 10, true, truncates);
    uint magnitude = floatBitsToUint(abs(rounded)), sign = floatBitsToUint(x) >> 16 & 0x8000u;
    // from 2^-14 on the exponent is biased by 15 in place of 127; below, the number counts steps of 2^-24
    uint bits = magnitude < 0x38800000u ? uint(abs(rounded) * exp2(24.0)) : (magnitude - 0x38000000u) >> 13;
    // beyond 65504 it is infinite, or no number
    if (magnitude >= 0x47800000u) bits = magnitude > 0x7F800000u ? 0x7E00u : 0x7C00u;
    return sign | bits;
}

float half_value(uint bits) {
    uint magnitude = bits & 0x7FFFu;
    float value = magnitude < 0x400u ? float(magnitude) / exp2(24.0) : uintBitsToFloat((magnitude << 13) + 0x38000000u);
    return (bits & 0x8000u) != 0u ? -value : value;
}

// The bits of an unsigned float of `size` bits, five of them the exponent's: 11 or 10.
uint small_bits(float x, int size, bool truncates) {
    int mantissa = size - 5;
    float rounded = round_float(x, 5, mantissa, false, truncates);
    uint magnitude = floatBitsToUint(rounded);
    // infinite, or no number
    if (magnitude >= 0x47800000u) return (magnitude > 0x7F800000u ? 63u : 62u) << (mantissa - 1);
    uint steps = uint(rounded * exp2(float(14 + mantissa)));
    return magnitude < 0x38800000u ? steps : (magnitude - 0x38000000u) >> (23 - mantissa);
}

float small_value(uint bits, int size) {
    int mantissa = size - 5;
    float value = uintBitsToFloat((bits << (23 - mantissa)) + 0x38000000u);
    return bits < 1u << mantissa ? float(bits) * exp2(float(-14 - mantissa)) : value;
}
