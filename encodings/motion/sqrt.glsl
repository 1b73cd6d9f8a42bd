// The root of the share of the range, beside sqrt.py.
#include "../vec.glsl"

vec2 sqrt_encode_motion(vec2 motion, float range) {
    // c = sign(v) sqrt(|v| / range)
    vec2 share = abs(motion) / range;
    return sign_not_zero(motion) * vec2(sqrt(share.x), sqrt(share.y));
}

vec2 sqrt_decode_motion(vec2 e, float range) {
    // v = c |c| range
    return e * abs(e) * range;
}
