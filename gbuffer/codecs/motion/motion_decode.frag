#version 430
// Reads the render target under test back into motion vectors.
#include "motion_code.glsl"
#include "storage.glsl"

uniform sampler2D texels;
uniform float range;
layout(location = 0) out vec4 motion;

void main() {
    vec4 code = from_texel(texelFetch(texels, ivec2(gl_FragCoord.xy), 0));
    motion = vec4(motion_of_code(code.xy, range), 0.0, 0.0);
}
