// The two functions that were translated, each over variables of its own; codes that fill [0, 1] become [-1, 1] here.
CODE NAME_encode(vec3 n, vec3 view) {
    ENCODE_0 = n;
    ENCODE_1 = view;
    ENCODE_main();
#if BIASED
    return ENCODE_out * 2.0 - 1.0;
#else
    return ENCODE_out;
#endif
}

vec3 NAME_decode(CODE e, vec3 view) {
#if BIASED
    DECODE_0 = e * 0.5 + 0.5;
#else
    DECODE_0 = e;
#endif
    DECODE_1 = view;
    DECODE_main();
    return DECODE_out;
}
