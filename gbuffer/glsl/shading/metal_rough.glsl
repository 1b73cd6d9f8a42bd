// How metal/rough surfaces answer light (glTF 2.0, appendix B): GGX with height-correlated Smith and Schlick, Lambert
// below, and what the single lobe loses between its facets given back. Constants come from materials.py.
#include "vec.glsl"
#include "surface.glsl"

uniform sampler2D dfg;  // rows: roughness; columns: the root of n.v; both from 0 to 1

// The two colours of a metal/rough surface.
void settle(inout Surface s) {
    s.albedo = s.base * (1.0 - s.metalness);
    s.specular = mix(vec3(s.reflectance), s.base, s.metalness);
}

float facing(vec3 n, vec3 v) { return clamp(dot(n, v), LEAST_FACING, 1.0); }

// (scale, bias): a surface of reflectance F0 reflects F0 scale + bias of even light, by single scattering. Bilinear by
// hand: a device's own weights have eight bits.
vec2 split_sum(float n_v, float roughness) {
    ivec2 last = textureSize(dfg, 0) - 1;
    vec2 place = clamp(vec2(sqrt(n_v), roughness), 0.0, 1.0) * vec2(last), corner = min(floor(place), vec2(last - 1));
    vec2 share = place - corner;
    ivec2 at = ivec2(corner);
    vec2 low = mix(texelFetch(dfg, at, 0).xy, texelFetch(dfg, at + ivec2(1, 0), 0).xy, share.x);
    vec2 high = mix(texelFetch(dfg, at + ivec2(0, 1), 0).xy, texelFetch(dfg, at + ivec2(1, 1), 0).xy, share.x);
    return mix(low, high, share.y);
}

// D = a^2 / (pi ((n.h)^2 (a^2 - 1) + 1)^2), the bracket as (n.h)^2 a^2 + |n x h|^2, which does not cancel
float distribution(vec3 n, vec3 h, float a) {
    vec3 across = cross(n, h);
    float n_h = dot(n, h), bracket = n_h * n_h * a * a + dot(across, across);
    // A normal that was decoded may face away from both.
    return n_h > 0.0 ? a * a / (PI * bracket * bracket) : 0.0;
}

// V = 0.5 / (n.l sqrt((n.v)^2 (1 - a^2) + a^2) + n.v sqrt((n.l)^2 (1 - a^2) + a^2))
float visible(float n_l, float n_v, float a) {
    float rest = 1.0 - a * a;
    return 0.5 / (n_l * sqrt(n_v * n_v * rest + a * a) + n_v * sqrt(n_l * n_l * rest + a * a));
}

// Schlick 1994: F = F0 + (1 - F0) (1 - v.h)^5
vec3 schlick(vec3 f0, float v_h) { return f0 + (1.0 - f0) * pow(max(1.0 - v_h, 0.0), 5.0); }

// What a light of brightness 1 makes of a surface: it gives an irradiance of pi, seen head on. The lobe is scaled by
// 1 + F0 (1 / Ess - 1) (Turquin 2019), and Lambert has what the lobe leaves, so that no light is lost or made.
vec3 answer(Surface s, vec3 l, vec3 v) {
    float roughness = max(s.roughness, LEAST_ROUGHNESS), a = roughness * roughness;
    float n_l = dot(s.direction, l), n_v = facing(s.direction, v);
    if (n_l <= 0.0) return vec3(0.0);
    vec3 h = unit(l + v), n = s.direction;
    vec2 sum = split_sum(n_v, roughness);
    vec3 gain = 1.0 + s.specular * (1.0 / (sum.x + sum.y) - 1.0), reflected = (s.specular * sum.x + sum.y) * gain;
    vec3 lobe = distribution(n, h, a) * visible(n_l, n_v, a) * schlick(s.specular, dot(v, h)) * gain;
    return n_l * (PI * lobe + s.albedo * (1.0 - reflected));
}

// What light from everywhere makes of a surface (Fdez-Aguera 2019): `along` is the radiance around the mirrored view, by
// the lobe's width, `even` the irradiance over pi.
vec3 answer_to_all(Surface s, vec3 v, vec3 along, vec3 even) {
    vec2 sum = split_sum(facing(s.direction, v), s.roughness);
    // FssEss = F0 scale + bias, Ems = 1 - Ess, Favg = F0 + (1 - F0) / 21, FmsEms = Ems FssEss Favg / (1 - Favg Ems)
    vec3 single = s.specular * sum.x + sum.y, average = s.specular + (1.0 - s.specular) * SCHLICK_MEAN;
    float lost = 1.0 - sum.x - sum.y;
    vec3 multiple = lost * single * average / (1.0 - average * lost);
    return single * along + (multiple + s.albedo * (1.0 - single - multiple)) * even;
}

// Roughness that what a pixel sees of normals makes of it (Tokuyoshi and Kaplanyan 2019), by differences of the normal
// between neighbouring pixels: a^2 + min(2 variance, largest), with a = roughness^2
float widened(float roughness, vec3 along_x, vec3 along_y) {
    float variance = PIXEL_VARIANCE * (dot(along_x, along_x) + dot(along_y, along_y)), a = roughness * roughness;
    return sqrt(sqrt(min(a * a + min(2.0 * variance, MOST_WIDENED), 1.0)));
}
