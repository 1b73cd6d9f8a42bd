// The root of the share of the range, beside sqrt.py.
#include "../vec.glsl"

vec2 sqrt_encode_motion(vec2 motion, float range) {
    // c = sign(v) sqrt(|v| / range)
    vec2 share = abs(motion) / range;
    return sign_not_zero(motion) * vec2(share.x > 0.0 ? sqrt(share.x) : 0.0, share.y > 0.0 ? sqrt(share.y) : 0.0);
}

vec2 sqrt_decode_motion(vec2 e, float range) {
    // v = c |c| range
    return e * abs(e) * range;
}
