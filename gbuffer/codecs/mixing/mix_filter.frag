#version 430
// What the sampler's bilinear filter makes of codes, at the places of a texture.
#include "mix.glsl"

uniform sampler2D texels;
uniform sampler2D signed_depths;
uniform sampler2D views;
uniform sampler2D places;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 numbers;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = texelFetch(places, pixel, 0).xy;
    CODE code = met(textureLod(texels, place, 0.0), textureLod(signed_depths, place, 0.0).x);
    numbers = widen(code);
    normal = vec4(DECODE(code, texelFetch(views, pixel, 0).xyz), 0.0);
}
