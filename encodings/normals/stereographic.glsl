// Stereographic projection from -z, beside stereographic.py.

vec2 stereographic_encode(vec3 n, vec3 view) {
    // enc = n.xy / (n.z + 1) / scale
    return n.z > -1.0 ? n.xy / ((n.z + 1.0) * STEREOGRAPHIC_SCALE) : vec2(1.0, 0.0);
}

vec3 stereographic_decode(vec2 e, vec3 view) {
    // nn = (scale e, 1), g = 2 / (nn . nn), n = (g nn.xy, g - 1)
    vec2 nn = e * STEREOGRAPHIC_SCALE;
    float g = 2.0 / (dot(nn, nn) + 1.0);
    return vec3(g * nn, g - 1.0);
}
