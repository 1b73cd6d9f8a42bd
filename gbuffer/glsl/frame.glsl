// What every pass of a frame knows: the camera and sizes.
#include "position.glsl"

layout(std140, binding = 0) uniform Frame {
    mat4 projection;          // view to clip space
    mat4 inverse_projection;  // and back
    mat4 view_to_world;
    mat4 view_to_sun;         // to the shadow map: x, y and depth in [0, 1]
    mat4 previous_clip;       // view space now to clip space a frame ago
    vec4 ambient;
    vec4 eye_ray;             // tan(fov/2) aspect, tan(fov/2), near, far
    vec4 size;                // of the G-buffer, in pixels; of the shadow map
    vec4 target_size;         // of the target at hand, in pixels
};
