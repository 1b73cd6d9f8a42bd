// Longitude and latitude, beside latitude_longitude.py.
#include "../elementary.glsl"

vec2 latitude_longitude_encode(vec3 n, vec3 view) {
    // acos(n.z) = atan2(sqrt(n.x^2 + n.y^2), n.z)
    float polar = atan2_pi(sqrt(n.x * n.x + n.y * n.y), n.z);
    return vec2(atan2_pi(n.y, n.x), 2.0 * polar - 1.0);
}

vec3 latitude_longitude_decode(vec2 e, vec3 view) {
    // n = (sin theta (cos phi, sin phi), cos theta)
    vec2 around = sincos_pi(e.x), polar = sincos_pi(0.5 * e.y + 0.5);
    return vec3(around.yx * polar.x, polar.y);
}
