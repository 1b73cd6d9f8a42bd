// CryEngine 3's form of the spheremap transform, +z exact, beside cryengine3.py.
#include "../vec.glsl"

vec2 cryengine3_encode(vec3 n, vec3 view) {
    // enc = normalize(n.xy) sqrt(-n.z/2 + 1/2)
    return unit(n.xy) * sqrt(max(0.5 - n.z * 0.5, 0.0));
}

vec3 cryengine3_decode(vec2 e, vec3 view) {
    // l = (e, 1) . -(e, -1), n.xy = 2 e sqrt(l), n.z = 2 l - 1
    float l = max(1.0 - dot(e, e), 0.0);
    return vec3(e * (2.0 * sqrt(l)), 2.0 * l - 1.0);
}
