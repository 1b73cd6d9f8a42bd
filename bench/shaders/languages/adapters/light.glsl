
vec4 NAME_encode(vec4 light) {
    return NAME_e_main(light, vec3(0.0));
}

vec4 NAME_decode(vec4 e) {
    return NAME_d_main(e, vec3(0.0));
}
