// Octahedral map, beside octahedral.py.
#include "../vec.glsl"

vec2 octahedral_encode(vec3 n, vec3 view) {
    // p = n.xy / (|n.x| + |n.y| + |n.z|), and for z < 0 (1 - |p.yx|) sign(p)
    vec2 p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
}

vec3 octahedral_decode(vec2 e, vec3 view) {
    // n = (e, 1 - |e.x| - |e.y|), and for z < 0 n.xy - sign(e) (-n.z)
    float z = 1.0 - abs(e.x) - abs(e.y);
    vec2 p = e - sign_not_zero(e) * max(-z, 0.0);
    return normalize(vec3(p, z));
}
