CODE NAME_encode(vec3 n, vec3 view) {
#if BIASED
    // the code fills [0, 1]
    return ENCODE_main(n, view) * 2.0 - 1.0;
#else
    return ENCODE_main(n, view);
#endif
}

vec3 NAME_decode(CODE e, vec3 view) {
#if BIASED
    return DECODE_main(e * 0.5 + 0.5, view);
#else
    return DECODE_main(e, view);
#endif
}
