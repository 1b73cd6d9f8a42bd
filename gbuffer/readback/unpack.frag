#version 430
// What the G-buffer says, in floats, as every pass that reads it understands it.
#include "gbuffer.glsl"

layout(location = 0) out vec4 position;   // view space; instance
layout(location = 1) out vec4 direction;  // view space; kind
layout(location = 2) out vec4 albedo;     // and specular power; of metal/rough surfaces the roughness
layout(location = 3) out vec4 specular;   // and occlusion

void main() {
    Surface s = read_gbuffer(ivec2(gl_FragCoord.xy));
    position = vec4(s.position, float(s.instance));
    direction = vec4(s.direction, float(s.kind));
    albedo = vec4(s.albedo, METAL_ROUGH != 0 ? s.roughness : s.power);
    specular = vec4(s.specular, s.occlusion);
}
