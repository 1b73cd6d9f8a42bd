#version 430
// Depth encoder, decoder and all ways to a position without any storage: the exact values that the two languages are
// compared by.
#include "depth_code.glsl"
#include "position.glsl"

uniform vec2 range;  // near, far
uniform vec2 rays;
uniform vec2 clip;
uniform vec2 terms;
uniform mat4 clip_to_view;
layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Points { vec4 points[]; };  // place on the screen, depth, number
layout(std430, binding = 1) writeonly buffer Values { vec4 values[]; };  // number, depth
layout(std430, binding = 2) writeonly buffer Projected { vec4 projected[]; };
layout(std430, binding = 3) writeonly buffer Terms { vec4 by_terms[]; };
layout(std430, binding = 4) writeonly buffer Rays { vec4 along_rays[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= points.length()) return;
    vec4 point = points[i];
    values[i] = vec4(number_of_depth(point.z, range, false), depth_of_number(point.w, range, false), 0.0, 0.0);
    projected[i] = vec4(position_from_window_depth(point.xy, point.w, clip, clip_to_view), 0.0);
    by_terms[i] = vec4(position_from_projection_terms(point.xy, point.w, clip, terms, rays), 0.0);
    along_rays[i] = vec4(position_from_linear_depth(point.xy, point.z, rays), 0.0);
}
