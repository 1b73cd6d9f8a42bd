// What every pass of a frame knows: the camera and the size of the target at hand.

layout(std140, binding = 0) uniform Frame {
    mat4 projection;          // view to clip space
    mat4 inverse_projection;  // and back
    mat4 view_to_world;
    mat4 view_to_sun;         // to the shadow map: x, y and depth in [0, 1]
    mat4 previous_clip;       // view space now to clip space a frame ago
    vec4 ambient;
    vec4 eye_ray;             // tan(fov/2) aspect, tan(fov/2), near, far
    vec4 size;                // of the target, in pixels; of the shadow map
};

#define FAR eye_ray.w

// View-space position from the depth buffer's z/w: the inverse projection of clip space.
vec3 position_from_window_depth(vec2 place, float depth) {
    vec4 p = inverse_projection * vec4(place, depth * 2.0 - 1.0, 1.0);
    return p.xyz / p.w;
}

// View-space position from linear depth, which is planar (-z): the eye's ray times the depth.
vec3 position_from_linear_depth(vec2 place, float depth) { return vec3(place * eye_ray.xy, -1.0) * depth; }
