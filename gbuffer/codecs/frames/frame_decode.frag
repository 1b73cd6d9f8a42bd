#version 430
// Reads the render target under test back into tangent frames.
#include "frame_code.glsl"
#include "storage.glsl"

uniform sampler2D texels;
layout(location = 0) out vec4 normal;  // and the hand
layout(location = 1) out vec4 tangent;

void main() {
    Frame frame = FRAME_DECODE(from_texel(texelFetch(texels, ivec2(gl_FragCoord.xy), 0)), FRAME_LEAST);
    normal = vec4(frame.normal, frame.hand);
    tangent = vec4(frame.tangent, 0.0);
}
