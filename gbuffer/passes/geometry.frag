#version 430
// Geometry and material to the G-buffer. Light that surfaces give off themselves starts the light buffer.
#define WRITES_GBUFFER
#include "fragment.glsl"
#include "gbuffer.glsl"

#if LIGHT_HOLDS != TERMS
#include "light_code.glsl"
layout(location = TARGETS) out vec4 emissive;
#endif

void main() {
    Surface s = shaded_surface();
#if STIPPLE
    // One pixel of four for each transparent layer, the first for what is opaque.
    ivec2 cell = ivec2(gl_FragCoord.xy) & 1;
    if (s.layer != 0 && s.layer != cell.x + 2 * cell.y) discard;
#endif
#if !HAS_KIND
    s.direction = s.kind == HAIR ? unit(normal) : s.direction;
#endif
    write_gbuffer(s);
#if LIGHT_HOLDS != TERMS
    bool is_finished = s.kind == GENERAL || LIGHT_HOLDS != BY_KIND;
    vec3 begins = is_finished && HAS_EMISSION == 0 ? s.emissive : vec3(0.0);
    emissive = LIGHT_ENCODE(light_or_none(vec4(begins, 0.0)));
#endif
}
