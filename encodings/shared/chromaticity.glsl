// The colour of light apart from how much there is, beside chromaticity.py. LUMA comes from there.
#include "vec.glsl"

float luminance(vec3 c) {
    const float luma[] = LUMA;
    return dot(c, vec3(luma[0], luma[1], luma[2]));
}

// The colour of light at luminance 1; white where there is none.
vec3 chromaticity(vec3 c) {
    float total = luminance(c);
    return total > TINY ? c / total : vec3(1.0);
}

// Specular light of the colour of the diffuse, from its luminance: chroma(D) A.
vec3 coloured(vec3 diffuse, float specular) { return chromaticity(diffuse) * specular; }
