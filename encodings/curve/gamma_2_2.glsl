// A power of the share of the range, beside gamma_2_2.py.

float gamma_2_2_encode_curve(float x, float range) {
    // e = (x / range)^(1 / gamma)
    return pow(max(x, 0.0) / range, 1.0 / GAMMA_2_2);
}

float gamma_2_2_decode_curve(float e, float range) {
    // x = e^gamma range
    return pow(e, GAMMA_2_2) * range;
}
