// Surfaces to the texels of a layout and back. The layout comes from layouts.py as macros: WORDS words, each a component
// (WORD_COMPONENT) in a target (WORD_TARGET), in a channel of its own (WORD_BITS 0, WORD_FIRST the channel) or as an
// integer of WORD_BITS bits from bit WORD_FIRST on; for each of TARGETS targets the kind of its format, its channels'
// scales, and whether the shader rounds (1 nearest, 2 truncate).
#include "sample.glsl"
#include "code.glsl"
#include "../../encodings/storage.glsl"
#include "surface.glsl"

const int word_component[] = WORD_COMPONENT, word_target[] = WORD_TARGET, word_first[] = WORD_FIRST;
const int word_bits[] = WORD_BITS, target_kind[] = TARGET_KIND, target_rounds[] = TARGET_ROUNDS;
const float target_scale[] = TARGET_SCALE;

bool is_signed(int component) { return component < DEPTH || component >= MOTION; }
bool is_integer(int component) { return component == KIND || component == INSTANCE; }

// A number as a fixed-point format keeps it, between 0 and 1; code scale x is the integer nearest it times `scale`.
float to_unit(int component, float x, float scale) {
    if (is_signed(component)) return x * 0.5 + 0.5;
    if (is_integer(component)) return mod(x, scale + 1.0) / scale;
    if (component == POWER) return log2(max(x, 1.0)) / LOG2_POWER_MAX;
    if (component != DEPTH) return x;
#if SIGN_BITS
    // Sign and magnitude: the upper half of the codes is for normals that face away.
    float half_scale = floor(scale * 0.5), code = floor(clamp(abs(x) / FAR, 0.0, 1.0) * half_scale + 0.5);
    return (floatBitsToUint(x) >> 31 != 0u ? code + half_scale + 1.0 : code) / scale;
#else
    return x / FAR;
#endif
}

float from_unit(int component, float x, float scale) {
    if (is_signed(component)) return x * 2.0 - 1.0;
    if (is_integer(component)) return floor(x * scale + 0.5);
    if (component == POWER) return exp2(x * LOG2_POWER_MAX);
    if (component != DEPTH) return x;
#if SIGN_BITS
    float half_scale = floor(scale * 0.5), code = floor(x * scale + 0.5);
    bool away = code > half_scale;
    float depth = (away ? code - half_scale - 1.0 : code) / half_scale * FAR;
    return away ? uintBitsToFloat(floatBitsToUint(depth) | 0x80000000u) : depth;
#else
    return x * FAR;
#endif
}

// A number that has a channel of its own.
float to_channel(int component, float x, int kind, float scale) {
    if (kind >= 2) return x;
    if (kind == 0) return to_unit(component, x, scale);
    return is_signed(component) ? x : to_unit(component, x, scale);
}

float from_channel(int component, float x, int kind, float scale) {
    if (kind >= 2) return x;
    return kind == 1 && is_signed(component) ? x : from_unit(component, x, scale);
}

#ifdef WRITES_GBUFFER
layout(location = 0) out vec4 texels[TARGETS];

