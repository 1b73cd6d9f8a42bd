// Spherical coordinates (atan2(y, x) / pi, (z - bias) / scale), beside spherical.py.
#include "../elementary.glsl"

vec2 spherical_encode(vec3 n, vec3 view) { return vec2(atan2_pi(n.y, n.x), (n.z - SPHERICAL_BIAS) / SPHERICAL_SCALE); }

vec3 spherical_decode(vec2 e, vec3 view) {
    vec2 sc = sincos_pi(e.x);
    // sin(phi) = sqrt(1 - cos^2(phi)), cos(phi) = scale e.y + bias
    float z = e.y * SPHERICAL_SCALE + SPHERICAL_BIAS;
    float r = sqrt(max(1.0 - z * z, 0.0));
    return vec3(sc.y * r, sc.x * r, z);
}
