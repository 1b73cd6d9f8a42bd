// The picture that is shown of what came back, by SHOWN: lit, error, normals, code, zebra, studio, or how far the studio's picture is
// off, as scenes.js counts them.
uniform highp usampler2D decoded;
uniform float power;
uniform float roughness;
uniform float full;  // degrees that full colour stands for
uniform float gain;  // of an error that is laid over the picture; 0 for none
uniform float exposure;
uniform float backdrop;  // how wide the surroundings behind everything are blurred
uniform vec3 light;  // towards the light, view space
uniform mat3 to_view;
uniform vec3 eye;
uniform highp sampler2D colours;

out vec4 colour;

// Reflected light, and in w how much is mirrored head-on, 1 for metals, which mirror their colour: a picture, ground, paint, water
// and skin; then those of the scene studio: plastic, metal, paint, brushed metal, a mirror, tiles, walls and a lamp.
const vec4 MATERIALS[14] = vec4[](
    vec4(0.0), vec4(0.4, 0.4, 0.4, 0.3), vec4(0.3, 0.32, 0.36, 0.0), vec4(0.03, 0.11, 0.3, 0.35), vec4(0.05, 0.05, 0.055, 0.12),
    vec4(0.42, 0.3, 0.25, 0.06), vec4(0.55, 0.08, 0.06, 0.04), vec4(0.95, 0.93, 0.88, 1.0), vec4(0.03, 0.09, 0.28, 0.04),
    vec4(0.78, 0.78, 0.8, 1.0), vec4(0.98, 0.98, 0.98, 1.0), vec4(0.3, 0.27, 0.24, 0.04), vec4(0.42, 0.42, 0.43, 0.04),
    vec4(0.8, 0.8, 0.8, 0.04));
// From SPHERES on, nine spheres of each kind have the roughness 0 to 1; the ones behind them each have their own.
const int SPHERES = 6, ROWS = 2, SHINING = 29;
const float OWN[6] = float[](0.12, 0.3, 0.0, 0.35, 0.6, 1.0);
const float EMITTED = 50.0;
// Full colour of a difference, in steps of 8 bits; and the grey around a subject in zebra, which is its ground's.
const float DIFFERENCE = 16.0, AROUND = 0.306;

vec4 material_of(int number) {
    int behind = SPHERES + 9 * ROWS;
    return MATERIALS[number < SPHERES ? number : number < behind ? SPHERES + (number - SPHERES) / 9 : number - 8 * ROWS];
}

float roughness_of(int number) {
    int behind = SPHERES + 9 * ROWS;
    float own = number < behind ? float((number - SPHERES) % 9) / 8.0 : OWN[max(number - behind, 0)];
    return number < SPHERES ? roughness : max(roughness, own);
}

#if SHOWN == 0
vec3 lit(vec3 base, vec3 n, vec3 v) {
    vec3 between = normalize(light + v);
    float diffuse = max(dot(n, light), 0.0), specular = pow(max(dot(n, between), 0.0), power);
    return base * (0.25 + 0.75 * diffuse) + vec3(diffuse > 0.0 ? 0.8 * specular : 0.0);
}
#elif SHOWN > 4
// All in the world's axes. `blur` is a pixel's share of the mirrored lobe's width.
vec3 in_studio(int number, vec3 n, vec3 v, vec3 place, float blur) {
    vec4 material = material_of(number);
    bool is_metal = material.w == 1.0;
    vec3 mirrored = is_metal ? material.rgb : vec3(material.w), matt = is_metal ? vec3(0.0) : material.rgb;
    float roughness = roughness_of(number), n_v = max(dot(n, v), 1e-3), a = roughness * roughness;
    // A mirrored direction moves by twice the half vector's angle in the plane of both, and by n.v times that across it (J. Wang
    // et al., All-Frequency Rendering of Dynamic, Spatially-Varying Reflectance, 2009): here by their geometric mean.
    float width = sqrt(4.0 * a * a * n_v + blur * blur);
    vec2 share = share_of_surroundings(roughness, n_v);
    vec3 made = surroundings(reflect(-v, n), width) * (mirrored * share.x + share.y);
    made += matt * (1.0 - mirrored) * scattered(n) + (number == SHINING ? EMITTED : 0.0);
    for (int i = 0; i < LAMPS && studio >= 0; ++i) {
        vec4 lamp = LAMP[studio * LAMPS + i];
        vec3 apart = lamp.xyz - place, l = normalize(apart);
        float power = lamp.w / dot(apart, apart);
        made += power * (matt * max(dot(n, l), 0.0) / PI + ggx(n, v, l, roughness, mirrored));
    }
    return made;
}

// A. Narkowicz, ACES Filmic Tone Mapping Curve, 2016.
vec3 on_screen(vec3 x) {
    x *= exposure;
    return clamp(x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14), 0.0, 1.0);
}
#endif

vec3 displayed(vec3 light) {
    return pow(min(light, vec3(1.0)), vec3(1.0 / 2.2));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface seen = surface_at(pixel);
    uvec4 found = texelFetch(decoded, pixel, 0);
    vec3 n = uintBitsToFloat(found.xyz), v = -normalize(seen.view), made = vec3(0.0);
    vec4 material = material_of(seen.material);
#if SHOWN == 0
    made = lit(material.rgb, n, v);
#elif SHOWN == 2
    made = n * 0.5 + 0.5;
#elif SHOWN == 3
    made = vec3((found.www >> uvec3(0u, 10u, 20u)) & 1023u) / 1023.0;
#elif SHOWN > 3
    // How far the exact reflection moves to the next pixel: what is mirrored is smoothed over that, for every codec.
    vec3 exact = reflect(-v, seen.n) * to_view, mirror = normalize(n) * to_view, eyeward = v * to_view;
#if SHOWN == 4
    float share = stripes(reflect(-eyeward, mirror), clamp(fwidth(line_at(exact)), 1e-4, 4.0));
    made = mix(material.rgb * 0.25 + 0.02, material.rgb * 0.3 + 0.62, material.w > 0.0 ? share : 0.3);
#else
    float blur = clamp(0.5 * length(fwidth(exact)), 1e-4, 0.2);
    vec3 place = eye + seen.view * to_view;
    made = on_screen(seen.covered ? in_studio(seen.material, mirror, eyeward, place, blur) : surroundings(ray_at(pixel) * to_view, backdrop));
#if SHOWN == 6
    vec3 off = abs(displayed(made) - displayed(on_screen(in_studio(seen.material, normalize(seen.n) * to_view, eyeward, place, blur)))) * 255.0;
    made = false_colour(colours, max(max(off.r, off.g), off.b) / DIFFERENCE);
#endif
#endif
#endif
#if SHOWN != 2 && SHOWN != 3 && SHOWN != 6
    made = displayed(made);
#endif
#if SHOWN != 5
    made = seen.covered ? made : SHOWN == 4 ? displayed(vec3(AROUND)) : vec3(0.0);
#endif
    bool over = gain > 0.0 && SHOWN != 2 && SHOWN != 3 && SHOWN != 6;
    if (seen.covered && (SHOWN == 1 || over)) {
        vec3 error = false_colour(colours, degrees(angle_between(seen.n, n)) / full);
        made = SHOWN == 1 ? error : mix(made, error, gain);
    }
    colour = vec4(made, 1.0);
}
