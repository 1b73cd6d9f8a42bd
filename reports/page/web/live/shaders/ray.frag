// The ray of a pixel's middle, in view space.
uniform ivec2 size;
uniform vec2 slope;  // of the ray at the picture's right and upper edge

vec3 ray_at(ivec2 pixel) {
    return normalize(vec3(((vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0) * slope, -1.0));
}
