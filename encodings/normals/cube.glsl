// Cube map, beside cube.py.
#include "../vec.glsl"

vec3 cube_encode(vec3 n, vec3 view) {
    vec3 a = abs(n);
    // the largest component's axis; the others over it
    bool is_z = a.z >= a.x && a.z >= a.y, is_y = a.y >= a.x;
    vec3 turned = is_z ? n : is_y ? n.zxy : n.yzx;
    float axis = is_z ? 2.0 : is_y ? 1.0 : 0.0;
    float face = 2.0 * axis + (turned.z < 0.0 ? 1.0 : 0.0);
    vec2 uv = turned.xy * (1.0 / abs(turned.z));
    return vec3(uv.x, uv.y, number_of(face, CUBE_FACES));
}

vec3 cube_decode(vec3 e, vec3 view) {
    float face = index_of(e.z, CUBE_FACES);
    float axis = floor(0.5 * face);
    float side = 1.0 - 2.0 * (face - 2.0 * axis);
    vec3 n = normalize(vec3(e.xy, side));
    return axis == 2.0 ? n : axis == 1.0 ? n.yzx : n.zxy;
}
