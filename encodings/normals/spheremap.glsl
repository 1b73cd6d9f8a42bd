// Spheremap transform in its Lambert azimuthal equal-area form, beside spheremap.py.

vec2 spheremap_encode(vec3 n, vec3 view) {
    // f = sqrt(8 n.z + 8), enc = n.xy / f in [-1/2, 1/2]
    float f = sqrt(8.0 * n.z + 8.0);
    return n.z > -1.0 ? n.xy * (2.0 / f) : vec2(1.0, 0.0);
}

vec3 spheremap_decode(vec2 e, vec3 view) {
    // fenc = 2 e, f = fenc . fenc, n.xy = fenc sqrt(1 - f/4), n.z = 1 - f/2
    vec2 fenc = e * 2.0;
    float f = min(dot(fenc, fenc), 4.0);
    float g = sqrt(1.0 - f / 4.0);
    return vec3(fenc * g, 1.0 - f / 2.0);
}
