// Coefficients of a cell as the volumes keep them: as they are, or packed (lpv_packed.py).
#include "vec.glsl"

#if PACKS
vec4 packed_wave(vec4 c) {
    const float half_levels = float(PACKED_LEVELS / 2);
    float largest = max(max(abs(c.x), abs(c.y)), max(abs(c.z), abs(c.w)));
    // x = clamp(floor(log2(max |c|)) + 1 + B, 0, E - 1)
    float x = clamp(floor_log2(largest) + float(1 + PACKED_BIAS), 0.0, float(PACKED_EXPONENTS - 1));
    // m = floor(c / 2^(x - B) M + 1/2) + M
    vec4 m = clamp(floor(c * power_of_two(float(PACKED_BIAS) - x) * half_levels + 0.5), -half_levels, half_levels);
    uvec4 u = uvec4(m + half_levels);
    uint n = uint(PACKED_LEVELS);
    return unpackUnorm4x8(u.x + n * (u.y + n * (u.z + n * (u.w + n * uint(x)))));
}

vec4 wave_of(vec4 texel) {
    uint word = packUnorm4x8(texel), n = uint(PACKED_LEVELS);
    uvec4 u = uvec4(word, word / n, word / (n * n), word / (n * n * n)) % n;
    // c = (m - M) 2^(x - B) / M
    float x = float(word / (n * n * n * n)), half_levels = float(PACKED_LEVELS / 2);
    return (vec4(u) - half_levels) * (power_of_two(x - float(PACKED_BIAS)) / half_levels);
}
#else
vec4 packed_wave(vec4 c) { return c; }
vec4 wave_of(vec4 texel) { return texel; }
#endif
