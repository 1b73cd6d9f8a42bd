// RGBM, beside rgbm.py.

vec4 rgbm_encode(vec4 light) {
    // m = ceil(255 max(L) / range - slack) / 255, at least 1/255 and at most 1
    vec3 rgb = light_or_none(light).xyz;
    float largest = max(max(rgb.x, rgb.y), rgb.z);
    float m = min(max(ceil(largest * (RGBM_STEPS / RGBM_RANGE) - RGBM_SLACK), 1.0), RGBM_STEPS) * (1.0 / RGBM_STEPS);
    // e = (L / (m range), m)
    vec3 c = rgb * (1.0 / (m * RGBM_RANGE));
    return vec4(c, m);
}

vec4 rgbm_decode(vec4 e) {
    // L = e.rgb m range
    vec3 c = e.xyz * (e.w * RGBM_RANGE);
    return vec4(c, 0.0);
}
