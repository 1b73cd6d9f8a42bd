#version 430
// A texel of what a light or the camera sees as a surfel that blocks light, at the nearest corner of the cells.
#include "vec.glsl"
#include "lpv_places.glsl"
#include "lpv_harmonics.glsl"

uniform sampler2D normal_texels, position_texels;
uniform int cascade;
flat out vec4 potential;

void main() {
    ivec2 texel = ivec2(gl_VertexID % TEXELS, gl_VertexID / TEXELS);
    vec4 position = texelFetch(position_texels, texel, 0);
    vec3 normal = texelFetch(normal_texels, texel, 0).xyz, n = in_world(normal);
    float facing = -dot(normal, ray_to(position.xyz));
    // B(w) = A / s^2 max(n.w, 0) (Kaplanyan and Dachsbacher 2010), with the surfel's own area A, at most a whole face
    float s = cell_of(cascade), share = min(texel_area(position.xyz) / max(facing * s * s, TINY), 1.0);
    potential = share * cosine_lobe(n);
    // On the side that the shift of the VPLs leaves it.
    ivec3 corner = ivec3(floor(in_cells(position.xyz, cascade) + 0.5 + (SHIFT - 0.5) * n));
    bool is_inside = all(greaterThanEqual(corner, ivec3(0))) && all(lessThan(corner, ivec3(CORNERS)));
    vec2 pixel = vec2(corner.x + CORNERS * corner.z, corner.y + CORNERS * cascade) + 0.5;
    bool counts = position.w > 0.0 && facing > 0.0 && is_inside;
    gl_Position = counts ? vec4(pixel / target_size.xy * 2.0 - 1.0, 0.0, 1.0) : vec4(vec3(2.0), 1.0);
}
