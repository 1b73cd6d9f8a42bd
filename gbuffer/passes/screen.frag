#version 430
// Ambient light everywhere, and the light buffer where it holds finished colour.
#include "gbuffer.glsl"
#include "material.glsl"
#include "accumulation.glsl"
#include "indirect.glsl"

layout(location = 0) out vec4 colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface s = read_gbuffer(pixel);
    bool finished = s.kind == GENERAL || LIGHT_HOLDS != BY_KIND;
    if (!finished) s.emissive = vec3(0.0);
    colour = vec4(unlit_at(s, pixel) + (finished ? fetch_light(pixel).first.rgb : vec3(0.0)), 1.0);
}
