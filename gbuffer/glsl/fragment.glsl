// The surface under a fragment of geometry: its material, its normal map.
#include "frame.glsl"
#include "instance.glsl"
#include "material.glsl"

in vec3 position;
in vec3 normal;
in vec4 tangent;
in vec2 uv;
flat in int index;

#if METAL_ROUGH
#if HAS_MAPS
in vec2 places[MAP_COUNT];
flat in vec4 map_strengths;  // of normals, of occlusion; whether there is a normal map, any map
flat in int mirrors;         // for each map two bits: whether it is mirrored beyond its sides along u, along v
uniform sampler2D base_map, rough_metal_map, normal_map, occlusion_map, emission_map;

// A map over a pixel's footprint: taps along its longer side, each as wide as its shorter one. By hand: software devices
// take a hundred times as long, and all devices do it in ways of their own. What is mirrored is folded here.
vec4 looked_up(sampler2D pictures, int map) {
    vec2 place = places[map], dx = dFdx(place), dy = dFdy(place), size = vec2(textureSize(pictures, 0));
    float x = length(dx * size), y = length(dy * size), least = max(min(x, y), TINY);
    vec2 major = x > y ? dx : dy, minor = x > y ? dy : dx;
    int mirror = mirrors >> (2 * map), taps = int(clamp(ceil(min(max(x, y), 1.0 / TINY) / least), 1.0, MOST_TAPS));
    // A pixel that covers less than a texel needs one.
    if (max(x, y) <= 1.0) taps = 1;
    // Where the footprint is longer than all taps are wide each becomes wider.
    minor *= max(max(x, y) / (least * float(taps)), 1.0);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < taps; ++i) {
        vec2 at = place + major * ((float(i) + 0.5) / float(taps) - 0.5), folded = 1.0 - abs(mod(at, 2.0) - 1.0);
        at = vec2((mirror & 1) != 0 ? folded.x : at.x, (mirror & 2) != 0 ? folded.y : at.y);
        sum += textureGrad(pictures, at, minor, minor);
    }
    return sum / float(taps);
}

// What pictures make of a material.
void take_maps(inout Surface s, float side) {
    // The front's frame: a bump is a hollow from behind.
    vec3 n = side * s.direction;
    vec4 colour = looked_up(base_map, BASE_MAP), rough_metal = looked_up(rough_metal_map, ROUGH_METAL_MAP);
    s.base *= colour.rgb;
    s.alpha *= colour.a;
    s.roughness *= rough_metal.g;
    s.metalness *= rough_metal.b;
    s.emissive *= looked_up(emission_map, EMISSION_MAP).rgb;
    s.occlusion = 1.0 + map_strengths.y * (looked_up(occlusion_map, OCCLUSION_MAP).r - 1.0);
    vec3 along = looked_up(normal_map, NORMAL_MAP).xyz * 2.0 - 1.0;
    if (map_strengths.z > 0.0) {
        vec3 t = unit(tangent.xyz - n * dot(n, tangent.xyz)), b = tangent.w * cross(n, t);
        // Against v: in glTF's pictures v goes down, and the map's y up.
        s.direction = side * unit(map_strengths.x * (along.x * t - along.y * b) + along.z * n);
    }
}
#endif

// A metal/rough material where the fragment lies.
void take_material(inout Surface s, Material m) {
    float side = gl_FrontFacing ? 1.0 : -1.0;
    s.base = m.albedo_alpha.rgb;
    s.alpha = m.albedo_alpha.a;
    s.metalness = m.specular_power.x;
    s.roughness = m.specular_power.y;
    s.reflectance = m.specular_power.z;
    s.emissive = m.emissive_kind.rgb;
    s.direction = side * unit(normal);
#if HAS_MAPS
    // One draw has one material: all four pixels go one way.
    if (map_strengths.w > 0.0) take_maps(s, side);
#endif
    // Before anything is left out: differences need all four pixels.
    if (SPECULAR_ANTIALIASING != 0) s.roughness = widened(s.roughness, dFdx(s.direction), dFdy(s.direction));
    if (s.alpha < m.specular_power.w) discard;
    settle(s);
}
#else
uniform sampler2D bumps;  // slopes along u and v

void take_material(inout Surface s, Material m) {
    vec3 n = unit(normal), t = unit(tangent.xyz - n * dot(n, tangent.xyz)), b = tangent.w * cross(n, t);
    vec2 slope = texture(bumps, uv).xy * m.bump.x;
    // A strand of hair runs along v. It has no sign: the half of it that faces the eye is in every encoding's domain.
    vec3 strand = b.z < 0.0 ? -b : b;
    s.direction = s.kind == HAIR ? strand : unit(n - slope.x * t - slope.y * b);
    s.albedo = s.base = m.albedo_alpha.rgb;
    s.specular = m.specular_power.rgb;
    s.emissive = m.emissive_kind.rgb;
    s.power = m.specular_power.w;
    s.alpha = m.albedo_alpha.a;
}
#endif

Surface shaded_surface() {
    ivec4 drawn = instances[index].material_layer;
    Material m = materials[drawn.x];
    vec4 then = previous_clip * vec4(position, 1.0), now = projection * vec4(position, 1.0);
    Surface s;
    s.position = position;
    s.kind = int(m.emissive_kind.w);
    s.instance = drawn.z;
    s.layer = drawn.y;
    s.motion = (now.xy / now.w - then.xy / then.w) * 0.5;
    s.power = LIGHT_PASS_POWER;
    s.occlusion = 1.0;
    s.roughness = 1.0;
    s.metalness = 0.0;
    s.reflectance = DIELECTRIC;
    take_material(s, m);
    return s;
}
