// X, Y and the sign of Z, beside xy_sign.py.

vec3 xy_sign_encode(vec3 n, vec3 view) { return vec3(n.xy, n.z < 0.0 ? -1.0 : 1.0); }

vec3 xy_sign_decode(vec3 e, vec3 view) {
    // n.z = sign sqrt(1 - e . e)
    return vec3(e.xy, e.z * sqrt(max(1.0 - dot(e.xy, e.xy), 0.0)));
}
