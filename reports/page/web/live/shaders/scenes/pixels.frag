// A picture of normals, as large as it fits. Its light comes from afar, so that it needs no positions.
uniform highp sampler2D normals;  // xyz, and 1 in w where there is a surface; the lowest row first
uniform vec2 reach;  // what the window's right and upper edge are in the picture, whose own are 1

out uvec4 surface;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy), there = textureSize(normals, 0);
    vec2 at = (((vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0) * reach * 0.5 + 0.5) * vec2(there);
    ivec2 place = ivec2(floor(at));
    vec4 texel = texelFetch(normals, clamp(place, ivec2(0), there - 1), 0);
    bool covered = texel.w > 0.5 && place == clamp(place, ivec2(0), there - 1);
    surface = covered ? uvec4(floatBitsToUint(texel.xyz), floatBitsToUint(4.0) | 1u) : uvec4(0u);
}
