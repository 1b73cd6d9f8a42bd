// The angle in each direction, by Lambert's equal-area projection: z >= 0 in the left disc, the other half in the right.
uniform ivec2 size;
uniform float full;
uniform highp sampler2D colours;

out vec4 colour;

void main() {
    vec2 at = vec2(ivec2(gl_FragCoord.xy)) + 0.5;
    float radius = float(size.y) * 0.5;
    bool away = at.x > float(size.y);
    vec2 disc = (at - vec2(away ? 3.0 * radius : radius, radius)) / radius;
    float r2 = dot(disc, disc);
    // Lambert (1772): (x, y) = (u, v) sqrt(2 - r^2), z = 1 - r^2.
    vec3 n = vec3(disc * sqrt(max(2.0 - r2, 0.0)), away ? r2 - 1.0 : 1.0 - r2);
    float off = degrees(angle_between(n, round_trip(n, vec3(0.0, 0.0, -1.0))));
    colour = r2 > 1.0 ? vec4(0.0) : vec4(false_colour(colours, off / full), 1.0);
}
