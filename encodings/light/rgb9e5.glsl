// RGB9E5, beside rgb9e5.py.

vec4 rgb9e5_encode(vec4 light) {
    // c = max(0, min(c, most)), which is 0 for NaN
    vec3 c = min(max(light.xyz, 0.0), vec3(RGB9E5_MOST));
    float largest = max(max(c.x, c.y), c.z);
    // x = max(-B - 1, floor(log2(max c))) + 1 + B, one more where the largest mantissa would round to 2^N
    float x = max(floor_log2(largest), -1.0 - RGB9E5_BIAS) + (1.0 + RGB9E5_BIAS);
    bool full = floor(largest * power_of_two((RGB9E5_BITS + RGB9E5_BIAS) - x) + 0.5) >= power_of_two(RGB9E5_BITS);
    x = full ? x + 1.0 : x;
    // m = floor(c / 2^(x - B - N) + 1/2)
    uvec3 m = uvec3(floor(c * power_of_two((RGB9E5_BITS + RGB9E5_BIAS) - x) + 0.5));
    uint word = m.x | m.y << RGB9E5_BITS | m.z << 2 * RGB9E5_BITS | uint(x) << 3 * RGB9E5_BITS;
    return vec4(uvec4(word, word >> 8, word >> 16, word >> 24) & uint(RGB9E5_STEPS)) * (1.0 / RGB9E5_STEPS);
}

vec4 rgb9e5_decode(vec4 e) {
    uvec4 b = uvec4(e * RGB9E5_STEPS + 0.5);
    uint word = b.x | b.y << 8 | b.z << 16 | b.w << 24, least = (1u << RGB9E5_BITS) - 1u;
    // L = m 2^(x - B - N)
    float x = float(word >> 3 * RGB9E5_BITS);
    uvec3 m = uvec3(word, word >> RGB9E5_BITS, word >> 2 * RGB9E5_BITS) & least;
    return vec4(vec3(m) * power_of_two(x - (RGB9E5_BITS + RGB9E5_BIAS)), 0.0);
}
