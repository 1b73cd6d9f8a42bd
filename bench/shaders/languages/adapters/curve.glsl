
float NAME_encode_curve(float x, float range) {
    return NAME_e_main(vec4(x, 0.0, 0.0, 0.0), vec3(range, 0.0, 0.0)).x;
}

float NAME_decode_curve(float e, float range) {
    return NAME_d_main(vec4(e, 0.0, 0.0, 0.0), vec3(range, 0.0, 0.0)).x;
}
