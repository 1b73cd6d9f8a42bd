#version 430
// The radial grid around the eye, moved by the waves; beside grid.py.
#include "frame.glsl"
#include "water_map.glsl"

in vec3 in_ring;      // cosine and sine of the spoke, number of the ring
uniform vec2 centre;  // in the world
uniform float curve;  // r = FIRST_GAP i + curve i^4
out vec3 position;
out vec3 world;
out vec2 rest;

void main() {
    float i = in_ring.z, cubed = i * i * i, r = FIRST_GAP * i + curve * cubed * i;
    // The longer of the distances to the next vertex, around and out.
    float spacing = max(r * TURN / float(SPOKES), FIRST_GAP + 4.0 * curve * cubed);
    rest = centre + r * in_ring.xy;
    world = wave_point(rest, wave_at(rest, spacing));
    position = (world - view_to_world[3].xyz) * mat3(view_to_world);
    gl_Position = projection * vec4(position, 1.0);
}
