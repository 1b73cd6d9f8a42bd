// Random directions and how far off they come back, as the bits of floats: degrees, and the square of the difference; or
// the direction itself.
uniform float halves;  // 1 for z >= 0 alone, 2 for the whole sphere

out uvec4 found;

// M. Jarzynski and M. Olano, Hash Functions for GPU Rendering, JCGT 2020: pcg2d.
uvec2 hashed(uvec2 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    v ^= v >> 16u;
    v.x += v.y * 1664525u;
    v.y += v.x * 1664525u;
    return v ^ (v >> 16u);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    // Of the highest bits, so that each is a float in [0, 1).
    vec2 random = vec2(hashed(uvec2(pixel)) >> 8u) / 16777216.0;
    float z = 1.0 - halves * random.x, around = 6.283185307 * random.y;
    vec3 n = normalize(vec3(sqrt(max(1.0 - z * z, 0.0)) * vec2(cos(around), sin(around)), z));
#ifdef DIRECTION
    found = floatBitsToUint(vec4(n, 0.0));
#else
    vec3 back = round_trip(n, vec3(0.0, 0.0, -1.0)), apart = back - n;
    found = floatBitsToUint(vec4(degrees(angle_between(n, back)), dot(apart, apart), 0.0, 0.0));
#endif
}
