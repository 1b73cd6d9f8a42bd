// A wet floor that is nearly flat: long, low ripples, which fade where a pixel covers them.
const vec4 WAVES[6] = vec4[](  // wave numbers over (x, z), phase, slope
    vec4(1.3, 0.9, 0.0, 0.011), vec4(-0.8, 1.7, 1.0, 0.01), vec4(2.9, -1.1, 2.1, 0.008), vec4(1.7, 4.1, 4.0, 0.007),
    vec4(-5.3, 2.3, 0.7, 0.005), vec4(3.1, 7.9, 5.2, 0.004));
const float FAR = 60.0;

Hit met(vec3 ray) {
    float t = -eye.y / ray.y;
    if (ray.y >= 0.0 || t > FAR) {
        return NOTHING;
    }
    vec2 p = eye.xz + t * ray.xz, slopes = vec2(0.0);
    float covers = t * 2.0 * slope.y / float(size.y) / -ray.y;
    for (int i = 0; i < 6; ++i) {
        vec2 k = WAVES[i].xy;
        float share = exp(-0.5 * dot(k, k) * covers * covers);
        slopes += share * WAVES[i].w * cos(dot(k, p) + WAVES[i].z) * normalize(k);
    }
    return Hit(t, vec3(-slopes.x, 1.0, -slopes.y), 4);
}
