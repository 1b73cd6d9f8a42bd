
vec4 NAME_encode_bytes(float number) {
    return NAME_e_main(vec4(number, 0.0, 0.0, 0.0), vec3(0.0));
}

float NAME_decode_bytes(vec4 texel) {
    return NAME_d_main(texel, vec3(0.0)).x;
}
