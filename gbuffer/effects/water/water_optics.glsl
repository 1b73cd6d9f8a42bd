// What happens to light at water and in it. INDEX is water's refractive index.

// The share of unpolarised light that is reflected, of the cosine of the angle to the normal.
float exact_fresnel(float cosine) {
    // F = ((g - c) / (g + c))^2 (1 + ((c (g + c) - 1) / (c (g - c) + 1))^2) / 2, g^2 = n^2 - 1 + c^2
    // (Cook and Torrance 1982, after Fresnel)
    float c = clamp(cosine, 0.0, 1.0), g = sqrt(INDEX * INDEX - 1.0 + c * c);
    float across = (g - c) / (g + c), along = (c * (g + c) - 1.0) / (c * (g - c) + 1.0);
    return 0.5 * across * across * (1.0 + along * along);
}

float schlick_fresnel(float cosine) {
    // F = F0 + (1 - F0) (1 - c)^5, F0 = ((n - 1) / (n + 1))^2 (Schlick 1994)
    float f0 = (INDEX - 1.0) / (INDEX + 1.0), c = 1.0 - clamp(cosine, 0.0, 1.0);
    return f0 * f0 + (1.0 - f0 * f0) * c * c * c * c * c;
}

float water_fresnel(float cosine) { return EXACT_FRESNEL != 0 ? exact_fresnel(cosine) : schlick_fresnel(cosine); }

// The share of light that is left after so many metres: T = exp(-k d) (Beer and Lambert).
vec3 transmittance(vec3 extinction, float metres) { return exp(-extinction * metres); }
