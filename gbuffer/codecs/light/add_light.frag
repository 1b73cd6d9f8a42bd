#version 430
// One row of a table of lights added to a light buffer: by the blending that is set up, or to what was read.
#include "light_code.glsl"

uniform sampler2D lights;
uniform sampler2D light_before;
uniform int light;
out vec4 texel;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 sum = texelFetch(lights, ivec2(pixel.x, light), 0);
#if LIGHT_READS
    sum += LIGHT_DECODE(texelFetch(light_before, pixel, 0));
#endif
    texel = LIGHT_ENCODE(light_or_none(sum));
}
