#version 430
// What the denoiser's weights read: the decoded normal in world space, the depth and the roughness.
#include "gbuffer.glsl"

uniform sampler2D ssr_near;
layout(location = 0) out vec4 guide;
layout(location = 1) out float roughness;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    guide = vec4(0.0);
    roughness = 0.0;
    if (texelFetch(ssr_near, pixel, 0).x <= 0.0) return;
    Surface s = read_gbuffer(pixel);
    guide = vec4(mat3(view_to_world) * s.direction, -s.position.z);
    roughness = s.roughness;
}
