// A quaternion over the sum of its absolute components, beside hexadecachoral.py.
#include "../rotation.glsl"

vec4 hexadecachoral_encode(Frame frame, float least) {
    // p = sign(q.w) q.xyz / (|q.x| + |q.y| + |q.z| + |q.w|)
    vec4 q = quaternion_of(frame);
    vec4 a = abs(q);
    vec3 p = q.xyz * (sign_not_zero(q.w) / (a.x + a.y + a.z + a.w));
    return vec4(p.x, p.y, p.z, frame.hand);
}

Frame hexadecachoral_decode(vec4 e, float least) {
    // q = (p, 1 - |p.x| - |p.y| - |p.z|) at length 1
    vec4 q = vec4(e.x, e.y, e.z, max(1.0 - abs(e.x) - abs(e.y) - abs(e.z), 0.0));
    return rotated_frame(q * inversesqrt(dot(q, q)), sign_not_zero(e.w));
}
