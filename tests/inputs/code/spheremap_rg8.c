/* Spheremap in RG8, by hand: what tests of the runners run. */
#include <math.h>
#include <stdint.h>

typedef struct { float x, y; } spheremap_rg8_vec2;
typedef struct { float x, y, z; } spheremap_rg8_vec3;
typedef struct { float x, y, z, w; } spheremap_rg8_vec4;

static inline spheremap_rg8_vec2 spheremap_rg8_encode(spheremap_rg8_vec3 n) {
    float g = 2.0f / sqrtf(8.0f * n.z + 8.0f);
    spheremap_rg8_vec2 pole = {1.0f, 0.0f}, code = {n.x * g, n.y * g};
    return n.z > -1.0f ? code : pole;
}
static inline uint32_t spheremap_rg8_byte(float c) {
    return (uint32_t)rintf(fminf(fmaxf(c * 0.5f + 0.5f, 0.0f), 1.0f) * 255.0f);
}
static inline uint32_t spheremap_rg8_pack(spheremap_rg8_vec2 code) {
    return spheremap_rg8_byte(code.x) | spheremap_rg8_byte(code.y) << 8;
}
static inline spheremap_rg8_vec2 spheremap_rg8_unpack(uint32_t words) {
    const float step = 1.0f / 255.0f;
    spheremap_rg8_vec2 code = {(float)(words & 255u) * step * 2.0f - 1.0f, (float)(words >> 8 & 255u) * step * 2.0f - 1.0f};
    return code;
}
static inline spheremap_rg8_vec3 spheremap_rg8_decode(spheremap_rg8_vec2 e) {
    float x = e.x * 2.0f, y = e.y * 2.0f, f = fminf(x * x + y * y, 4.0f), g = sqrtf(1.0f - f / 4.0f);
    spheremap_rg8_vec3 n = {x * g, y * g, 1.0f - f / 2.0f};
    return n;
}
static inline spheremap_rg8_vec4 spheremap_rg8_to_target(spheremap_rg8_vec2 code) {
    spheremap_rg8_vec4 target = {code.x * 0.5f + 0.5f, code.y * 0.5f + 0.5f, 0.0f, 1.0f};
    return target;
}
static inline spheremap_rg8_vec2 spheremap_rg8_from_target(spheremap_rg8_vec4 texel) {
    spheremap_rg8_vec2 code = {texel.x * 2.0f - 1.0f, texel.y * 2.0f - 1.0f};
    return code;
}
