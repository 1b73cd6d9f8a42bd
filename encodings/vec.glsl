// The functions both languages need, beside vec.py. TINY comes from there.

// v at length 1, and the first axis where v is zero.
vec2 unit(vec2 v) { return dot(v, v) > TINY ? v * inversesqrt(dot(v, v)) : vec2(1.0, 0.0); }
vec3 unit(vec3 v) { return dot(v, v) > TINY ? v * inversesqrt(dot(v, v)) : vec3(1.0, 0.0, 0.0); }

// 1 or -1, and 1 for either zero, so that a fold has no seam of zeros.
vec2 sign_not_zero(vec2 v) { return vec2(v.x < 0.0 ? -1.0 : 1.0, v.y < 0.0 ? -1.0 : 1.0); }

// v itself, or (0, 0, 1) where it is no direction: zero, NaN or infinite.
vec3 direction_or_forward(vec3 v) {
    float length2 = dot(v, v);
    return length2 > TINY && length2 < 1.0 / TINY ? v : vec3(0.0, 0.0, 1.0);
}
