// What is drawn, and where; `order` lists the instances of each draw call one after the other.

struct Instance {
    mat4 model_view;
    ivec4 material_layer;  // material; stipple layer, 0 for what is opaque; instance
};
// Of a metal/rough material: base colour and alpha; metalness, roughness, reflectance, cutoff; emission; strength of the
// normal map, of the occlusion map, whether there is a normal map, any map. Of each map where it is looked up: two rows of an
// affine map, whether by the second set of uv, and along which axes (1, 2) it is mirrored beyond its sides.
struct Material {
    vec4 albedo_alpha, specular_power, emissive_kind;
    vec4 bump;  // strength, repeat
#if METAL_ROUGH
    vec4 maps[MAP_COUNT][2];
#endif
};
layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 1) readonly buffer Order { int order[]; };
layout(std430, binding = 3) readonly buffer Materials { Material materials[]; };
