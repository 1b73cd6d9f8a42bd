// The logarithm of 1 and k times the share of the range, beside log.py. MOTION_LOG_OCTAVES is log2(1 + k).
#include "../elementary.glsl"

vec2 log_encode_motion(vec2 motion, float range) {
    // c = sign(v) log2(1 + k |v| / range) / log2(1 + k)
    vec2 x = max(1.0 + abs(motion) / range * MOTION_LOG_K, 1.0);
    return sign_not_zero(motion) * vec2(log2_of(x.x), log2_of(x.y)) / MOTION_LOG_OCTAVES;
}

vec2 log_decode_motion(vec2 e, float range) {
    // v = sign(c) (2^(|c| log2(1 + k)) - 1) range / k
    vec2 x = min(abs(e) * MOTION_LOG_OCTAVES, MOTION_LOG_MOST);
    return sign_not_zero(e) * (vec2(exp2_of(x.x), exp2_of(x.y)) - 1.0) * (range / MOTION_LOG_K);
}
