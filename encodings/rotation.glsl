// Tangent frames and the quaternions of their rotations, beside rotation.py.
#include "vec.glsl"

// Unit vectors at right angles; the bitangent is hand (normal x tangent).
struct Frame {
    vec3 normal;
    vec3 tangent;
    float hand;
};

// A frame of any numbers: +z and +x where they are no direction, and 1 for a hand that is not below 0.
Frame frame_of(vec3 normal, vec3 tangent, float hand) {
    float length2 = dot(tangent, tangent);
    vec3 kept = length2 > TINY && length2 < 1.0 / TINY ? tangent : vec3(1.0, 0.0, 0.0);
    return Frame(direction_or_forward(normal), kept, sign_not_zero(hand));
}

// The unit quaternion of a frame's rotation, its largest component positive.
vec4 quaternion_of(Frame frame) {
    vec3 n = frame.normal, t = frame.tangent;
    vec3 b = cross(n, t);
    // 4 q_i q for each component i; the one with the largest 4 q_i q_i, which is 1 or more, has no digits to lose
    vec4 x = vec4(1.0 + t.x - b.y - n.z, t.y + b.x, t.z + n.x, b.z - n.y);
    vec4 y = vec4(t.y + b.x, 1.0 - t.x + b.y - n.z, b.z + n.y, n.x - t.z);
    vec4 z = vec4(t.z + n.x, b.z + n.y, 1.0 - t.x - b.y + n.z, t.y - b.x);
    vec4 w = vec4(b.z - n.y, n.x - t.z, t.y - b.x, 1.0 + t.x + b.y + n.z);
    vec4 xy = x.x > y.y ? x : y, zw = z.z > w.w ? z : w;
    vec4 q = max(x.x, y.y) > max(z.z, w.w) ? xy : zw;
    return q * inversesqrt(dot(q, q));
}

// The frame of a unit quaternion's rotation.
Frame rotated_frame(vec4 q, float hand) {
    vec3 t = vec3(1.0 - 2.0 * (q.y * q.y + q.z * q.z), 2.0 * (q.x * q.y + q.z * q.w), 2.0 * (q.x * q.z - q.y * q.w));
    vec3 n = vec3(2.0 * (q.x * q.z + q.y * q.w), 2.0 * (q.y * q.z - q.x * q.w), 1.0 - 2.0 * (q.x * q.x + q.y * q.y));
    return Frame(n, t, hand);
}
