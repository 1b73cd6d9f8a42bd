#version 430
// What one ray of each pixel brings: reflected light, as dense as what GGX's visible facets reflect, or whether something
// occludes a direction of the hemisphere, as dense as its cosine.
#include "gbuffer.glsl"
#include "environment.glsl"
#include "noise.glsl"
#include "ssr_lobe.glsl"
#include "ssr_march.glsl"

uniform SAMPLER final;
uniform int frame;
layout(location = 0) out vec4 noisy;

// A direction of the upper hemisphere by two numbers in [0, 1): a disc's point, raised onto the sphere.
vec3 cosine_direction(vec2 u) {
    float turn = 2.0 * PI * u.x;
    return vec3(sqrt(u.y) * vec2(cos(turn), sin(turn)), sqrt(1.0 - u.y));
}

vec3 light_along(Surface s, vec3 ray) {
    Hit hit = meet(s.position, ray);
    if (hit.there) return texelFetch(final, min(ivec2(hit.place), ivec2(size.xy) - 1), SAMPLE).rgb;
    return radiance(mat3(view_to_world) * ray, 0.0);
}

// 0 where the ray meets a surface within RADIUS.
float open_along(Surface s, vec3 ray) {
    Hit hit = meet(s.position, ray);
    float depth = hit.there ? 1.0 / nearest_shown(hit.place) : 0.0;
    vec3 place = position_from_linear_depth(hit.place / size.xy * 2.0 - 1.0, depth, eye_ray.xy);
    return hit.there && distance(place, s.position) <= RADIUS ? 0.0 : 1.0;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    noisy = vec4(0.0);
    if (texelFetch(ssr_near, pixel, 0).x <= 0.0) return;
    Surface s = read_gbuffer(pixel);
    mat3 axes = axes_around(s.direction);
    vec2 u = noise_at(pixel, SEED + frame).xy;
    if (SIGNAL != 0) {
        noisy = vec4(vec3(open_along(s, axes * cosine_direction(u))), 1.0);
        return;
    }
    float a = s.roughness * s.roughness;
    vec3 v = unit(-s.position) * axes, l = reflect(-v, visible_facet(v, a, u));
    // Under the surface a ray has no light of its own: the mirrored one stands in.
    if (unmasked(l.z, v.z, a) <= 0.0) l = vec3(-v.xy, v.z);
    noisy = vec4(min(light_along(s, axes * l), BRIGHTEST), 1.0);
}
