#version 430
// The mean of a pixel's samples, each decoded first; it is as long as the normals agree.
#include "sample.glsl"
#include "mix.glsl"

uniform SAMPLER samples;
uniform SAMPLER signed_samples;
uniform sampler2D views;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 numbers;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 view = texelFetch(views, pixel, 0).xyz, sum = vec3(0.0);
    for (int i = 0; i < SAMPLES; ++i)
        sum += DECODE(met(texelFetch(samples, pixel, i), texelFetch(signed_samples, pixel, i).x), view);
    normal = vec4(sum / float(SAMPLES), 0.0);
    numbers = vec4(0.0);
}
