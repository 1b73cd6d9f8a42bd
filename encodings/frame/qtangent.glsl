// A quaternion whose sign is the frame's hand, beside qtangent.py.
#include "../rotation.glsl"

vec4 qtangent_encode(Frame frame, float least) {
    vec4 q = quaternion_of(frame);
    q = q * sign_not_zero(q.w);
    // for w < least: (q.xyz sqrt(1 - least^2), least); e = hand q
    vec3 shrunk = q.xyz * sqrt(1.0 - least * least);
    vec4 biased = vec4(shrunk.x, shrunk.y, shrunk.z, least);
    return (q.w < least ? biased : q) * frame.hand;
}

Frame qtangent_decode(vec4 e, float least) {
    // q = e / |e|
    vec4 q = e * inversesqrt(max(dot(e, e), TINY));
    return rotated_frame(q, sign_not_zero(e.w));
}
