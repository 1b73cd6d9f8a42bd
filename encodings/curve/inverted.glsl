// What is left of the range, beside inverted.py.

float inverted_encode_curve(float x, float range) {
    // e = 1 - x / range
    return 1.0 - max(x, 0.0) / range;
}

float inverted_decode_curve(float e, float range) {
    // x = (1 - e) range
    return (1.0 - e) * range;
}
