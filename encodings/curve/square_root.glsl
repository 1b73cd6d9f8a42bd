// The root of the share of the range, beside square_root.py.

float square_root_encode_curve(float x, float range) {
    // e = sqrt(x / range)
    return sqrt(max(x, 0.0) / range);
}

float square_root_decode_curve(float e, float range) {
    // x = e^2 range
    return e * e * range;
}
