// Modified Rodrigues parameters of a rotation, beside rotation_rodrigues.py.
#include "../rotation.glsl"

vec4 rotation_rodrigues_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    // e = q.xyz / (1 + w)
    return vec4(q.xyz * (sign_not_zero(q.w) / (1.0 + abs(q.w))), 0.0);
}

Frame rotation_rodrigues_decode(vec4 e, float least) {
    // q = (2 e, 1 - |e|^2) / (1 + |e|^2)
    float square = dot(e.xyz, e.xyz);
    float scale = 1.0 / (1.0 + square);
    return rotated_frame(vec4(e.xyz * (2.0 * scale), (1.0 - square) * scale), 1.0);
}
