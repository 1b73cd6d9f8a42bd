#version 430
// The bounds of a light: a ball around a point light or a wide spot, a cone around a spot, both a little too large.
#include "frame.glsl"
#include "light.glsl"

in vec3 in_position;
uniform int light;

void main() {
    Light l = lights[light];
    vec3 p = in_position;
    if (int(l.colour_kind.w) == SPOT && l.direction_outer.w > CONE_COSINE) {
        // A unit cone along +z: its tip at the light, its rim where the outer angle meets the radius.
        vec3 z = l.direction_outer.xyz, x = normalize(abs(z.x) < 0.5 ? cross(z, vec3(1, 0, 0)) : cross(z, vec3(0, 1, 0)));
        float c = l.direction_outer.w, widest = sqrt(1.0 - c * c) / c;
        p = mat3(x, cross(z, x), z) * (p * vec3(widest, widest, 1.0));
    }
    gl_Position = projection * vec4(l.position_radius.xyz + p * l.position_radius.w, 1.0);
}
