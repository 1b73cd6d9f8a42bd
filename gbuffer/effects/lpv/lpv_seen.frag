#version 430
// What the camera's G-buffer holds, at TEXELS x TEXELS of its pixels: normal and position in view space.
#include "gbuffer.glsl"
#include "lpv_places.glsl"

layout(location = 0) out vec4 normal_texel;
layout(location = 1) out vec4 position_texel;

void main() {
    Surface s = read_gbuffer(ivec2(gl_FragCoord.xy / float(TEXELS) * size.xy));
    normal_texel = vec4(s.direction, 1.0);
    position_texel = vec4(s.position, is_covered(-s.position.z) ? 1.0 : 0.0);
}
