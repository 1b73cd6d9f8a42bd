#version 430
// View depth of what is there before the water, from the depth that all pipelines have.
#include "sample.glsl"

uniform SAMPLER native_depth;
layout(location = 0) out float behind;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = (vec2(pixel) + SAMPLE_PLACE) / target_size.xy * 2.0 - 1.0;
    float depth = texelFetch(native_depth, pixel, SAMPLE).x;
    behind = -position_from_window_depth(place, depth, vec2(2.0, -1.0), inverse_projection).z;
}
