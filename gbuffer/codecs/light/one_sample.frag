#version 430
// One sample of every pixel.
#include "sample.glsl"

uniform SAMPLER colours;
uniform int which;
out vec4 colour;

void main() { colour = texelFetch(colours, ivec2(gl_FragCoord.xy), which); }
