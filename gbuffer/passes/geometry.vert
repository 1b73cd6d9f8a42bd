#version 430
// One mesh in many places.
#include "frame.glsl"
#include "instance.glsl"

in vec3 in_position;
in vec3 in_normal;
in vec4 in_tangent;
in vec2 in_uv;

uniform int first;
out vec3 position;
out vec3 normal;
out vec4 tangent;
out vec2 uv;
flat out int index;
invariant gl_Position;

void main() {
    index = order[first + gl_InstanceID];
    mat4 model_view = instances[index].model_view;
    position = (model_view * vec4(in_position, 1.0)).xyz;
    // Scales are uniform: normals turn as positions do.
    normal = mat3(model_view) * in_normal;
    tangent = vec4(mat3(model_view) * in_tangent.xyz, in_tangent.w);
    // Scaled here: the neighbours that a texture's footprint is taken from may be no fragments, and read no buffers.
    uv = in_uv * materials[instances[index].material_layer.x].bump.y;
    gl_Position = projection * vec4(position, 1.0);
}
