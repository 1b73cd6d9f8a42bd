// Warped cube map, beside warped_cube.py.
#include "../elementary.glsl"

vec3 warped_cube_encode(vec3 n, vec3 view) {
    vec3 a = abs(n);
    // the largest component's axis; the others over it, as angles: 4 atan(u) / pi
    bool is_z = a.z >= a.x && a.z >= a.y, is_y = a.y >= a.x;
    vec3 turned = is_z ? n : is_y ? n.zxy : n.yzx;
    float axis = is_z ? 2.0 : is_y ? 1.0 : 0.0;
    float face = 2.0 * axis + (turned.z < 0.0 ? 1.0 : 0.0);
    vec2 uv = turned.xy * (1.0 / abs(turned.z));
    return vec3(4.0 * atan_pi(uv.x), 4.0 * atan_pi(uv.y), number_of(face, WARPED_CUBE_FACES));
}

vec3 warped_cube_decode(vec3 e, vec3 view) {
    float face = index_of(e.z, WARPED_CUBE_FACES);
    float axis = floor(0.5 * face);
    float side = 1.0 - 2.0 * (face - 2.0 * axis);
    // (tan(pi e.x / 4), tan(pi e.y / 4), side), at unit length
    vec2 u = sincos_pi(0.25 * e.x), v = sincos_pi(0.25 * e.y);
    vec3 n = normalize(vec3(u.x * v.y, v.x * u.y, side * u.y * v.y));
    return axis == 2.0 ? n : axis == 1.0 ? n.yzx : n.zxy;
}
