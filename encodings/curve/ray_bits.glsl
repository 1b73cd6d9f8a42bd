// Eight rays, a bit each, beside ray_bits.py.

float ray_bits_encode_curve(float x, float range) {
    // e = (2^k - 1) / 255 of k rays, the nearest to 8 x / range
    float k = floor(min(max(x, 0.0) / range, 1.0) * RAY_BITS_RAYS + 0.5);
    return (exp2(k) - 1.0) * (1.0 / RAY_BITS_BYTE);
}

float ray_bits_decode_curve(float e, float range) {
    // x = log2(1 + 255 e) / 8 range
    float k = floor(log2(1.0 + max(floor(e * RAY_BITS_BYTE + 0.5), 0.0)) + 0.5);
    return k * (1.0 / RAY_BITS_RAYS) * range;
}
