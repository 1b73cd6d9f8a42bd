#version 430
// The native depth buffer, resolved to linear view depth.
#include "sample.glsl"

uniform SAMPLER native_depth;
out float linear;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(native_depth, pixel, SAMPLE).x;
    linear = -position_from_window_depth(screen_place(pixel), depth, vec2(2.0, -1.0), inverse_projection).z;
}
