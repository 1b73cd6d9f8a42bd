// How materials answer light. Every kind is albedo x D + specular x S: D and S are sums over lights, which a light
// buffer may hold, and only `light_terms` knows how a kind makes them. Kinds and constants come from materials.py.
#include "vec.glsl"
#include "surface.glsl"

struct Terms {
    float diffuse, specular;
};

// What keeps the light in a Blinn-Phong lobe under N.L the same at every power, (n + 8) / 8; hair's has no such factor.
float lobe_gain(int kind, float power) { return kind == HAIR ? 1.0 : (power + 8.0) / 8.0; }

// Blinn-Phong, normalised: (n + 8) / 8 (N.H)^n
float lobe(float cosine, float power) { return lobe_gain(GENERAL, power) * pow(max(cosine, TINY), power); }

// Schlick 1994: F = F0 + (1 - F0) (1 - V.H)^5
float fresnel(float cosine) { return COAT_F0 + (1.0 - COAT_F0) * pow(max(1.0 - cosine, 0.0), 5.0); }

// D and S for a light of brightness 1 from direction l; v points to the eye. `direction` is the surface's.
Terms light_terms(int kind, vec3 direction, vec3 l, vec3 v, float power) {
    vec3 h = unit(l + v);
    float d_l = dot(direction, l), d_h = dot(direction, h), lit = max(d_l, 0.0);
    if (kind == SKIN) {
        // Wrapped diffuse, energy kept: (N.L + w) / (1 + w)^2
        return Terms(max(d_l + SKIN_WRAP, 0.0) / ((1.0 + SKIN_WRAP) * (1.0 + SKIN_WRAP)), lit * lobe(d_h, power));
    }
    if (kind == HAIR) {
        // Kajiya and Kay 1989, the highlight by Scheuermann 2004: D = sin(T, L), S = sin(T, L) sin(T, H)^n,
        // sin(T, L) in place of N.L
        float sin_l = sqrt(max(1.0 - d_l * d_l, 0.0)), sin_h = sqrt(max(1.0 - d_h * d_h, 0.0));
        return Terms(sin_l, sin_l * pow(max(sin_h, TINY), power));
    }
    if (kind == GLOSSY) {
        // Clear coat over a metallic base: the coat's lobe by F, what passes it lights the base and its broad lobe.
        float f = fresnel(dot(v, h));
        float base = 1.0 + BASE_SHARE * lobe(d_h, BASE_POWER);
        return Terms(lit * (1.0 - f) * base, lit * f * lobe(d_h, power));
    }
    return Terms(lit, lit * lobe(d_h, power));
}

vec3 compose(Surface s, vec3 diffuse, vec3 specular) { return s.albedo * diffuse + s.specular * specular; }

// The finished colour of a surface under a light of brightness 1 from direction l.
#if METAL_ROUGH
#include "metal_rough.glsl"
vec3 lit(Surface s, vec3 l, vec3 v) { return answer(s, l, v); }
#else
vec3 lit(Surface s, vec3 l, vec3 v) {
    Terms t = light_terms(s.kind, s.direction, l, v, s.power);
    return compose(s, vec3(t.diffuse), vec3(t.specular));
}
#endif
