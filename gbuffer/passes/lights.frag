#version 430
// One light on what the G-buffer holds: the sun if LIT_BY_SUN is 1, else the lamp of number `light`. LIGHT_HOLDS says
// what for: TERMS is light for a second geometry pass, COLOURS finished colour, BY_KIND the one for special materials and
// the other for general ones.
#define WRITES_LIGHT
#include "gbuffer.glsl"
#include "material.glsl"
#include "light.glsl"
#include "accumulation.glsl"

uniform int light;

void main() {
    Surface s = read_gbuffer(ivec2(gl_FragCoord.xy));
#if LIT_BY_SUN
    vec3 l, colour = from_sun(s.position, l);
#else
    vec3 l, colour = from_lamp(lights[light], s.position, l);
#endif
    vec3 v = unit(-s.position);
    if (LIGHT_HOLDS == COLOURS || (LIGHT_HOLDS == BY_KIND && s.kind == GENERAL)) {
        add_colour(colour * lit(s, l, v));
    } else {
        Terms t = light_terms(s.kind, s.direction, l, v, s.power);
        add_terms(colour * t.diffuse, colour * t.specular);
    }
}
