#version 430
// The image with that light in place of what lies around, as far as rays met something.
#include "gbuffer.glsl"
#include "indirect.glsl"

uniform sampler2D reflected;
layout(location = 0) out vec4 added;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface s = read_gbuffer(pixel);
    vec4 found = texelFetch(reflected, pixel, 0);
    vec3 v = unit(-s.position), around = radiance(mat3(view_to_world) * reflect(-v, s.direction), s.roughness);
    // What of that is in both stays as it is.
    vec3 instead = AROUND != 0 ? found.rgb - (1.0 - found.a) * around : found.rgb;
    float share = AROUND != 0 ? found.a : 1.0;
    vec3 more = instead - share * s.occlusion * arriving_at(pixel) * around;
    added = vec4(answer_to_all(s, v, more, vec3(0.0)), 0.0);
}
