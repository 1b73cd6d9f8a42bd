// A motion as a share of the range, beside linear.py.

vec2 linear_encode_motion(vec2 motion, float range) {
    // c = v / range
    return motion / range;
}

vec2 linear_decode_motion(vec2 e, float range) {
    // v = c range
    return e * range;
}
