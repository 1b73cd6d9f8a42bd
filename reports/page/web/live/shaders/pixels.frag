// What is seen at a pixel: a picture of the run. Its light comes from afar, so that it needs no positions.
uniform highp sampler2D normals;  // xyz, and 1 in w where there is a surface; the lowest row first
uniform vec2 slope;

struct Surface {
    vec3 n;
    vec3 view;
    vec3 colour;
    bool covered;
};

Surface surface_at(ivec2 pixel, ivec2 size) {
    ivec2 there = textureSize(normals, 0);
    vec4 texel = texelFetch(normals, min(pixel * there / size, there - 1), 0);
    vec2 screen = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    return Surface(texel.xyz, normalize(vec3(screen * slope, -1.0)) * 4.0, vec3(0.4), texel.w > 0.5);
}
