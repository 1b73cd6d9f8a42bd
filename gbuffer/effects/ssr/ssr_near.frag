#version 430
// How near each pixel's surface is: one over its depth, whatever the layout keeps of that; 0 on the background.
#include "gbuffer.glsl"

uniform SAMPLER native_depth;
layout(location = 0) out float near;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    bool covered = texelFetch(native_depth, pixel, SAMPLE).x < 1.0;
    near = covered ? -1.0 / read_gbuffer(pixel).position.z : 0.0;
}
