// What is drawn, and where; `order` lists the instances of each draw call one after the other.

struct Instance {
    mat4 model_view;
    ivec4 material_layer;  // material; stipple layer, 0 for what is opaque; instance
};
struct Material {
    vec4 albedo_alpha, specular_power, emissive_kind;
    vec4 bump;  // strength, repeat
};
layout(std430, binding = 0) readonly buffer Instances { Instance instances[]; };
layout(std430, binding = 1) readonly buffer Order { int order[]; };
layout(std430, binding = 3) readonly buffer Materials { Material materials[]; };
