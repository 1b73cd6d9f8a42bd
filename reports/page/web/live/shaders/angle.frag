// The angle between two directions in radians: atan of cross and dot, which is exact where they are close.
float angle_between(vec3 a, vec3 b) {
    return atan(length(cross(a, b)), dot(a, b));
}

// A share of full colour on the scale; what is not a number is black.
vec3 false_colour(highp sampler2D colours, float share) {
    return share >= 0.0 ? texture(colours, vec2(clamp(share, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb : vec3(0.0);
}
