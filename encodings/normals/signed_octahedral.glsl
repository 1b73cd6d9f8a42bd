// Signed octahedron, beside signed_octahedral.py.
#include "../vec.glsl"

vec3 signed_octahedral_encode(vec3 n, vec3 view) {
    // p = n.xy / (|n.x| + |n.y| + |n.z|), e = (p.x + p.y, p.x - p.y, sign n.z)
    vec2 p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)));
    return vec3(p.x + p.y, p.x - p.y, sign_not_zero(n.z));
}

vec3 signed_octahedral_decode(vec3 e, vec3 view) {
    // p = (e.x + e.y, e.x - e.y) / 2, n = (p, sign (1 - |p.x| - |p.y|))
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5;
    return normalize(vec3(p, sign_not_zero(e.z) * (1.0 - abs(p.x) - abs(p.y))));
}
