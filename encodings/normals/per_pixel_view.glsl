// X and Y in the pixel's own frame, beside per_pixel_view.py.
#include "../vec.glsl"

mat3 per_pixel_view_frame(vec3 view) {
    // z = -view, x = normalize(z.z, 0, -z.x), y = cross(z, x)
    vec3 z = -unit(view);
    vec3 x = unit(vec3(z.z, 0.0, -z.x));
    return mat3(x, cross(z, x), z);
}

vec2 per_pixel_view_encode(vec3 n, vec3 view) { return (n * per_pixel_view_frame(view)).xy; }

vec3 per_pixel_view_decode(vec2 e, vec3 view) {
    return per_pixel_view_frame(view) * vec3(e, sqrt(max(1.0 - dot(e, e), 0.0)));
}
