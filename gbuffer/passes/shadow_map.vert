#version 430
// One mesh in many places, as the sun sees it.
#include "frame.glsl"
#include "instance.glsl"

in vec3 in_position;
uniform int first;

void main() {
    vec4 p = view_to_sun * (instances[order[first + gl_InstanceID]].model_view * vec4(in_position, 1.0));
    gl_Position = vec4(p.xyz * 2.0 - 1.0, 1.0);
}
