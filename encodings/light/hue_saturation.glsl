// Hue, saturation and a root, beside hue_saturation.py.

vec4 hue_saturation_encode(vec4 light) {
    vec3 c = light_or_none(light).xyz;
    float v = max(max(c.x, c.y), c.z);
    float d = v - min(min(c.x, c.y), c.z);
    // 6 h = (g - b) / d, 2 + (b - r) / d or 4 + (r - g) / d, by which is the largest; s = d / v
    float part = 1.0 / max(d, TINY);
    float green = c.y >= c.z ? (c.z - c.x) * part + 2.0 : (c.x - c.y) * part + 4.0;
    float red = (c.y - c.z) * part;
    float six = c.x >= max(c.y, c.z) ? (red < 0.0 ? red + 6.0 : red) : green;
    float h = six * (1.0 / 6.0), s = (d / max(v, TINY) * 4.0 - 1.0) * (1.0 / HUE_SATURATION_STEPS);
    // white is h = 1 with the least saturation, and nothing else is
    bool is_taken =
        floor(h * HUE_SATURATION_HUES + 0.5) >= HUE_SATURATION_HUES && floor(s * HUE_SATURATION_STEPS + 0.5) <= 0.0;
    h = is_taken ? 0.0 : h;
    bool is_white = d * 4.0 < v;
    return vec4(is_white ? 1.0 : h, is_white ? 0.0 : max(s, 0.0), sqrt(v * (1.0 / HUE_SATURATION_LIMIT)), 0.0);
}

vec4 hue_saturation_decode(vec4 e) {
    float six = e.x * 6.0, v = e.z * e.z * HUE_SATURATION_LIMIT;
    bool is_white = e.x * HUE_SATURATION_HUES + 0.5 >= HUE_SATURATION_HUES && e.y * HUE_SATURATION_STEPS < 0.5;
    float s = is_white ? 0.0 : (e.y * HUE_SATURATION_STEPS + 1.0) * 0.25;
    // r = |6 h - 3| - 1, g = 2 - |6 h - 2|, b = 2 - |6 h - 4|, each from 0 to 1; L = v (1 - s (1 - rgb))
    vec3 hue = vec3(abs(six - 3.0) - 1.0, 2.0 - abs(six - 2.0), 2.0 - abs(six - 4.0));
    vec3 c = v * (1.0 - s * (1.0 - clamp(hue, 0.0, 1.0)));
    return vec4(c, 0.0);
}
