// What is lit: a point of a surface, and what its material says there.

struct Surface {
    vec3 position;   // view space
    vec3 direction;  // view space, unit: the shading normal; of hair the strand
    vec3 albedo, specular, emissive;
    float power, alpha;
    int kind, instance, layer;
    vec2 motion;  // in screens, since the frame before
};
