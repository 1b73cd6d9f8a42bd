// The square of the share of the range, beside squared.py.

float squared_encode_curve(float x, float range) {
    // e = (x / range)^2
    float share = max(x, 0.0) / range;
    return share * share;
}

float squared_decode_curve(float e, float range) {
    // x = sqrt(e) range
    return sqrt(e) * range;
}
