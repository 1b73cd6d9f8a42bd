// Numbers to the texels of a layout and back. The layout comes from layouts.py as macros: WORDS words, each a component
// (WORD_COMPONENT) in a target (WORD_TARGET), in a channel of its own (WORD_BITS 0, WORD_FIRST the channel) or as an
// integer of WORD_BITS bits from bit WORD_FIRST on; for each of TARGETS targets the kind of its format, its channels'
// scales and bits, and whether the shader rounds (one more than storage.glsl's ways). NORMAL_LEVELS says how many values
// each of the normal's numbers has, 0 for one like any other. DEPTH_RANGE is the near and the far plane. SIGN_CARRIER is
// the component that carries number SIGN_NUMBER of the normal's code as its sign, or -1; LEAST_CARRIED keeps it off 0.
// NORMAL_UNIT is 1 where texels hold the normal's numbers in [0, 1], whatever their format: half of 1 more than a code's.
// TARGET_PART is the bits of each channel that integers lie across. HAS_WORDS is 1 where targets are of whole numbers:
// TARGET_INTEGER says which.
#include "depth_code.glsl"
#include "storage.glsl"

const int word_component[] = WORD_COMPONENT, word_target[] = WORD_TARGET, word_first[] = WORD_FIRST;
const int word_bits[] = WORD_BITS, target_kind[] = TARGET_KIND, target_rounds[] = TARGET_ROUNDS;
const int target_bits[] = TARGET_BITS, normal_levels[] = NORMAL_LEVELS, target_part[] = TARGET_PART;
const float target_scale[] = TARGET_SCALE;

#if HAS_WORDS
const int target_integer[] = TARGET_INTEGER;
// What targets of whole numbers hold; the others' texels are numbers.
uvec4 target_words[TARGETS];
#endif

// Perceptual roughness and Blinn-Phong power: alpha = roughness^2, alpha^2 = 2 / (power + 2) (B. Walter et al.,
// Microfacet Models for Refraction, 2007; B. Burley, Physically Based Shading at Disney, 2012).
float roughness_of_power(float power) { return sqrt(sqrt(2.0 / (power + 2.0))); }
float power_of_roughness(float roughness) {
    float alpha = max(roughness * roughness, exp2(-LOG2_POWER_MAX * 0.5));
    return max(2.0 / (alpha * alpha) - 2.0, 0.0);
}

bool is_signed(int component) { return (component < DEPTH && NORMAL_UNIT == 0) || component >= MOTION; }
bool is_integer(int component) { return component == KIND || component == INSTANCE; }

// A number as texels hold it, and back.
float held(int component, float x) { return NORMAL_UNIT != 0 && component < DEPTH ? x * 0.5 + 0.5 : x; }
float taken(int component, float x) { return NORMAL_UNIT != 0 && component < DEPTH ? x * 2.0 - 1.0 : x; }

// A number as a fixed-point format keeps it, between 0 and 1; code scale x is the integer nearest it times `scale`.
float to_unit(int component, float x, float scale) {
    if (is_signed(component)) return x * 0.5 + 0.5;
    if (is_integer(component)) return mod(x, scale + 1.0) / scale;
    if (component == POWER && METAL_ROUGH == 0) return log2(max(x, 1.0)) / LOG2_POWER_MAX;
    if (component != DEPTH) return x;
    float number = number_of_depth(x, DEPTH_RANGE, false);
    return DEPTH_SIGNED != 0 ? float(fixed_code(number, scale, true)) / scale : number;
}

float from_unit(int component, float x, float scale) {
    if (is_signed(component)) return x * 2.0 - 1.0;
    if (is_integer(component)) return floor(x * scale + 0.5);
    if (component == POWER && METAL_ROUGH == 0) return exp2(x * LOG2_POWER_MAX);
    if (component != DEPTH) return x;
    float number = DEPTH_SIGNED != 0 ? from_fixed_code(uint(x * scale + 0.5), scale, true) : x;
    return depth_of_number(number, DEPTH_RANGE, false);
}

// A number that has a channel of its own.
float to_channel(int component, float x, int kind, float scale) {
    if (kind == 3 && is_signed(component)) return x * 0.5 + 0.5;
    if (kind >= 2) return component == DEPTH ? number_of_depth(x, DEPTH_RANGE, true) : x;
    if (kind == 0) return to_unit(component, x, scale);
    return is_signed(component) ? x : to_unit(component, x, scale);
}

float from_channel(int component, float x, int kind, float scale) {
    if (kind == 3 && is_signed(component)) return x * 2.0 - 1.0;
    if (kind >= 2) return component == DEPTH ? depth_of_number(x, DEPTH_RANGE, true) : x;
    return kind == 1 && is_signed(component) ? x : from_unit(component, x, scale);
}

// A quantity as a share of [0, 1] under a sign, sign max(share, least), as a channel keeps it; and back.
float carrying(int component, float x, float sign_carried, int kind, float scale) {
    float number = sign_not_zero(sign_carried) * max(to_unit(component, x, scale), LEAST_CARRIED);
    return kind == 0 || kind == 3 ? number * 0.5 + 0.5 : number;
}

