// Where the volumes lie in the world. Cascade c has cells of CELL 2^c metres; `origins` are the low corners, in cells of
// the cascade from the origin of the world.
#include "frame.glsl"

uniform ivec3 origins[CASCADES];

float cell_of(int cascade) { return CELL * float(1 << cascade); }

// A place in view space, in cells from the low corner; and a direction along the axes of the world.
vec3 in_cells(vec3 position, int cascade) {
    vec3 world = (view_to_world * vec4(position, 1.0)).xyz;
    return world / cell_of(cascade) - vec3(origins[cascade]);
}
vec3 in_world(vec3 direction) { return mat3(view_to_world) * direction; }

// Whether a depth of the G-buffer is a surface's, and not what was cleared: 0, or the far plane less what rounding takes.
bool is_covered(float depth) { return depth >= eye_ray.z && depth < eye_ray.w * COVERED_SHARE; }

// Of a picture of TEXELS x TEXELS, with parallel rays or those of a perspective.
bool is_parallel() { return projection[3][3] != 0.0; }
vec3 ray_to(vec3 position) { return is_parallel() ? vec3(0.0, 0.0, -1.0) : normalize(position); }

// The area of a texel's bundle of rays at `position`, at right angles to them.
float texel_area(vec3 position) {
    float at_one = 4.0 * eye_ray.x * eye_ray.y / float(TEXELS * TEXELS), z = -position.z;
    // At right angles to the line of sight z^2 as large; to the ray, cos = z / |p| of that.
    return is_parallel() ? at_one : at_one * z * z * z / length(position);
}
