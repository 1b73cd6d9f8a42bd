// The cube root of the share of the range, beside cube_root.py.
#include "../elementary.glsl"
#include "../vec.glsl"

float cube_root_root(float share) {
    // s^(1/3) = 2^(log2(s) / 3)
    return share >= TINY ? exp2_of(log2_of(max(share, TINY)) * (1.0 / 3.0)) : 0.0;
}

vec2 cube_root_encode_motion(vec2 motion, float range) {
    // c = sign(v) (|v| / range)^(1/3)
    vec2 share = abs(motion) / range;
    return sign_not_zero(motion) * vec2(cube_root_root(share.x), cube_root_root(share.y));
}

vec2 cube_root_decode_motion(vec2 e, float range) {
    // v = c^3 range
    return e * e * e * range;
}
