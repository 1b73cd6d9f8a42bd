// X and Y in the pixel's own frame, beside per_pixel_view.py.
#include "../shared/view_frame.glsl"

vec2 per_pixel_view_encode(vec3 n, vec3 view) { return (n * view_frame(view)).xy; }

vec3 per_pixel_view_decode(vec2 e, vec3 view) {
    return view_frame(view) * vec3(e, sqrt(max(1.0 - dot(e, e), 0.0)));
}
