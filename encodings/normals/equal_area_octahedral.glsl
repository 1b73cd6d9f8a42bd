// Equal-area octahedral map, beside equal_area_octahedral.py.
#include "../elementary.glsl"

vec2 equal_area_octahedral_encode(vec3 n, vec3 view) {
    // r = sqrt(1 - |n.z|) = sqrt((n.x^2 + n.y^2) / (1 + |n.z|))
    float r = sqrt((n.x * n.x + n.y * n.y) / (1.0 + abs(n.z)));
    // v = 2 r atan(|n.y| / |n.x|) / pi, u = r - v; for n.z < 0 (1 - v, 1 - u)
    float v = r * (2.0 * quadrant_pi(abs(n.y), abs(n.x)));
    float u = r - v;
    return (n.z < 0.0 ? vec2(1.0 - v, 1.0 - u) : vec2(u, v)) * sign_not_zero(n.xy);
}

vec3 equal_area_octahedral_decode(vec2 e, vec3 view) {
    vec2 a = abs(e);
    // d = 1 - |e.x| - |e.y|, r = 1 - |d|, phi = pi / 4 ((|e.y| - |e.x|) / r + 1)
    float d = 1.0 - a.x - a.y;
    float r = 1.0 - abs(d);
    vec2 sc = sincos_pi(0.25 * ((a.y - a.x) / max(r, TINY) + 1.0));
    // n = (r sqrt(2 - r^2) (cos phi, sin phi) sign(e), sign(d) (1 - r^2))
    float f = r * sqrt(max(2.0 - r * r, 0.0));
    return vec3(sc.yx * f * sign_not_zero(e), sign_not_zero(d) * (1.0 - r * r));
}
