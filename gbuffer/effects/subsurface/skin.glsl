// Light of skin in red, green and blue, and in the fourth number its depth in metres, 0 where there is no skin.
#include "frame.glsl"

uniform sampler2D SOURCE;

vec4 skin_at(ivec2 pixel) {
    bool outside = any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, ivec2(size.xy)));
    return outside ? vec4(0.0) : texelFetch(SOURCE, pixel, 0);
}

// Pixels for each millimetre of skin on a surface at this depth that faces the eye.
float pixels_per_millimetre(float depth) { return METRES * 0.5 * size.y / (eye_ray.y * depth); }
