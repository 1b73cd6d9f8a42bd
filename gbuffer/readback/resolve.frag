#version 430
// The mean of a pixel's samples.
#include "sample.glsl"

uniform SAMPLER final;
layout(location = 0) out vec4 colour;

void main() {
    colour = vec4(0.0);
    for (int i = 0; i < SAMPLES; ++i) colour += texelFetch(final, ivec2(gl_FragCoord.xy), i) / float(SAMPLES);
}
