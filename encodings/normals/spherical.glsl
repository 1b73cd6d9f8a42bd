// Spherical coordinates (atan2(y, x) / pi, z), beside spherical.py.
#include "../elementary.glsl"

vec2 spherical_encode(vec3 n, vec3 view) { return vec2(atan2_pi(n.y, n.x), n.z); }

vec3 spherical_decode(vec2 e, vec3 view) {
    vec2 sc = sincos_pi(e.x);
    // sin(phi) = sqrt(1 - cos^2(phi)), cos(phi) = e.y
    float r = sqrt(max(1.0 - e.y * e.y, 0.0));
    return vec3(sc.y * r, sc.x * r, e.y);
}
