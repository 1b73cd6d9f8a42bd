// Light over a range in an sRGB target, beside srgb.py.

vec4 srgb_encode(vec4 light) {
    // e = L / range
    return light * (1.0 / SRGB_RANGE);
}

vec4 srgb_decode(vec4 e) {
    // L = e range
    return e * SRGB_RANGE;
}
