#version 430
// The mean of the light of a pixel's samples, each decoded first.
#include "sample.glsl"
#include "light_code.glsl"

uniform SAMPLER samples;
out vec4 light;

void main() {
    light = vec4(0.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    for (int i = 0; i < SAMPLES; ++i) light += LIGHT_DECODE(texelFetch(samples, pixel, i)) / float(SAMPLES);
}
