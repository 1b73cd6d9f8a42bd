
float NAME_encode_depth(float depth, float near, float far) {
    return NAME_e_main(vec4(depth, 0.0, 0.0, 0.0), vec3(near, far, 0.0)).x;
}

float NAME_decode_depth(float number, float near, float far) {
    return NAME_d_main(vec4(number, 0.0, 0.0, 0.0), vec3(near, far, 0.0)).x;
}
