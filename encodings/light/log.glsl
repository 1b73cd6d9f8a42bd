// Logarithmic light, beside log.py.

vec4 log_encode(vec4 light) {
    // e = 2^-L
    return exp2(-light_or_none(light));
}

vec4 log_decode(vec4 e) {
    // L = -log2(e), e at least 1/255
    return -log2(max(e, vec4(LOG_LEAST)));
}
