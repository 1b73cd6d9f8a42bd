// Noise to turn and shift taps by, fixed for each texel.

// Three numbers from 0 to below 1, of a texel and SEED: pcg3d (Jarzynski and Olano 2020, Hash Functions for GPU
// Rendering, listing 7).
vec3 noise_at(ivec2 texel) {
    uvec3 v = uvec3(texel, SEED) * uint(PCG_FACTOR) + uint(PCG_SUMMAND);
    for (int i = 0; i < 2; ++i) {
        v.x += v.y * v.z;
        v.y += v.z * v.x;
        v.z += v.x * v.y;
        if (i == 0) v ^= v >> 16;
    }
    return vec3(v >> 8) * exp2(-24.0);
}
