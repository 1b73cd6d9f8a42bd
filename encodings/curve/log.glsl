// The logarithm of one more than the quantity, beside log.py.

float log_encode_curve(float x, float range) {
    // e = log2(1 + x) / log2(1 + range)
    return log2(1.0 + max(x, 0.0)) / log2(1.0 + range);
}

float log_decode_curve(float e, float range) {
    // x = 2^(e log2(1 + range)) - 1
    return exp2(e * log2(1.0 + range)) - 1.0;
}
