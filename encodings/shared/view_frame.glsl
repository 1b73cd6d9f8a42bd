// The pixel's own frame, whose z looks back along the line of sight, beside view_frame.py.
#include "../vec.glsl"

mat3 view_frame(vec3 view) {
    // z = -view, x = normalize(z.z, 0, -z.x), y = cross(z, x)
    vec3 z = -unit(view);
    vec3 x = unit(vec3(z.z, 0.0, -z.x));
    return mat3(x, cross(z, x), z);
}
