#version 430
// The discontinuity-sensitive filter over normals, as filter.glsl has it over light: of the four texels around those whose
// normal is close to the nearest one's, decoded, by bilinear weights.
#include "mix.glsl"

uniform sampler2D texels;
uniform sampler2D signed_depths;
uniform sampler2D views;
uniform sampler2D shares;
uniform int stride;
layout(location = 0) out vec4 normal;
layout(location = 1) out vec4 numbers;

vec3 tap(ivec2 place, vec3 view) {
    return unit(DECODE(met(texelFetch(texels, place, 0), texelFetch(signed_depths, place, 0).x), view));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), corner = pixel * stride;
    vec3 view = texelFetch(views, pixel, 0).xyz, sum = vec3(0.0);
    vec2 share = texelFetch(shares, pixel, 0).xy;
    vec3 nearest = tap(corner + ivec2(greaterThan(share, vec2(0.5))), view);
    float total = 0.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 right_up = ivec2(i & 1, i >> 1);
        vec2 part = mix(1.0 - share, share, vec2(right_up));
        vec3 n = tap(corner + right_up, view);
        float weight = part.x * part.y * (dot(n, nearest) > FILTER_COSINE ? 1.0 : 0.0);
        sum += weight * n;
        total += weight;
    }
    // The nearest texel matches itself: the total is never 0.
    normal = vec4(sum / total, 0.0);
    numbers = vec4(0.0);
}
