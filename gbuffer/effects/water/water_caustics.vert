#version 430
// Two triangles for each cell of a lattice over the waves' patch and a margin, carried by refracted sunlight to the depth
// of a slice; beside water_caustics.frag.
#include "water_optics.glsl"
#include "water_map.glsl"

uniform vec3 sun;     // the way it goes, in the world
uniform float depth;  // of the slice, below still water
out vec2 above;       // where a ray enters the water, in metres

void main() {
    int cell = gl_VertexID / 6, corner = gl_VertexID % 6, side = CELLS + 2 * MARGIN;
    ivec2 offset = ivec2(corner == 1 || corner == 2 || corner == 4, corner == 2 || corner == 4 || corner == 5);
    vec2 rest = vec2(ivec2(cell % side, cell / side) - MARGIN + offset) / float(CELLS) * patch_size;
    Wave wave = wave_at(rest, patch_size / float(CELLS));
    vec3 straight = refract(sun, vec3(0.0, 1.0, 0.0), 1.0 / INDEX), bent = refract(sun, wave_normal(wave), 1.0 / INDEX);
    above = wave_point(rest, wave).xz;
    // Where it arrives, less the way that light takes through still water.
    vec2 hit = above + bent.xz / -bent.y * (depth + wave.height) - straight.xz / -straight.y * depth;
    gl_Position = vec4(hit / patch_size * 2.0 - 1.0, 0.0, 1.0);
}
