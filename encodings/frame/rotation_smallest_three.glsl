// Smallest three of a rotation without a handedness, beside rotation_smallest_three.py.
#include "../rotation.glsl"

vec4 rotation_smallest_three_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    vec4 a = abs(q);
    float xy = max(a.x, a.y), zw = max(a.z, a.w);
    // i = the largest component's index; e = (sign(q_i) (the others) sqrt(2), i)
    float i = xy >= zw ? (a.x >= a.y ? 0.0 : 1.0) : (a.z >= a.w ? 2.0 : 3.0);
    vec3 rest = i < 2.0 ? vec3(i == 0.0 ? q.y : q.x, q.z, q.w) : vec3(q.x, q.y, i == 2.0 ? q.w : q.z);
    float largest = i < 2.0 ? (i == 0.0 ? q.x : q.y) : (i == 2.0 ? q.z : q.w);
    return vec4(rest * (sign_not_zero(largest) / ROTATION_SMALLEST_THREE_RANGE), number_of(i, 4));
}

Frame rotation_smallest_three_decode(vec4 e, float least) {
    // q_i = sqrt(1 - |e.xyz|^2 / 2)
    vec3 s = e.xyz * ROTATION_SMALLEST_THREE_RANGE;
    float largest = sqrt(max(1.0 - dot(s, s), 0.0));
    float i = index_of(e.w, 4);
    vec4 first = vec4(i == 0.0 ? largest : s.x, i == 0.0 ? s.x : largest, s.y, s.z);
    vec4 last = vec4(s.x, s.y, i == 2.0 ? largest : s.z, i == 2.0 ? s.z : largest);
    return rotated_frame(i < 2.0 ? first : last, 1.0);
}