void write_gbuffer(Surface s) {
    float numbers[NUMBERS];
    mat3 axes = WORLD_SPACE != 0 ? mat3(view_to_world) : mat3(1.0);
    vec4 code = widen(ENCODE(direction_or_forward(axes * s.direction), axes * s.position));
    for (int i = 0; i < DEPTH; ++i) numbers[i] = code[i];
    numbers[DEPTH] = SIGN_BITS != 0 ? code[COMPONENTS] * -s.position.z : -s.position.z;
    for (int i = 0; i < 3; ++i) {
        numbers[ALBEDO + i] = s.albedo[i];
        numbers[SPECULAR + i] = s.specular[i];
    }
    numbers[POWER] = s.power;
    numbers[KIND] = float(s.kind);
    numbers[INSTANCE] = float(s.instance);
    numbers[MOTION] = s.motion.x;
    numbers[MOTION + 1] = s.motion.y;

    uvec4 packed_bytes[TARGETS];
    for (int i = 0; i < TARGETS; ++i) {
        texels[i] = vec4(0.0);
        packed_bytes[i] = uvec4(0u);
    }
    for (int w = 0; w < WORDS; ++w) {
        int target = word_target[w], first = word_first[w], bits = word_bits[w], component = word_component[w];
        float x = numbers[component];
        if (bits == 0) {
            int kind = target_kind[target], rounds = target_rounds[target];
            float scale = target_scale[target * 4 + first], texel = to_channel(component, x, kind, scale);
            texels[target][first] = rounds != 0 ? round_number(texel, kind, scale, rounds == 2) : texel;
        } else {
            float scale = exp2(float(bits)) - 1.0;
            float part = clamp(to_unit(component, x, scale), 0.0, 1.0);
            // Only the normal is packed as the layout says; a depth or a power is always rounded.
            vec2 rule = component < DEPTH ? vec2(PACK_WIDEN, PACK_BIAS) : vec2(0.0, 0.5);
            uint integer = uint(min(floor(part * (scale + rule.x) + rule.y), scale));
            for (int c = 0; c < 4; ++c) {
                int shift = 8 * (c + 1) - first - bits;
                if (8 * (c + 1) <= first || shift >= 8) continue;
                packed_bytes[target][c] |= (shift >= 0 ? integer << shift : integer >> -shift) & 0xFFu;
            }
        }
    }
    for (int i = 0; i < TARGETS; ++i)
        for (int c = 0; c < 4; ++c) texels[i][c] += float(packed_bytes[i][c]) / target_scale[i * 4 + c];
}
#else
uniform SAMPLER gbuffer[TARGETS];
uniform SAMPLER linear_depth;

// The surface in a pixel's sample. What the layout does not keep is left at a general material's default.
Surface read_gbuffer(ivec2 pixel) {
    vec4 texels[TARGETS];
    for (int i = 0; i < TARGETS; ++i) texels[i] = texelFetch(gbuffer[i], pixel, SAMPLE);
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = 0.0;
    numbers[POWER] = LIGHT_PASS_POWER;
    for (int w = 0; w < WORDS; ++w) {
        int target = word_target[w], first = word_first[w], bits = word_bits[w], component = word_component[w];
        if (bits == 0) {
            numbers[component] =
                from_channel(component, texels[target][first], target_kind[target], target_scale[target * 4 + first]);
        } else {
            uint integer = 0u;
            for (int c = 0; c < 4; ++c) {
                int shift = 8 * (c + 1) - first - bits;
                if (8 * (c + 1) <= first || shift >= 8) continue;
                uint piece = uint(texels[target][c] * target_scale[target * 4 + c] + 0.5);
                integer |= shift >= 0 ? piece >> shift : piece << -shift;
            }
            float scale = exp2(float(bits)) - 1.0;
            numbers[component] = from_unit(component, float(integer & uint(scale)) / scale, scale);
        }
    }
    Surface s;
    float depth = HAS_DEPTH != 0 ? abs(numbers[DEPTH]) : texelFetch(linear_depth, pixel, SAMPLE).x;
    s.position = position_from_linear_depth(screen_place(pixel), depth);
    vec4 code = vec4(numbers[0], numbers[1], numbers[2], 0.0);
#if SIGN_BITS
    // The sign bit, and not a comparison: a depth of zero has a sign too.
    code[COMPONENTS] = floatBitsToUint(numbers[DEPTH]) >> 31 != 0u ? -1.0 : 1.0;
#endif
    mat3 axes = WORLD_SPACE != 0 ? mat3(view_to_world) : mat3(1.0);
    s.direction = DECODE(CODE(code), axes * s.position) * axes;
    s.albedo = vec3(numbers[ALBEDO], numbers[ALBEDO + 1], numbers[ALBEDO + 2]);
    s.specular = vec3(numbers[SPECULAR], numbers[SPECULAR + 1], numbers[SPECULAR + 2]);
    s.power = numbers[POWER];
    s.kind = int(numbers[KIND] + 0.5);
    s.instance = int(numbers[INSTANCE] + 0.5);
    s.motion = vec2(numbers[MOTION], numbers[MOTION + 1]);
    s.emissive = vec3(0.0);
    s.alpha = 1.0;
    s.layer = 0;
    return s;
}
#endif
