// What the methods of ambient occlusion read: the surface at hand and those around it.
#include "gbuffer.glsl"

uniform sampler2D occluder_depth;  // 0 on the background

// The pixel of the G-buffer that a texel of a buffer of this size stands for.
ivec2 surface_pixel(ivec2 texel, vec2 texels) { return ivec2((vec2(texel) + 0.5) * (size.xy / texels)); }

bool is_covered(ivec2 pixel) { return texelFetch(occluder_depth, pixel, 0).x > 0.0; }

vec3 at_depth(ivec2 pixel, float depth) { return position_from_linear_depth(screen_place(pixel), depth, eye_ray.xy); }

// The depth at a pixel; 0 where no surface is known: on the background and beyond the picture.
float depth_of(ivec2 pixel) {
    bool outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(size.xy)));
    return outside ? 0.0 : texelFetch(occluder_depth, pixel, 0).x;
}

// From p to the next pixel's surface that way, by the one of the two neighbours that is less far off in depth.
vec3 next_to(ivec2 pixel, vec3 p, ivec2 way) {
    float ahead = depth_of(pixel + way), behind = depth_of(pixel - way);
    bool forward = ahead > 0.0 && (behind <= 0.0 || abs(ahead + p.z) < abs(behind + p.z));
    return forward ? at_depth(pixel + way, ahead) - p : p - at_depth(pixel - way, behind);
}

// The normal. Of hair the G-buffer holds the strand: there it is what the depths around say.
vec3 normal_of(Surface s, ivec2 pixel) {
    if (HAS_KIND == 0 || s.kind != HAIR) return s.direction;
    return unit(cross(next_to(pixel, s.position, ivec2(1, 0)), next_to(pixel, s.position, ivec2(0, 1))));
}

// Pixels for each metre at a depth.
float pixels_per_metre(float depth) { return 0.5 * size.y / (eye_ray.y * depth); }
