// Three components of a quaternion, the fourth positive, beside rotation_xyz.py.
#include "../rotation.glsl"

vec4 rotation_xyz_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    return vec4(q.xyz * sign_not_zero(q.w), 0.0);
}

Frame rotation_xyz_decode(vec4 e, float least) {
    // w = sqrt(1 - |e|^2)
    float square = dot(e.xyz, e.xyz);
    vec3 v = e.xyz * inversesqrt(max(square, 1.0));
    return rotated_frame(vec4(v, sqrt(max(1.0 - square, 0.0))), 1.0);
}
