// Light over a range, beside linear.py.

vec4 linear_encode(vec4 light) {
    // e = L / range
    return light * (1.0 / LINEAR_RANGE);
}

vec4 linear_decode(vec4 e) {
    // L = e range
    return e * LINEAR_RANGE;
}
