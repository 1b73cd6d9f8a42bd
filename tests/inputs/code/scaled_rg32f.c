/* By hand, for tests of the runners: a code with a view, a table, a sign and two words. Every step is exact. */
#include <stdint.h>
#include <string.h>
#include "scaled_rg32f_tables.h"

typedef struct { float x, y; } scaled_rg32f_vec2;
typedef struct { float x, y, z; } scaled_rg32f_vec3;
typedef struct { float x, y, z, w; } scaled_rg32f_vec4;
typedef struct { uint32_t x, y; } scaled_rg32f_uvec2;

static inline scaled_rg32f_vec3 scaled_rg32f_encode(scaled_rg32f_vec3 n, scaled_rg32f_vec3 view) {
    float step = scaled_rg32f_steps[n.z < 0.0f][1];
    scaled_rg32f_vec3 code = {n.x * step + view.x, n.y * step + view.y, n.z < 0.0f ? -1.0f : 1.0f};
    return code;
}
static inline scaled_rg32f_uvec2 scaled_rg32f_pack(scaled_rg32f_vec3 code) {
    scaled_rg32f_uvec2 words;
    memcpy(&words, &code, sizeof words);
    return words;
}
static inline scaled_rg32f_vec3 scaled_rg32f_unpack(scaled_rg32f_uvec2 words, float sign) {
    scaled_rg32f_vec3 code = {0.0f, 0.0f, sign};
    memcpy(&code, &words, sizeof words);
    return code;
}
static inline scaled_rg32f_vec3 scaled_rg32f_decode(scaled_rg32f_vec3 e, scaled_rg32f_vec3 view) {
    float step = scaled_rg32f_steps[e.z < 0.0f][1];
    scaled_rg32f_vec3 n = {(e.x - view.x) / step, (e.y - view.y) / step, e.z};
    return n;
}
static inline scaled_rg32f_vec4 scaled_rg32f_to_target(scaled_rg32f_vec3 code) {
    scaled_rg32f_vec4 target = {code.x, code.y, 0.0f, 1.0f};
    return target;
}
static inline scaled_rg32f_vec3 scaled_rg32f_from_target(scaled_rg32f_vec4 texel, float sign) {
    scaled_rg32f_vec3 code = {texel.x, texel.y, sign};
    return code;
}
