#version 430
// A texel of a reflective shadow map as a virtual point light (VPL) in its cell.
#include "lpv_places.glsl"
#include "lpv_harmonics.glsl"

uniform sampler2D flux_texels, normal_texels, position_texels;
uniform int cascade;
flat out vec3 flux;
flat out vec4 lobe;

void main() {
    ivec2 texel = ivec2(gl_VertexID % TEXELS, gl_VertexID / TEXELS);
    vec4 position = texelFetch(position_texels, texel, 0);
    vec3 n = in_world(texelFetch(normal_texels, texel, 0).xyz);
    flux = texelFetch(flux_texels, texel, 0).rgb;
    lobe = cosine_lobe(n);
    // Half a cell along the normal, so that a wall does not light itself (Kaplanyan 2009).
    ivec3 cell = ivec3(floor(in_cells(position.xyz, cascade) + SHIFT * n));
    bool is_inside = all(greaterThanEqual(cell, ivec3(0))) && all(lessThan(cell, ivec3(CELLS)));
    vec2 pixel = vec2(cell.x + CELLS * cell.z, cell.y + CELLS * cascade) + 0.5;
    gl_Position = position.w > 0.0 && is_inside ? vec4(pixel / target_size.xy * 2.0 - 1.0, 0.0, 1.0) : vec4(vec3(2.0), 1.0);
}
