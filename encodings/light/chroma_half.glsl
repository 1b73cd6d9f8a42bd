// Colours over their largest one and that one as a half, beside chroma_half.py.
#include "../storages/storage.glsl"

vec4 chroma_half_encode(vec4 light) {
    vec3 c = min(max(light.xyz, 0.0), vec3(CHROMA_HALF_MOST));
    uint bits = float_bits(max(max(c.x, c.y), c.z), 5, 10, true, false);
    float m = float_value(bits, 5, 10);
    // e = (sqrt(L / m), the bits of m)
    vec3 root = sqrt(min(c * (1.0 / max(m, TINY)), vec3(1.0)));
    return vec4(root, float(bits) * (1.0 / CHROMA_HALF_STEPS));
}

vec4 chroma_half_decode(vec4 e) {
    uint bits = uint(min(e.w * CHROMA_HALF_STEPS + 0.5, CHROMA_HALF_BITS));
    float m = float_value(bits, 5, 10);
    // L = e.rgb^2 m
    return vec4(e.xyz * e.xyz * m, 0.0);
}
