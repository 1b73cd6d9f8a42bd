#version 430
// Reads the storage under test back: the number, the depth, and the position by the way that was asked for.
#include "depth_code.glsl"
#include "position.glsl"
#include "storage.glsl"

uniform sampler2D points;  // place on the screen, depth
uniform sampler2D texels;
uniform vec2 range;        // near, far
uniform vec2 rays;         // the screen's upper right corner at depth 1
uniform vec2 clip;
uniform mat4 clip_to_view;
uniform vec2 terms;        // of the projection's row for z
uniform int way;           // 0 by the inverse projection, 1 by its two terms, 2 by the eye's ray
layout(location = 0) out vec4 position;
layout(location = 1) out vec2 stored;  // number, depth

float stored_number(vec4 texel) {
#if HOME == 0
    uint integer = 0u;
    for (int c = 0; c < 4; ++c) integer |= part_from(uint(texel[c] * 255.0 + 0.5), FIRST, BITS, c, 8);
    return from_fixed_code(integer, SCALE, DEPTH_SIGNED != 0);
#elif HOME == 3
    return BYTES_DECODE(texel);
#else
    return texel.x;
#endif
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec2 place = texelFetch(points, pixel, 0).xy;
    float number = stored_number(texelFetch(texels, pixel, 0)), depth = depth_of_number(number, range, OPEN != 0);
    stored = vec2(number, depth);
    position.w = 0.0;
    position.xyz = way == 0   ? position_from_window_depth(place, number, clip, clip_to_view)
                   : way == 1 ? position_from_projection_terms(place, number, clip, terms, rays)
                              : position_from_linear_depth(place, abs(depth), rays);
}
