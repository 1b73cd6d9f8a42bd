#version 430
// Geometry under the sun if LIT_BY_SUN is 1, and lamps lit_by.x to lit_by.y - 1; ambient and its own light times `base`.
#include "fragment.glsl"
#include "light.glsl"

uniform ivec2 lit_by;
uniform float base;
layout(location = 0) out vec4 colour;

void main() {
    Surface s = shaded_surface();
    vec3 v = unit(-s.position), diffuse = vec3(0.0), specular = vec3(0.0), l;
#if LIT_BY_SUN
    vec3 sunny = from_sun(s.position, l);
    Terms by_sun = light_terms(s.kind, s.direction, l, v, s.power);
    diffuse += sunny * by_sun.diffuse;
    specular += sunny * by_sun.specular;
#endif
    for (int i = lit_by.x; i < lit_by.y; ++i) {
        vec3 incoming = from_lamp(lights[i], s.position, l);
        Terms t = light_terms(s.kind, s.direction, l, v, s.power);
        diffuse += incoming * t.diffuse;
        specular += incoming * t.specular;
    }
    colour = vec4(base * unlit(s, ambient.rgb) + compose(s, diffuse, specular), s.alpha);
}
