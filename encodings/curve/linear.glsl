// The share of the range itself, beside linear.py.

float linear_encode_curve(float x, float range) {
    // e = x / range
    return x / range;
}

float linear_decode_curve(float e, float range) {
    // x = e range
    return e * range;
}
