// A car's bonnet: a broad, gently curved sheet with two ridges, above the ground.
const vec2 HALF = vec2(1.35, 1.5);
const float TOP = 0.8;

// The height over (x, z), and its slopes.
vec3 height(vec2 p) {
    vec2 q = p / HALF, q2 = q * q, q4 = q2 * q2;
    float y = TOP - 0.12 * p.x * p.x - 0.05 * p.y * p.y - 0.16 * dot(q4, q4);
    vec2 dy = vec2(-0.24, -0.1) * p - 1.28 * q4 * q2 * q / HALF;
    for (int i = 0; i < 2; ++i) {
        float side = i == 0 ? 1.0 : -1.0;
        // The ridges run together towards the front.
        float off = (side * p.x - 0.62 + 0.16 * p.y) / 0.24, e = 0.045 * exp(-off * off);
        y += e;
        dy += e * -2.0 * off / 0.24 * vec2(side, 0.16);
    }
    return vec3(y, dy);
}

bool is_sheet(vec2 p) {
    vec2 q = p / HALF, q2 = q * q;
    return dot(q2 * q2 * q2, vec2(1.0)) < 1.0;
}

Hit met(vec3 ray) {
    if (ray.y >= 0.0) {
        return NOTHING;
    }
    // Newton's steps from above the sheet: the way to it is convex but for the ridges.
    float t = max((TOP + 0.05 - eye.y) / ray.y, 0.0), left = 1.0;
    vec3 found = vec3(0.0);
    for (int i = 0; i < 7; ++i) {
        vec3 p = eye + t * ray;
        found = height(clamp(p.xz, -1.2 * HALF, 1.2 * HALF));
        left = p.y - found.x;
        t -= left / min(ray.y - dot(found.yz, ray.xz), -0.02);
    }
    if (abs(left) < 1e-3 && is_sheet((eye + t * ray).xz)) {
        return Hit(t, vec3(-found.y, 1.0, -found.z), 3);
    }
    return Hit(-eye.y / ray.y, vec3(0.0, 1.0, 0.0), 2);
}
