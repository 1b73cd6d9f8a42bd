CODE NAME_encode(vec3 n, vec3 view) {
    return ENCODED;
}

vec3 NAME_decode(CODE e, vec3 view) {
    return DECODED;
}
