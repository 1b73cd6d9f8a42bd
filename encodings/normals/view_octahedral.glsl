// Octahedral map in the pixel's own frame up to an angle, beside view_octahedral.py.
#include "../shared/view_frame.glsl"

vec2 view_octahedral_encode(vec3 n, vec3 view) {
    vec3 m = n * view_frame(view);
    // s = |m.x| + |m.y|, p = m.xy / max(height s + half m.z, s), e = (p.x + p.y, p.x - p.y)
    float s = abs(m.x) + abs(m.y);
    vec2 p = m.xy * (1.0 / max(max(VIEW_OCTAHEDRAL_HEIGHT * s + VIEW_OCTAHEDRAL_HALF * m.z, s), TINY));
    return vec2(p.x + p.y, p.x - p.y);
}

vec3 view_octahedral_decode(vec2 e, vec3 view) {
    // p = (e.x + e.y, e.x - e.y) / 2, m = (half p, 1 - height (|p.x| + |p.y|))
    vec2 p = vec2(e.x + e.y, e.x - e.y) * 0.5;
    return view_frame(view) * normalize(vec3(VIEW_OCTAHEDRAL_HALF * p, 1.0 - VIEW_OCTAHEDRAL_HEIGHT * (abs(p.x) + abs(p.y))));
}
