#version 430
// What single lights, and even light from everywhere, make of metal/rough surfaces.
#include "metal_rough.glsl"

layout(local_size_x = 64) in;
layout(std430, binding = 0) readonly buffer Lights { vec4 light[]; };    // the way to it, and the roughness
layout(std430, binding = 1) readonly buffer Eyes { vec4 eye[]; };        // the way to it; unused
layout(std430, binding = 2) readonly buffer Colours { vec4 colour[]; };  // diffuse albedo, reflectance head on; unused
layout(std430, binding = 3) writeonly buffer Singles { vec4 single[]; };
layout(std430, binding = 4) writeonly buffer Evens { vec4 even[]; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= light.length()) return;
    Surface s;
    s.direction = vec3(0.0, 0.0, 1.0);
    s.roughness = light[i].w;
    s.albedo = vec3(colour[i].x);
    s.specular = vec3(colour[i].y);
    single[i] = vec4(answer(s, light[i].xyz, eye[i].xyz), 0.0);
    even[i] = vec4(answer_to_all(s, eye[i].xyz, vec3(1.0), vec3(1.0)), 0.0);
}
