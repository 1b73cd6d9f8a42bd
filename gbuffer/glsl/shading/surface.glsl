// What is lit: a point of a surface, and what its material says there.

struct Surface {
    vec3 position;   // view space
    vec3 direction;  // view space, unit: the shading normal; of hair the strand
    // Of a metal/rough surface: the share of light that is scattered, and that is reflected of light that meets it head
    // on.
    vec3 albedo, specular;
    vec3 emissive;
    float power, alpha, occlusion;
    int kind, instance, layer;
    vec2 motion;  // in screens, since the frame before
    // Of a metal/rough surface alone, which the two colours follow from.
    vec3 base;
    float metalness, reflectance, roughness;
};
