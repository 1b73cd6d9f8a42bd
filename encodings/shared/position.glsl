// View-space positions from stored depths, beside position.py.

// From a depth buffer's depth, from 0 to 1, by the inverse projection; clip.x and clip.y say how clip space counts depth:
// (2, -1) as GL does unless told otherwise, (1, 0) under glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE).
vec3 position_from_window_depth(vec2 place, float depth, vec2 clip, mat4 clip_to_view) {
    // p = clip_to_view (place, clip.x depth + clip.y, 1), position = p.xyz / p.w
    vec4 p = clip_to_view * vec4(place, clip.x * depth + clip.y, 1.0);
    return p.xyz / p.w;
}

// From a depth buffer's depth by the two terms of the projection, as many engines compute it: clip-space z is
// terms.x z + terms.y, with w = -z.
vec3 position_from_projection_terms(vec2 place, float depth, vec2 clip, vec2 terms, vec2 rays) {
    // ndc = (a z + b) / -z, so -z = b / (ndc + a)
    float linear_depth = terms.y / (clip.x * depth + clip.y + terms.x);
    return vec3(place * rays, -1.0) * linear_depth;
}

// From a linear depth, which is planar (-z): the eye's ray times the depth.
vec3 position_from_linear_depth(vec2 place, float depth, vec2 rays) {
    // position = (place rays, -1) depth
    return vec3(place * rays, -1.0) * depth;
}
