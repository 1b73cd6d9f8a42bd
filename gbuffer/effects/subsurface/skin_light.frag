#version 430
// Diffuse light of skin before its albedo, and the skin's depth; nothing is drawn elsewhere.
#include "gbuffer.glsl"
#include "material.glsl"
#include "accumulation.glsl"
#if TRANSMITS && SHADOWS
#include "skin_transmittance.glsl"
#endif

layout(location = 0) out vec4 skin_light;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface s = read_gbuffer(pixel);
    if (s.kind != SKIN) discard;
    vec3 light = light_or_none(fetch_light(pixel).first).rgb;
#if TRANSMITS && SHADOWS
    light += transmitted_sunlight(s);
#endif
    skin_light = vec4(light, -s.position.z);
}
