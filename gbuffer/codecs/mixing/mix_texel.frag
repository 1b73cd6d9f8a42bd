#version 430
// Texels of a target, or of one of its mip levels, as normals and numbers: every `stride`th one.
#include "mix.glsl"

uniform sampler2D texels;
uniform sampler2D signed_depths;
uniform sampler2D views;
uniform int stride;
uniform int level;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 numbers;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    CODE code = met(texelFetch(texels, pixel * stride, level), texelFetch(signed_depths, pixel * stride, level).x);
    numbers = widen(code);
    normal = vec4(DECODE(code, texelFetch(views, pixel, 0).xyz), 0.0);
}
