
vec2 NAME_encode_motion(vec2 motion, float range) {
    return NAME_e_main(vec4(motion, 0.0, 0.0), vec3(range, 0.0, 0.0)).xy WAY_OUT;
}

vec2 NAME_decode_motion(vec2 e, float range) {
    return NAME_d_main(vec4(e WAY_BACK, 0.0, 0.0), vec3(range, 0.0, 0.0)).xy;
}
