// A quaternion's smallest three components, beside smallest_three.py.
#include "../rotation.glsl"

vec4 smallest_three_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    vec4 a = abs(q);
    float xy = max(a.x, a.y), zw = max(a.z, a.w);
    // i = the largest component's index; s = sign(q_i) (the others) sqrt(2)
    float i = xy >= zw ? (a.x >= a.y ? 0.0 : 1.0) : (a.z >= a.w ? 2.0 : 3.0);
    vec3 rest = i < 2.0 ? vec3(i == 0.0 ? q.y : q.x, q.z, q.w) : vec3(q.x, q.y, i == 2.0 ? q.w : q.z);
    float largest = i < 2.0 ? (i == 0.0 ? q.x : q.y) : (i == 2.0 ? q.z : q.w);
    vec3 s = rest * (sign_not_zero(largest) / SMALLEST_THREE_RANGE);
    // e = (s.xy, hand (least + (1 - least) (s.z + 1) / 2), i)
    float magnitude = least + (1.0 - least) * max(s.z * 0.5 + 0.5, 0.0);
    return vec4(s.x, s.y, frame.hand * magnitude, number_of(i, 4));
}

Frame smallest_three_decode(vec4 e, float least) {
    // s.z = 2 (|e.z| - least) / (1 - least) - 1; q_i = sqrt(1 - |s|^2 / 2)
    float third = (abs(e.z) - least) / (1.0 - least) * 2.0 - 1.0;
    vec3 s = vec3(e.x, e.y, third) * SMALLEST_THREE_RANGE;
    float largest = sqrt(max(1.0 - dot(s, s), 0.0));
    float i = index_of(e.w, 4);
    vec4 first = vec4(i == 0.0 ? largest : s.x, i == 0.0 ? s.x : largest, s.y, s.z);
    vec4 last = vec4(s.x, s.y, i == 2.0 ? largest : s.z, i == 2.0 ? s.z : largest);
    return rotated_frame(i < 2.0 ? first : last, sign_not_zero(e.z));
}
