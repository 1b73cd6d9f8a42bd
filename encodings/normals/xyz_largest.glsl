// The normal over its largest component, beside xyz_largest.py.
#include "../vec.glsl"

vec3 xyz_largest_encode(vec3 n, vec3 view) {
    // e = n / max(|n.x|, |n.y|, |n.z|)
    vec3 a = abs(n);
    return n * (1.0 / max(max(a.x, a.y), a.z));
}

vec3 xyz_largest_decode(vec3 e, vec3 view) {
    // n = e / |e|
    return unit(e);
}
