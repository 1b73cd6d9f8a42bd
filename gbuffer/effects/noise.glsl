// Noise to turn and shift taps by, fixed for each texel.

// Three numbers from 0 to below 1, of a texel and a seed: pcg3d (Jarzynski and Olano 2020, Hash Functions for GPU
// Rendering, listing 7).
vec3 noise_at(ivec2 texel, int seed) {
    uvec3 v = uvec3(texel, seed) * uint(PCG_FACTOR) + uint(PCG_SUMMAND);
    for (int i = 0; i < 2; ++i) {
        v.x += v.y * v.z;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        if (i == 0) v ^= v >> 16;
    }
    return vec3(v >> 8) * exp2(-24.0);
}
vec3 noise_at(ivec2 texel) { return noise_at(texel, SEED); }
