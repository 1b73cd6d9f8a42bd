// What is seen at a pixel, as the shader of its scene left it.
uniform highp usampler2D surfaces;  // the normal; the distance, whose lowest bits are the material; 0 where nothing is

struct Surface {
    vec3 n;     // unit, view space
    vec3 view;  // position, view space
    int material;
    bool covered;
};

Surface surface_at(ivec2 pixel) {
    uvec4 found = texelFetch(surfaces, pixel, 0);
    return Surface(uintBitsToFloat(found.xyz), ray_at(pixel) * uintBitsToFloat(found.w & ~31u), int(found.w & 31u), found.w != 0u);
}
