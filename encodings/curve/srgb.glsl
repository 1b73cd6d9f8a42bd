// The sRGB curve, beside srgb.py.

float srgb_encode_curve(float x, float range) {
    // e = slope s for s = x / range up to the knee, else (1 + offset) s^(1 / power) - offset
    float s = max(x, 0.0) / range;
    float curved = (1.0 + SRGB_OFFSET) * pow(max(s, SRGB_KNEE), 1.0 / SRGB_POWER) - SRGB_OFFSET;
    return s <= SRGB_KNEE ? s * SRGB_SLOPE : curved;
}

float srgb_decode_curve(float e, float range) {
    // x = e / slope range up to the knee, else ((e + offset) / (1 + offset))^power range
    float line = e * (1.0 / SRGB_SLOPE);
    float curved = pow((e + SRGB_OFFSET) / (1.0 + SRGB_OFFSET), SRGB_POWER);
    return (line <= SRGB_KNEE ? line : curved) * range;
}
