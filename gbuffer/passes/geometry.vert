#version 430
// One mesh in many places.
#include "frame.glsl"
#include "instance.glsl"

in vec3 in_position;
in vec3 in_normal;
in vec4 in_tangent;
in vec2 in_uv;
#if HAS_MAPS
in vec2 in_second_uv;
out vec2 places[MAP_COUNT];
flat out vec4 map_strengths;
flat out int mirrors;
#endif

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
    // Looked up here: the neighbours that a texture's footprint is taken from may be no fragments, and read no buffers.
    Material m = materials[instances[index].material_layer.x];
#if HAS_MAPS
    map_strengths = m.bump;
    mirrors = 0;
    for (int i = 0; i < MAP_COUNT; ++i) {
        vec3 at = vec3(m.maps[i][0].w > 0.5 ? in_second_uv : in_uv, 1.0);
        places[i] = vec2(dot(m.maps[i][0].xyz, at), dot(m.maps[i][1].xyz, at));
        mirrors |= int(m.maps[i][1].w + 0.5) << (2 * i);
    }
#endif
    uv = in_uv * m.bump.y;
    gl_Position = projection * vec4(position, 1.0);
}
