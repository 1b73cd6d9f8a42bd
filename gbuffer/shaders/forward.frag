#version 430
// Geometry under lights first to last - 1, and under none at all if `base` is 1.
#include "fragment.glsl"
#include "light.glsl"

uniform ivec2 lit_by;
uniform float base;
layout(location = 0) out vec4 colour;

void main() {
    Surface s = shaded_surface();
    vec3 v = unit(-s.position), diffuse = vec3(0.0), specular = vec3(0.0), l;
    for (int i = lit_by.x; i < lit_by.y; ++i) {
        vec3 incoming = arriving(lights[i], s.position, l);
        Terms t = light_terms(s.kind, s.direction, l, v, s.power);
        diffuse += incoming * t.diffuse;
        specular += incoming * t.specular;
    }
    colour = vec4(base * unlit(s) + compose(s, diffuse, specular), s.alpha);
}
