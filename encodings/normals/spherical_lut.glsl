// Spherical coordinates read from two look-up textures, beside spherical_lut.py, which makes them.

uniform sampler2D spherical_lut_angle;
uniform sampler2D spherical_lut_xy;

ivec2 spherical_lut_texel(vec2 p) {
    return ivec2(floor(clamp(p * 0.5 + 0.5, 0.0, 1.0) * SPHERICAL_LUT_LAST + 0.5));
}

vec2 spherical_lut_encode(vec3 n, vec3 view) {
    return vec2(texelFetch(spherical_lut_angle, spherical_lut_texel(n.xy), 0).x, n.z);
}

vec3 spherical_lut_decode(vec2 e, vec3 view) {
    return vec3(texelFetch(spherical_lut_xy, spherical_lut_texel(e), 0).xy, e.y);
}
