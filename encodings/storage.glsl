// Rounding in the shader, beside storage.py, for a device that does not round as the codec asks.
// STORAGE_KIND is 0 for UNORM, 1 for SNORM, 2 for half, 3 for float; STORAGE_SCALE the integers that stand
// for 1, by channel;
// STORAGE_TRUNCATE is 1 for rounding toward zero; SHADER_ROUNDS is 1 where the shader must round before the write.

float round_half(float x) {
    const float STEP = exp2(24.0);  // below 2^-14 half floats are multiples of 2^-24
    uint bits = floatBitsToUint(x), magnitude = bits & 0x7FFFFFFFu, sign = bits & 0x80000000u;
    if (magnitude >= 0x7F800000u) return x;
#if STORAGE_TRUNCATE
    float small = trunc(x * STEP) / STEP;
    magnitude = min(magnitude & 0xFFFFE000u, 0x477FE000u);  // 65504
#else
    float small = roundEven(x * STEP) / STEP;
    magnitude = (magnitude + 0xFFFu + (magnitude >> 13 & 1u)) & 0xFFFFE000u;
    magnitude = magnitude > 0x477FE000u ? 0x7F800000u : magnitude;
#endif
    return abs(x) < exp2(-14.0) ? small : uintBitsToFloat(sign | magnitude);
}

float round_number(float x, int channel) {
    const float scales[] = STORAGE_SCALE;
    float scale = scales[channel];
#if STORAGE_KIND == 0
    float product = clamp(x, 0.0, 1.0) * scale;
#elif STORAGE_KIND == 1
    float product = clamp(x, -1.0, 1.0) * scale;
#endif
#if STORAGE_KIND >= 2
    return STORAGE_KIND == 2 ? round_half(x) : x;
#elif STORAGE_TRUNCATE
    return trunc(product) / scale;
#else
    return roundEven(product) / scale;
#endif
}

// Numbers in [-1, 1] to what is written to the target, and back from what is read.
vec4 to_texel(vec4 code) {
    vec4 texel = STORAGE_KIND == 0 ? code * 0.5 + 0.5 : code;
#if SHADER_ROUNDS
    for (int i = 0; i < 4; ++i) texel[i] = round_number(texel[i], i);
#endif
    return texel;
}

vec4 from_texel(vec4 texel) { return STORAGE_KIND == 0 ? texel * 2.0 - 1.0 : texel; }
