
vec4 NAME_encode(Frame frame, float least) {
    return NAME_e_main(quaternion_of(frame), vec3(frame.hand, 0.0, 0.0)) WAY_OUT;
}

Frame NAME_decode(vec4 e, float least) {
    // A function of quaternions alone gives no hand.
    vec4 q = NAME_d_main(e WAY_BACK, vec3(0.0)), h = NAME_t_main(e WAY_BACK, vec3(0.0));
    return rotated_frame(q * inversesqrt(dot(q, q)), h.x < 0.0 ? -1.0 : 1.0);
}
