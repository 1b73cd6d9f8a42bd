// NAO32, beside nao32.py.

vec3 nao32_xyz(vec3 light) {
    const float m[9] = NAO32_MATRIX;
    return light.x * vec3(m[0], m[1], m[2]) + light.y * vec3(m[3], m[4], m[5]) + light.z * vec3(m[6], m[7], m[8]);
}

vec3 nao32_light(vec3 xyz) {
    const float m[9] = NAO32_INVERSE;
    return xyz.x * vec3(m[0], m[1], m[2]) + xyz.y * vec3(m[3], m[4], m[5]) + xyz.z * vec3(m[6], m[7], m[8]);
}

vec4 nao32_encode(vec4 light) {
    // (X', Y, XYZ') = L M, x = X' / XYZ', y = Y / XYZ'
    vec3 p = nao32_xyz(light_or_none(light).xyz);
    vec2 xy = p.xy / max(p.z, TINY);
    // Le = 2 log2 Y + 127, e = (x, y, floor(Le) / 255, Le - floor(Le))
    float le = min(max(2.0 * log2(max(p.y, TINY)) + NAO32_BIAS, 0.0), NAO32_STEPS);
    return vec4(xy, floor(le) * (1.0 / NAO32_STEPS), le - floor(le));
}

vec4 nao32_decode(vec4 e) {
    // Y = 2^((Le - 127) / 2), XYZ' = Y / y, X' = x XYZ'; nothing for Le = 0
    float le = e.z * NAO32_STEPS + e.w;
    float y = le > 0.0 ? exp2((le - NAO32_BIAS) * 0.5) : 0.0;
    float xyz = y / max(e.y, 1.0 / NAO32_STEPS);
    // L = max((X', Y, XYZ') M^-1, 0)
    vec3 c = nao32_light(vec3(e.x * xyz, y, xyz));
    return vec4(max(c, 0.0), 0.0);
}
