// Axis and angle of a frame's rotation, beside axis_angle.py.
#include "../elementary.glsl"
#include "../rotation.glsl"

vec4 axis_angle_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    vec3 v = q.xyz * sign_not_zero(q.w);
    // p = v.xy / (|v.x| + |v.y| + |v.z|), and for v.z < 0 (1 - |p.yx|) sign(p)
    vec2 p = v.xy * (1.0 / max(abs(v.x) + abs(v.y) + abs(v.z), TINY));
    p = v.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
    // a = 2 atan2(|v|, w) / pi
    float square = max(dot(v, v), TINY);
    float a = 2.0 * quadrant_pi(square * inversesqrt(square), abs(q.w));
    return vec4(p, max(a, least) * frame.hand, 0.0);
}

Frame axis_angle_decode(vec4 e, float least) {
    // k = (e, 1 - |e.x| - |e.y|), and for k.z < 0 k.xy - sign(e) (-k.z)
    vec2 xy = vec2(e.x, e.y);
    float z = 1.0 - abs(xy.x) - abs(xy.y);
    vec2 p = xy - sign_not_zero(xy) * max(-z, 0.0);
    vec3 k = normalize(vec3(p, z));
    // q = (k sin(pi a / 2), cos(pi a / 2))
    vec2 turned = sincos_pi(0.5 * min(abs(e.z), 1.0));
    return rotated_frame(vec4(k * turned.x, turned.y), sign_not_zero(e.z));
}
