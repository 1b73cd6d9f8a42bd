// Mirrored rays of a rough surface, as dense as what GGX's visible facets reflect (Dupuy and Benyoub, Sampling Visible GGX
// Normals with Spherical Caps, 2023). tests/gbuffer/test_ssr.py has another way to draw them.
#include "vec.glsl"

// Two axes at right angles to n and to each other, which turn evenly with n (Frisvad 2012): n may not be -z, which no surface
// shows to the eye.
mat3 axes_around(vec3 n) {
    float a = 1.0 / max(1.0 + n.z, TINY), b = -n.x * n.y * a;
    return mat3(vec3(1.0 - n.x * n.x * a, b, -n.x), vec3(b, 1.0 - n.y * n.y * a, -n.y), n);
}

// The normal of a facet that v sees, by two numbers in [0, 1); n itself where a, the roughness squared, is 0. z is along n.
vec3 visible_facet(vec3 v, float a, vec2 u) {
    vec3 stretched = unit(vec3(a * v.xy, v.z));
    float turn = 2.0 * PI * u.x, z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    vec3 cap = vec3(sqrt(clamp(1.0 - z * z, 0.0, 1.0)) * vec2(cos(turn), sin(turn)), z), facet = cap + stretched;
    return unit(vec3(a * facet.xy, max(facet.z, TINY)));
}

// The share of such a ray's light that no other facet takes, G2 / G1 of height-correlated Smith:
// n.l (n.v + Sv) / (n.v Sl + n.l Sv), with S = sqrt(a^2 + (1 - a^2) (n.x)^2)
float unmasked(float n_l, float n_v, float a) {
    if (n_l <= 0.0 || n_v <= 0.0) return 0.0;
    float rest = 1.0 - a * a, s_l = sqrt(a * a + rest * n_l * n_l), s_v = sqrt(a * a + rest * n_v * n_v);
    return n_l * (n_v + s_v) / (n_v * s_l + n_l * s_v);
}
