// Spheremap transform, n / p form, beside spheremap_classic.py.

vec2 spheremap_classic_encode(vec3 n, vec3 view) {
    // p = sqrt(n.x^2 + n.y^2 + (n.z + 1)^2), enc = n.xy / p
    float p2 = dot(n.xy, n.xy) + (n.z + 1.0) * (n.z + 1.0);
    return p2 > 0.0 ? n.xy / sqrt(p2) : vec2(1.0, 0.0);
}

vec3 spheremap_classic_decode(vec2 e, vec3 view) {
    // with t = (e + 1) / 2: f = t.x - t.x^2 + t.y - t.y^2, m = sqrt(4 f - 1), n.xy = m (4 t - 2), n.z = 8 f - 3
    float f = max((2.0 - dot(e, e)) / 4.0, 0.25);
    float m = sqrt(4.0 * f - 1.0);
    return vec3(m * 2.0 * e, 8.0 * f - 3.0);
}
