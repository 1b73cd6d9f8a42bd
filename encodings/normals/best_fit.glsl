// Best-fit normals, beside best_fit.py, which makes the table of scales.
#include "../vec.glsl"

uniform sampler2D best_fit_scale;

vec3 best_fit_sorted(vec3 a) {
    float low = min(a.x, a.y), high = max(a.x, a.y);
    return vec3(min(low, a.z), max(low, min(high, a.z)), max(high, a.z));
}

ivec2 best_fit_texel(vec3 a) {
    // i = floor(y SIZE / z), j = floor(x SIZE / y), in whole numbers: a shader's division of floats is not exact
    uvec3 q = uvec3(a * BEST_FIT_FIXED);
    uvec2 ij = q.yx * uint(BEST_FIT_SIZE) / uvec2(q.z, max(q.y, 1u));
    return ivec2(min(ij, uint(BEST_FIT_SIZE - 1)));
}

vec3 best_fit_encode(vec3 n, vec3 view) {
    // with |n|'s components sorted, x <= y <= z: c = n s(y / z, x / y) / z
    vec3 a = best_fit_sorted(abs(n));
    float scale = texelFetch(best_fit_scale, best_fit_texel(a), 0).x;
    return n * (scale / a.z);
}

vec3 best_fit_decode(vec3 e, vec3 view) { return unit(e); }
