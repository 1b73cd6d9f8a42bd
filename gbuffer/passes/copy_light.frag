#version 430
// The light buffer back to the targets that the next light is read from.
#include "sample.glsl"

uniform SAMPLER light_before[LIGHT_TARGETS];
layout(location = 0) out vec4 light_texels[LIGHT_TARGETS];

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    light_texels[0] = texelFetch(light_before[0], pixel, SAMPLE);
#if LIGHT_TARGETS > 1
    light_texels[1] = texelFetch(light_before[1], pixel, SAMPLE);
#endif
}
