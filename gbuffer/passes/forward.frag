#version 430
// Geometry under the sun if LIT_BY_SUN is 1, and lamps lit_by.x to lit_by.y - 1; ambient and its own light times `base`.
#include "fragment.glsl"
#include "light.glsl"
#include "unlit.glsl"

uniform ivec2 lit_by;
uniform float base;
layout(location = 0) out vec4 colour;

void main() {
    Surface s = shaded_surface();
    vec3 v = unit(-s.position), sum = vec3(0.0), l;
#if LIT_BY_SUN
    vec3 sunny = from_sun(s.position, l);
    sum += sunny * lit(s, l, v);
#endif
    for (int i = lit_by.x; i < lit_by.y; ++i) {
        vec3 incoming = from_lamp(lights[i], s.position, l);
        sum += incoming * lit(s, l, v);
    }
    if (base > 0.0) sum += base * unlit(s, 1.0, vec3(0.0));
    colour = vec4(sum, s.alpha);
}
