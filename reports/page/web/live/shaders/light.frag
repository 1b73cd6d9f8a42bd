// The picture that is shown of a codec: lit by its normals, or its error, its normals or its code.
uniform ivec2 size;
uniform int shown;  // 0 lit, 1 error, 2 normals, 3 code
uniform float power;
uniform float full;  // degrees that full colour stands for
uniform float gain;  // of an error that is laid over the lit picture; 0 for none
uniform vec3 light;  // towards the light, view space
uniform highp sampler2D colours;

out vec4 colour;

vec3 lit(Surface seen, vec3 n) {
    vec3 towards_eye = -normalize(seen.view), between = normalize(light + towards_eye);
    float diffuse = max(dot(n, light), 0.0), specular = pow(max(dot(n, between), 0.0), power);
    vec3 linear = seen.colour * (0.25 + 0.75 * diffuse) + vec3(diffuse > 0.0 ? 0.8 * specular : 0.0);
    return pow(min(linear, vec3(1.0)), vec3(1.0 / 2.2));
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    Surface seen = surface_at(pixel, size);
    if (!seen.covered) {
        colour = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
#ifdef EXACT
    vec3 n = seen.n;
    vec3 code = vec3(0.0);
#else
    CODE stored = code_at(pixel);
    vec3 n = DECODE(stored, seen.view);
    vec3 code = PADDED(stored * 0.5 + 0.5).xyz;
#endif
    float degrees = degrees(angle_between(seen.n, n));
    vec3 made = shown == 0 ? lit(seen, n) : shown == 1 ? false_colour(colours, degrees / full)
        : shown == 2 ? n * 0.5 + 0.5 : code;
    colour = vec4(shown == 0 && gain > 0.0 ? mix(made, false_colour(colours, degrees / full), gain) : made, 1.0);
}
