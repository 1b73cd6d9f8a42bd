// What a texel of a picture of TEXELS x TEXELS covers, in view space; parallel rays or those of a perspective.
#include "frame.glsl"

bool is_parallel() { return projection[3][3] != 0.0; }
vec3 ray_to(vec3 position) { return is_parallel() ? vec3(0.0, 0.0, -1.0) : normalize(position); }

// The area of a texel's bundle of rays at `position`, at right angles to them.
float texel_area(vec3 position) {
    float at_one = 4.0 * eye_ray.x * eye_ray.y / float(TEXELS * TEXELS), z = -position.z;
    // At right angles to the line of sight z^2 as large; to the ray, cos = z / |p| of that.
    return is_parallel() ? at_one : at_one * z * z * z / length(position);
}
