#version 430
// The second geometry pass: materials under the light that was accumulated.
#include "fragment.glsl"
#include "accumulation.glsl"
#include "indirect.glsl"
#if FILTERS
#include "filter.glsl"
#endif

#ifdef HAS_SCATTERED
uniform sampler2D scattered;
#endif
layout(location = 0) out vec4 colour;

void main() {
    Surface s = shaded_surface();
#if FILTERS
    Accumulated a = filtered_light(s);
#else
    Accumulated a = fetch_light(ivec2(gl_FragCoord.xy));
#endif
    vec3 diffuse = a.first.rgb, specular = specular_light(a, s.kind, s.power);
    // The pixel of the G-buffer, which may have a size of its own.
    ivec2 pixel = ivec2(gl_FragCoord.xy / target_size.xy * size.xy);
#ifdef HAS_SCATTERED
    // It comes with a depth. Where it has none the pixel of the G-buffer is another surface's.
    vec4 spread = texelFetch(scattered, pixel, 0);
    if (s.kind == SKIN && spread.w > 0.0) diffuse = spread.rgb;
#endif
    vec3 own = LIGHT_HOLDS == BY_KIND ? s.emissive : unlit_at(s, pixel);
    colour = vec4(compose(s, diffuse, specular) + own, s.alpha);
}
