// Octahedral normal and the tangent's angle around it, beside octahedral_angle.py.
#include "../elementary.glsl"
#include "../rotation.glsl"

vec2 octahedral_angle_point(vec3 n) {
    // p = n.xy / (|n.x| + |n.y| + |n.z|), and for z < 0 (1 - |p.yx|) sign(p)
    vec2 p = n.xy * (1.0 / (abs(n.x) + abs(n.y) + abs(n.z)));
    return n.z < 0.0 ? (1.0 - abs(p.yx)) * sign_not_zero(p) : p;
}

Frame octahedral_angle_fixed(vec2 p) {
    // n = (p, 1 - |p.x| - |p.y|), and for z < 0 n.xy - sign(p) (-n.z)
    float z = 1.0 - abs(p.x) - abs(p.y);
    vec2 xy = p - sign_not_zero(p) * max(-z, 0.0);
    vec3 n = normalize(vec3(xy.x, xy.y, z));
    // s = 1, and -1 below the seam; t = (1 - s n.x^2 / (s + n.z), -s n.x n.y / (s + n.z), -s n.x)
    float s = z < OCTAHEDRAL_ANGLE_SEAM ? -1.0 : 1.0;
    float a = s * n.x / (s + n.z);
    return Frame(n, vec3(1.0 - n.x * a, -n.y * a, -s * n.x), 1.0);
}

vec4 octahedral_angle_settle(Frame frame, vec4 stored) {
    Frame f = octahedral_angle_fixed(stored.xy);
    // a = atan2(t' . (n x t), t' . t) / pi
    float angle = atan2_pi(dot(frame.tangent, cross(f.normal, f.tangent)), dot(frame.tangent, f.tangent));
    return vec4(stored.x, stored.y, angle, frame.hand);
}

vec4 octahedral_angle_encode(Frame frame, float least) {
    vec2 p = octahedral_angle_point(frame.normal);
    return octahedral_angle_settle(frame, vec4(p.x, p.y, 0.0, 0.0));
}

Frame octahedral_angle_decode(vec4 e, float least) {
    Frame f = octahedral_angle_fixed(e.xy);
    // t' = cos(pi a) t + sin(pi a) (n x t)
    vec2 turned = sincos_pi(e.z);
    return Frame(f.normal, turned.y * f.tangent + turned.x * cross(f.normal, f.tangent), sign_not_zero(e.w));
}
