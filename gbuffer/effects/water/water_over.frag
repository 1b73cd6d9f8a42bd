#version 430
// The water over the image.
#include "sample.glsl"

uniform SAMPLER water;
layout(location = 0) out vec4 colour;

void main() {
    colour = texelFetch(water, ivec2(gl_FragCoord.xy), SAMPLE);
    if (colour.a == 0.0) discard;
}
