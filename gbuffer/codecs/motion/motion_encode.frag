#version 430
// Encodes a texture of motion vectors into the render target under test.
#include "motion_code.glsl"
#include "storage.glsl"
#include "dither.glsl"

uniform sampler2D motions;  // screens a frame
uniform float range;
layout(location = 0) out vec4 texel;

void main() {
    vec2 code = code_of_motion(texelFetch(motions, ivec2(gl_FragCoord.xy), 0).xy, range);
    texel = to_texel(dithered(vec4(code, 0.0, 0.0)));
}
