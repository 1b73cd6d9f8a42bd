#version 430
// The second geometry pass: materials under the light that was accumulated.
#include "fragment.glsl"
#include "accumulation.glsl"
#if FILTERS
#include "filter.glsl"
#endif

layout(location = 0) out vec4 colour;

void main() {
    Surface s = shaded_surface();
#if FILTERS
    Accumulated a = filtered_light(s);
#else
    Accumulated a = fetch_light(ivec2(gl_FragCoord.xy));
#endif
    vec3 lit = compose(s, a.first.rgb, specular_light(a, s.kind, s.power));
    colour = vec4(LIGHT_HOLDS == BY_KIND ? lit + s.emissive : lit + unlit(s), s.alpha);
}
