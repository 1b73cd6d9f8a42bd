#version 430
// The depth of each pixel's surface, whatever the layout keeps of it; 0 on the background.
#include "gbuffer.glsl"

uniform SAMPLER native_depth;
layout(location = 0) out float depth;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bool covered = texelFetch(native_depth, pixel, SAMPLE).x < 1.0;
    depth = covered ? -read_gbuffer(pixel).position.z : 0.0;
}
