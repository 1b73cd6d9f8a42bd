// The code of the encoding at hand: CODE is vec2 or vec3, ENCODE and DECODE are its functions, COMPONENTS of its numbers
// go to the normal's target and SIGN_BITS (0 or 1) to the depth's sign. LEVELS says how many values each number has, 0
// for one like any other; PRECISE is 1 where of the codes around the nearest is stored.
#include "vec.glsl"
#include "storage.glsl"
#include ENCODING
#include "turned.glsl"

vec4 widen(vec2 code) { return vec4(code, 0.0, 0.0); }
vec4 widen(vec3 code) { return vec4(code, 0.0); }

// The code of a normal, for channels with these integers for 1.
CODE encoded(vec3 n, vec3 view, float scales[3], bool is_biased) {
    CODE code = ENCODE(n, view);
#if PRECISE
    const int levels[] = LEVELS;
    CODE around = code;
    float least = 8.0;  // the square of a distance on the sphere is 4 at most
    for (int i = 0; i < 1 << COMPONENTS; ++i) {
        CODE candidate = around;
        for (int c = 0; c < COMPONENTS; ++c)
            if (levels[c] == 0)
                candidate[c] = numbers_around(around[c], scales[c], is_biased)[i >> (COMPONENTS - 1 - c) & 1];
        vec3 miss = n - DECODE(candidate, view);
        if (dot(miss, miss) < least) {
            least = dot(miss, miss);
            code = candidate;
        }
    }
#endif
    return code;
}
