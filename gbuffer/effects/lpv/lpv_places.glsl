// Where the volumes lie in the world. Cascade c has cells of CELL 2^c metres; `origins` are the low corners, in cells of
// the cascade from the origin of the world.
#include "frame.glsl"

uniform ivec3 origins[CASCADES];

float cell_of(int cascade) { return CELL * float(1 << cascade); }

// A place in view space, in cells from the low corner; and a direction along the axes of the world.
vec3 in_cells(vec3 position, int cascade) {
    vec3 world = (view_to_world * vec4(position, 1.0)).xyz;
    return world / cell_of(cascade) - vec3(origins[cascade]);
}
vec3 in_world(vec3 direction) { return mat3(view_to_world) * direction; }
