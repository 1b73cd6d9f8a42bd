// Equal-area map in the pixel's own frame up to an angle, beside view_equal_area.py.
#include "../elementary.glsl"
#include "../shared/view_frame.glsl"

vec2 view_equal_area_encode(vec3 n, vec3 view) {
    vec3 m = n * view_frame(view);
    // r = min(sqrt((1 - m.z) / height), 1), where 1 - m.z = (m.x^2 + m.y^2) / (1 + m.z)
    float fall = m.z > 0.0 ? (m.x * m.x + m.y * m.y) / (1.0 + abs(m.z)) : 1.0 - m.z;
    float r = min(sqrt(fall * (1.0 / VIEW_EQUAL_AREA_HEIGHT)), 1.0);
    // v = 2 r atan(|m.y| / |m.x|) / pi, p = (r - v, v) sign(m.xy), e = (p.x + p.y, p.x - p.y)
    float v = r * (2.0 * quadrant_pi(abs(m.y), abs(m.x)));
    vec2 p = vec2(r - v, v) * sign_not_zero(m.xy);
    return vec2(p.x + p.y, p.x - p.y);
}

vec3 view_equal_area_decode(vec2 e, vec3 view) {
    // p = (e.x + e.y, e.x - e.y) / 2, r = |p.x| + |p.y|, phi = pi |p.y| / (2 r)
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5;
    float r = abs(p.x) + abs(p.y);
    vec2 sc = sincos_pi(0.5 * (abs(p.y) / max(r, TINY)));
    // m = (r sqrt(height (2 - height r^2)) (cos phi, sin phi) sign(p), 1 - height r^2)
    float fall = VIEW_EQUAL_AREA_HEIGHT * r * r;
    vec2 m = sc.yx * (r * sqrt(max(VIEW_EQUAL_AREA_HEIGHT * (2.0 - fall), 0.0))) * sign_not_zero(p);
    return view_frame(view) * vec3(m, 1.0 - fall);
}
