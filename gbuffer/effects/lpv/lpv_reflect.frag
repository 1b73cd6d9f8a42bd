#version 430
// A reflective shadow map (Dachsbacher and Stamminger 2005): what a light reaches first, in the light's view.
#include "fragment.glsl"
#include "light.glsl"
#include "lpv_places.glsl"

uniform int light;
layout(location = 0) out vec4 flux_texel;
layout(location = 1) out vec4 normal_texel;
layout(location = 2) out vec4 position_texel;

void main() {
    Surface s = shaded_surface();
    Light from = lights[light];
    vec3 n = s.kind == HAIR ? unit(normal) : s.direction, l = -from.direction_outer.xyz, colour = from.colour_kind.rgb;
    if (int(from.colour_kind.w) == SPOT) colour = from_lamp(from, s.position, l);
    // flux = E albedo A: the surface's cosine lies in the area as the light sees it. Colours are E / pi, and so is this.
    vec3 flux = dot(n, l) > 0.0 ? colour * s.albedo * texel_area(s.position) : vec3(0.0);
    flux_texel = vec4(flux, 1.0);
    normal_texel = vec4(n, 1.0);
    position_texel = vec4(s.position, 1.0);
}
