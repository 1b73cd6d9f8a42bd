// The sRGB curve without its line, and a polynomial back, beside fast_srgb.py.

float fast_srgb_encode_curve(float x, float range) {
    // e = (1 + offset) s^(1 / power) - offset for s = x / range, at least 0
    return max((1.0 + SRGB_OFFSET) * pow(max(x, 0.0) / range, 1.0 / SRGB_POWER) - SRGB_OFFSET, 0.0);
}

float fast_srgb_decode_curve(float e, float range) {
    // x = e (e (e a + b) + c) range
    const float k[] = FAST_SRGB;
    return e * (e * (e * k[0] + k[1]) + k[2]) * range;
}