float carried(float x, int kind) { return kind == 0 || kind == 3 ? x * 2.0 - 1.0 : x; }

// Whether a word holds the integer nearest x one, plus one, for x in [-1, 1]: then 0 is a code, as no motion must be.
bool is_around_zero(int component) {
    return component >= MOTION || (component < DEPTH && normal_levels[component] == 0 && PACK_SIGNED != 0);
}

// A number as an integer word, and back. Only the normal is packed as the layout says, all else is rounded; a depth may
// have as many bits as a float32 has, and stays an integer.
uint to_word(int component, float x, float scale) {
    if (component == DEPTH) return fixed_code(number_of_depth(x, DEPTH_RANGE, false), scale, DEPTH_SIGNED != 0);
    bool as_packed = component < DEPTH && normal_levels[component] == 0;
    float one = floor(scale * 0.5);
    if (is_around_zero(component)) return uint(roundEven(clamp(x, -1.0, 1.0) * one) + one);
    vec2 rule = as_packed ? vec2(PACK_WIDEN, PACK_BIAS) : vec2(0.0, 0.5);
    float part = clamp(to_unit(component, x, scale), 0.0, 1.0);
    return uint(min(floor(part * (scale + rule.x) + rule.y), scale));
}

float from_word(int component, uint integer, float scale) {
    float one = floor(scale * 0.5);
    if (is_around_zero(component)) return (float(integer) - one) * (1.0 / one);
    if (component != DEPTH) return from_unit(component, float(integer) / scale, scale);
    return depth_of_number(from_fixed_code(integer, scale, DEPTH_SIGNED != 0), DEPTH_RANGE, false);
}

// What each target is given.
vec4[TARGETS] to_texels(float numbers[NUMBERS]) {
    vec4 texels[TARGETS];
    uvec4 packed_bytes[TARGETS];
    for (int i = 0; i < TARGETS; ++i) {
        texels[i] = vec4(0.0);
        packed_bytes[i] = uvec4(0u);
    }
    for (int w = 0; w < WORDS; ++w) {
        int target = word_target[w], first = word_first[w], bits = word_bits[w], component = word_component[w];
        float x = held(component, numbers[component]);
        bool carries = component == SIGN_CARRIER;
        if (bits == 0) {
            int kind = target_kind[target], rounds = target_rounds[target], channel = target * 4 + first;
            float scale = target_scale[channel], texel = carries
                ? carrying(component, x, numbers[SIGN_NUMBER], kind, scale)
                : to_channel(component, x, kind, scale);
            if (rounds != 0) texel = round_number(texel, kind, scale, target_bits[channel], rounds - 1);
            texels[target][first] = texel;
        } else {
            float scale = exp2(float(bits)) - 1.0;
            uint integer = carries
                ? uint(floor(carrying(component, x, numbers[SIGN_NUMBER], 0, scale) * scale + 0.5))
                : to_word(component, x, scale);
            for (int c = 0; c < 4; ++c) packed_bytes[target][c] |= part_in(integer, first, bits, c, target_part[target]);
        }
    }
#if HAS_WORDS
    target_words = packed_bytes;
#endif
    for (int i = 0; i < TARGETS; ++i)
        for (int c = 0; c < 4; ++c) texels[i][c] += float(packed_bytes[i][c]) / target_scale[i * 4 + c];
    return texels;
}

void take_carried(int component, float x, float scale, inout float numbers[NUMBERS]) {
    numbers[SIGN_NUMBER] = sign_not_zero(x);
    numbers[component] = from_unit(component, abs(x), scale);
}

// The numbers that texels hold; those that the layout does not keep are left as they are.
void from_texels(vec4 texels[TARGETS], inout float numbers[NUMBERS]) {
    for (int w = 0; w < WORDS; ++w) {
        int target = word_target[w], first = word_first[w], bits = word_bits[w], component = word_component[w];
        bool carries = component == SIGN_CARRIER;
        if (bits == 0) {
            int kind = target_kind[target];
            float scale = target_scale[target * 4 + first], x = texels[target][first];
            if (carries) take_carried(component, carried(x, kind), scale, numbers);
            else numbers[component] = taken(component, from_channel(component, x, kind, scale));
        } else {
            uint integer = 0u;
            for (int c = 0; c < 4; ++c) {
                uint part = uint(texels[target][c] * target_scale[target * 4 + c] + 0.5);
#if HAS_WORDS
                if (target_integer[target] != 0) part = target_words[target][c];
#endif
                integer |= part_from(part, first, bits, c, target_part[target]);
            }
            float scale = exp2(float(bits)) - 1.0;
            if (carries) take_carried(component, carried(float(integer) / scale, 0), scale, numbers);
            else numbers[component] = taken(component, from_word(component, integer, scale));
        }
    }
}
