// Surfaces to the texels of a layout (`words.glsl`) and back. TO_CURVES and FROM_CURVES are what layouts.py makes of the
// curves that its numbers lie on; EMISSION_CODED is 1 where EMISSION_ENCODE makes one code of all of the emission.
#define DEPTH_RANGE eye_ray.zw
#include "sample.glsl"
#include "code.glsl"
#include "words.glsl"
#include "surface.glsl"
#include CURVES
#if METAL_ROUGH
#include "metal_rough.glsl"
#endif

#ifdef WRITES_GBUFFER
#include "dither.glsl"
#if HAS_WORDS
TEXEL_OUTPUTS
#else
layout(location = 0) out vec4 texels[TARGETS];
#endif

void write_gbuffer(Surface s) {
    float numbers[NUMBERS];
    mat3 axes = WORLD_SPACE != 0 ? mat3(view_to_world) : mat3(1.0);
    const float scales[] = NORMAL_SCALE;
    vec4 code = widen(encoded(direction_or_forward(axes * s.direction), axes * s.position, scales, NORMAL_BIASED != 0));
    code = dithered(code);
    for (int i = 0; i < DEPTH; ++i) numbers[i] = code[i];
    numbers[DEPTH] = SIGN_IN_DEPTH != 0 ? code[SIGN_NUMBER] * -s.position.z : -s.position.z;
    for (int i = 0; i < 3; ++i) {
        numbers[ALBEDO + i] = BY_METALNESS != 0 ? s.base[i] : s.albedo[i];
        numbers[SPECULAR + i] = s.specular[i];
        numbers[EMISSION + i] = s.emissive[i];
    }
    // A layout that has a place for a power, and none for a roughness, has the roughness of a metal/rough surface there.
    numbers[POWER] = METAL_ROUGH != 0 ? s.roughness : s.power;
    numbers[ROUGHNESS] = METAL_ROUGH != 0 ? s.roughness : roughness_of_power(s.power);
    numbers[METALNESS] = s.metalness;
    numbers[REFLECTANCE] = s.reflectance;
    numbers[OCCLUSION] = s.occlusion;
    numbers[KIND] = float(s.kind);
    numbers[INSTANCE] = float(s.instance);
    numbers[MOTION] = s.motion.x;
    numbers[MOTION + 1] = s.motion.y;
    TO_CURVES
#if EMISSION_CODED
    vec4 light = EMISSION_ENCODE(light_or_none(vec4(s.emissive, 0.0)));
    for (int i = 0; i < 4; ++i) numbers[EMISSION + i] = light[i];
#endif
#if HAS_WORDS
    vec4 texels[TARGETS] = to_texels(numbers);
    TEXEL_WRITES
#else
    texels = to_texels(numbers);
#endif
}
#else
#if HAS_WORDS
#if PLAIN_TARGETS
uniform SAMPLER gbuffer[PLAIN_TARGETS];
#endif
uniform WORD_SAMPLER gbuffer_words[WORD_TARGETS];
#else
uniform SAMPLER gbuffer[TARGETS];
#endif
uniform SAMPLER linear_depth;
#if PLACED
uniform sampler2D places;
#define PLACE_OF(pixel) texelFetch(places, pixel, 0).xy
#else
#define PLACE_OF(pixel) screen_place(pixel)
#endif

// The surface in a pixel's sample. What the layout does not keep is left at a general material's default.
Surface read_gbuffer(ivec2 pixel) {
    vec4 texels[TARGETS];
#if HAS_WORDS
    for (int i = 0; i < TARGETS; ++i) texels[i] = vec4(0.0);
    TEXEL_READS
#else
    for (int i = 0; i < TARGETS; ++i) texels[i] = texelFetch(gbuffer[i], pixel, SAMPLE);
#endif
    float numbers[NUMBERS];
    for (int i = 0; i < NUMBERS; ++i) numbers[i] = 0.0;
    numbers[POWER] = LIGHT_PASS_POWER;
    numbers[REFLECTANCE] = DIELECTRIC;
    numbers[OCCLUSION] = 1.0;
    from_texels(texels, numbers);
    FROM_CURVES
#if EMISSION_CODED
    vec4 light = EMISSION_DECODE(vec4(numbers[EMISSION], numbers[EMISSION + 1], numbers[EMISSION + 2], numbers[EMISSION + 3]));
    for (int i = 0; i < 3; ++i) numbers[EMISSION + i] = light[i];
#endif
    Surface s;
    float depth = HAS_DEPTH != 0 ? abs(numbers[DEPTH]) : texelFetch(linear_depth, pixel, SAMPLE).x;
    s.position = position_from_linear_depth(PLACE_OF(pixel), depth, eye_ray.xy);
    vec4 code = vec4(numbers[0], numbers[1], numbers[2], 0.0);
#if SIGN_IN_DEPTH
    // The sign bit, and not a comparison: a depth of zero has a sign too.
    code[SIGN_NUMBER] = sign_bit(numbers[DEPTH]) ? -1.0 : 1.0;
#endif
    mat3 axes = WORLD_SPACE != 0 ? mat3(view_to_world) : mat3(1.0);
    s.direction = DECODE(CODE(code), axes * s.position) * axes;
    s.albedo = vec3(numbers[ALBEDO], numbers[ALBEDO + 1], numbers[ALBEDO + 2]);
    s.specular = vec3(numbers[SPECULAR], numbers[SPECULAR + 1], numbers[SPECULAR + 2]);
    s.power = HAS_ROUGHNESS != 0 ? power_of_roughness(numbers[ROUGHNESS]) : numbers[POWER];
    s.roughness = clamp(HAS_ROUGHNESS != 0 ? numbers[ROUGHNESS] : numbers[POWER], 0.0, 1.0);
    s.base = s.albedo;
    s.metalness = clamp(numbers[METALNESS], 0.0, 1.0);
    s.reflectance = numbers[REFLECTANCE];
#if BY_METALNESS
    settle(s);
#endif
    s.kind = int(numbers[KIND] + 0.5);
    s.instance = int(numbers[INSTANCE] + 0.5);
    s.motion = vec2(numbers[MOTION], numbers[MOTION + 1]);
    s.emissive = vec3(numbers[EMISSION], numbers[EMISSION + 1], numbers[EMISSION + 2]);
    s.occlusion = numbers[OCCLUSION];
    s.alpha = 1.0;
    s.layer = 0;
    return s;
}
#endif
