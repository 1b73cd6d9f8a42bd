#version 430
// The light of each sample in a light encoding.
#include "sample.glsl"
#include "light_code.glsl"

uniform SAMPLER colours;
out vec4 texel;

void main() {
    vec3 light = texelFetch(colours, ivec2(gl_FragCoord.xy), SAMPLE).rgb;
    texel = LIGHT_ENCODE(light_or_none(vec4(light, 0.0)));
}
