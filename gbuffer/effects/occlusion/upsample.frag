#version 430
// Visibility of half the size, at the size of the G-buffer: of the four nearest texels those that belong to the pixel's
// surface, weighed by how near they are (bilinear), how close to its tangent plane, and how alike their normals are.
#include "taps.glsl"

uniform sampler2D half_visibility;
layout(location = 0) out float visibility;
#if BENDS
uniform sampler2D half_bent_normal;
layout(location = 1) out vec4 bent_normal;
#endif

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), texels = textureSize(half_visibility, 0);
    Surface s = read_gbuffer(pixel);
    vec3 n = normal_of(s, pixel), bent = vec3(0.0), nearest_bent = bent;
    vec2 apart = size.xy / vec2(texels);
    // As far as two texels lie apart on a surface that faces the eye.
    float tolerance = max(apart.x, apart.y) / pixels_per_metre(-s.position.z);
    ivec2 corner = ivec2(floor((vec2(pixel) + 0.5) / apart - 0.5));
    float sum = 0.0, total = 0.0, nearest = 1.0, closest = -1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 texel = clamp(corner + ivec2(i & 1, i >> 1), ivec2(0), texels - 1), tap = surface_pixel(texel, vec2(texels));
        vec2 near = max(1.0 - abs(vec2(pixel - tap)) / apart, 0.0);
        Surface other = read_gbuffer(tap);
        float plane = max(1.0 - abs(dot(n, other.position - s.position)) / tolerance, 0.0);
        float alike = pow(max(dot(n, normal_of(other, tap)), TINY), NORMAL_POWER);
        float weight = is_covered(tap) ? near.x * near.y * plane * alike : 0.0, v = texelFetch(half_visibility, texel, 0).x;
        if (is_covered(tap) && near.x * near.y > closest) {
            closest = near.x * near.y;
            nearest = v;
#if BENDS
            nearest_bent = texelFetch(half_bent_normal, texel, 0).xyz;
#endif
        }
        sum += weight * v;
        total += weight;
#if BENDS
        bent += weight * texelFetch(half_bent_normal, texel, 0).xyz;
#endif
    }
    bool found = total > 0.0, covered = is_covered(pixel);
    visibility = !covered ? 1.0 : found ? sum / total : nearest;
#if BENDS
    bent_normal = vec4(covered ? unit(found ? bent : nearest_bent) : vec3(0.0), 0.0);
#endif
}
