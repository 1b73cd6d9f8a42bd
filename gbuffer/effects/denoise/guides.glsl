// The guides of a pixel and how they change around it.
#include "frame.glsl"

uniform sampler2D denoise_guide;  // normal in world space; depth, 0 on the background

bool is_inside(ivec2 pixel) {
    return !any(lessThan(pixel, ivec2(0))) && !any(greaterThanEqual(pixel, ivec2(size.xy)));
}

vec4 guide_at(ivec2 pixel) { return is_inside(pixel) ? texelFetch(denoise_guide, pixel, 0) : vec4(0.0); }

// The change of depth towards the next pixel, by the neighbour that is less far off; 0 if there is none.
float depth_step(ivec2 pixel, float depth, ivec2 way) {
    float ahead = guide_at(pixel + way).w, behind = guide_at(pixel - way).w;
    float up = ahead > 0.0 ? ahead - depth : 1e9, down = behind > 0.0 ? depth - behind : 1e9;
    float least = abs(up) < abs(down) ? up : down;
    return abs(least) < 1e9 ? least : 0.0;
}

vec2 depth_slope(ivec2 pixel, float depth) {
    return vec2(depth_step(pixel, depth, ivec2(1, 0)), depth_step(pixel, depth, ivec2(0, 1)));
}
