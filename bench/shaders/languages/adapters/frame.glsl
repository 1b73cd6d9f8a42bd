
vec4 NAME_encode(Frame frame, float least) {
    return NAME_e_main(vec4(frame.normal, frame.hand), frame.tangent) WAY_OUT;
}

Frame NAME_decode(vec4 e, float least) {
    vec4 n = NAME_d_main(e WAY_BACK, vec3(0.0)), t = NAME_t_main(e WAY_BACK, vec3(0.0));
    vec4 b = NAME_b_main(e WAY_BACK, vec3(0.0));
    return Frame(n.xyz, t.xyz, sign_not_zero(HAND));
}
