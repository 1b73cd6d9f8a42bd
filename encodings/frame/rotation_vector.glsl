// Axis and angle of a rotation as one vector, beside rotation_vector.py.
#include "../elementary.glsl"
#include "../rotation.glsl"

vec4 rotation_vector_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    vec3 v = q.xyz * sign_not_zero(q.w);
    // e = axis 2 atan2(|v|, w) / pi
    float square = max(dot(v, v), TINY);
    float inverse = inversesqrt(square);
    return vec4(v * (2.0 * quadrant_pi(square * inverse, abs(q.w)) * inverse), 0.0);
}

Frame rotation_vector_decode(vec4 e, float least) {
    // q = (v / |v| sin(pi |v| / 2), cos(pi |v| / 2))
    float square = max(dot(e.xyz, e.xyz), TINY);
    float inverse = inversesqrt(square);
    vec2 turned = sincos_pi(0.5 * min(square * inverse, 1.0));
    return rotated_frame(vec4(e.xyz * (inverse * turned.x), turned.y), 1.0);
}
