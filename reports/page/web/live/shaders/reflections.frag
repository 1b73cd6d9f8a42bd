// What a surface mirrors: stripes, a studio of soft boxes, or a picture all around. Directions are in the world's axes.
uniform highp sampler2D around;  // by longitude and latitude, with smaller levels
uniform int studio;              // which set of boxes and lamps, 3 for the room; -1 for the picture
uniform float brightness;        // that the picture is multiplied by

const float PI = 3.14159265;

struct Box {
    vec3 towards;  // its middle, unit
    vec2 half_size;  // tangents of half its angles, across and up
    float radiance;
};
const int BOXES = 4, LAMPS = 3;
// Over a bonnet: tubes in a row. Around a floor: strips above the horizon. Around a face: key, fill, rim, top.
const Box STUDIO[3 * BOXES] = Box[](
    Box(vec3(0.0, 0.8, -0.6), vec2(1.4, 0.1), 7.0), Box(vec3(0.0, 0.98, -0.199), vec2(1.4, 0.1), 7.0),
    Box(vec3(0.0, 0.98, 0.199), vec2(1.4, 0.1), 7.0), Box(vec3(0.6, 0.48, 0.64), vec2(0.3, 0.5), 3.0),
    Box(vec3(0.309, 0.156, -0.938), vec2(0.02, 0.35), 9.0), Box(vec3(-0.1, 0.156, -0.983), vec2(0.02, 0.35), 9.0),
    Box(vec3(-0.5, 0.173, -0.849), vec2(0.02, 0.35), 9.0), Box(vec3(0.0, 0.342, -0.94), vec2(0.9, 0.015), 7.0),
    Box(vec3(-0.682, 0.39, 0.619), vec2(0.4, 0.55), 6.5), Box(vec3(0.87, 0.1, 0.482), vec2(0.35, 0.6), 1.8),
    Box(vec3(0.75, 0.35, -0.561), vec2(0.2, 0.6), 8.0), Box(vec3(0.0, 0.995, -0.0998), vec2(0.6, 0.3), 3.0));
const vec4 LAMP[4 * LAMPS] = vec4[](  // place and power
    vec4(-1.5, 2.4, 1.0, 1.6), vec4(1.2, 2.6, -1.6, 1.6), vec4(0.2, 2.2, 2.0, 1.0),
    vec4(-1.6, 0.5, -3.5, 2.0), vec4(0.6, 0.7, -4.5, 2.4), vec4(2.0, 0.45, -3.0, 1.5),
    vec4(-1.8, 2.6, 2.2, 2.5), vec4(2.0, 1.6, 1.6, 1.2), vec4(0.4, 3.0, 1.2, 1.2),
    vec4(-45.0, 75.0, 50.0, 5000.0), vec4(-2.4, 3.0, 2.0, 2.5), vec4(2.4, 3.0, 2.0, 2.5));

// Parallel lines on a dome far away, smoothed over a pixel: how much of its width is light.
const float LINES = 26.0;

float light_until(float s) {
    return 0.5 * floor(s) + min(fract(s), 0.5);
}

float line_at(vec3 r) {
    return acos(clamp(r.x, -1.0, 1.0)) / PI * LINES;
}

float stripes(vec3 r, float width) {
    float s = line_at(r);
    return (light_until(s + 0.5 * width) - light_until(s - 0.5 * width)) / width;
}

// How much of GGX's slopes lies within +-h, seen from p, along one axis: the distribution's marginal is
// a^2 / (2 (x^2 + a^2)^(3/2)) (E. Heitz, Understanding the Masking-Shadowing Function, JCGT 2014).
float between(float p, float h, float a) {
    vec2 ends = vec2(h - p, h + p);
    return 0.5 * dot(ends * inversesqrt(ends * ends + a * a), vec2(1.0));
}

// Radiance from a direction, averaged over a lobe of that width, in radians.
vec3 boxes(vec3 r, float a) {
    vec3 made = vec3(0.035, 0.04, 0.05) + vec3(0.12, 0.13, 0.15) * smoothstep(-0.5 - a, 0.9 + a, r.y);
    for (int i = 0; i < BOXES; ++i) {
        Box box = STUDIO[studio * BOXES + i];
        float ahead = dot(r, box.towards);
        if (ahead > 0.0) {
            vec3 across = normalize(vec3(box.towards.z, 0.0, -box.towards.x)), up = cross(box.towards, across);
            vec2 p = vec2(dot(r, across), dot(r, up)) / ahead;
            made += box.radiance * between(p.x, box.half_size.x, a) * between(p.y, box.half_size.y, a);
        }
    }
    return made;
}

// The studio of gbuffer/environment, set 3: a room around everything, with soft boxes, tubes and a grid on its walls.
struct Lamp {
    int axis;     // of the wall's normal
    float side;   // -1 or 1
    vec4 placed;  // its middle and half its size, along the wall's other two axes, in metres
    float edge;   // how far its light fades inwards
    vec3 light;
};
const int ROOM_SET = 3, ROOM_LAMPS = 11;
const vec3 ROOM = vec3(3.0, 2.0, 3.0), WALLS = vec3(0.055, 0.055, 0.06), CORNERS = vec3(0.02, 0.02, 0.022), FLOOR = vec3(0.09, 0.088, 0.085);
const vec3 GRID = vec3(0.7, 0.72, 0.75);
const float MESH = 0.25, LINE = 0.04;
const Lamp ROOM_LIT[ROOM_LAMPS] = Lamp[](
    Lamp(1, 1.0, vec4(0.0, 0.9, 1.3, 0.75), 0.3, vec3(12.0, 11.8, 11.4)), Lamp(1, 1.0, vec4(0.0, -1.4, 1.8, 0.22), 0.1, vec3(9.0, 9.2, 9.6)),
    Lamp(0, -1.0, vec4(0.25, 0.3, 1.1, 1.3), 0.45, vec3(7.5, 6.9, 6.0)), Lamp(0, 1.0, vec4(0.3, 0.9, 1.3, 0.3), 0.12, vec3(8.0, 9.0, 10.5)),
    Lamp(2, 1.0, vec4(-2.4, 0.35, 0.05, 1.2), 0.03, vec3(20.0)), Lamp(2, 1.0, vec4(-2.0, 0.35, 0.05, 1.2), 0.03, vec3(20.0)),
    Lamp(2, 1.0, vec4(2.0, 0.35, 0.05, 1.2), 0.03, vec3(20.0)), Lamp(2, 1.0, vec4(2.4, 0.35, 0.05, 1.2), 0.03, vec3(20.0)),
    Lamp(2, -1.0, vec4(0.0, 0.3, 2.0, 0.04), 0.03, vec3(14.0, 14.5, 15.0)), Lamp(2, -1.0, vec4(0.0, 0.75, 2.0, 0.04), 0.03, vec3(14.0, 14.5, 15.0)),
    Lamp(2, -1.0, vec4(0.0, 1.2, 2.0, 0.04), 0.03, vec3(14.0, 14.5, 15.0)));

vec2 along_wall(vec3 r, int axis) {
    return axis == 0 ? r.yz : axis == 1 ? r.xz : r.xy;
}

// The lit share of a lobe around p, all in metres where the wall is that far away.
float lit_share(vec2 p, vec2 half_size, float a, float away) {
    return between(p.x / away, half_size.x / away, a) * between(p.y / away, half_size.y / away, a);
}

// The share of a width that lines take, which are MESH apart.
float lines_until(float s) {
    return LINE * (floor(s / MESH) + clamp((mod(s, MESH) - 0.5 * (MESH - LINE)) / LINE, 0.0, 1.0));
}

vec3 room(vec3 r, float a) {
    vec3 reached = abs(r) / ROOM, place = r / max(max(reached.x, reached.y), reached.z), near = abs(place) / ROOM;
    float second = max(min(near.x, near.y), min(max(near.x, near.y), near.z)), width = max(2.0 * a * ROOM.z, 0.02);
    vec3 made = mix(mix(WALLS, FLOOR, smoothstep(1.4, 2.0, -place.y)), CORNERS, smoothstep(0.3 - a, 1.0 + a, second));
    if (r.z > 0.0) {
        vec2 p = r.xy * ROOM.z / r.z + 0.5 * MESH, lines = vec2(lines_until(p.x + 0.5 * width), lines_until(p.y + 0.5 * width));
        lines = clamp((lines - vec2(lines_until(p.x - 0.5 * width), lines_until(p.y - 0.5 * width))) / width, 0.0, 1.0);
        made += GRID * (lines.x + lines.y - lines.x * lines.y) * lit_share(p - vec2(0.5 * MESH, 0.365 + 0.5 * MESH), vec2(1.52, 1.635), a, ROOM.z);
    }
    for (int i = 0; i < ROOM_LAMPS; ++i) {
        Lamp lamp = ROOM_LIT[i];
        float ahead = r[lamp.axis] * lamp.side, away = ROOM[lamp.axis];
        vec2 half_size = lamp.placed.zw - 0.5 * lamp.edge;
        if (ahead > 0.0) {
            made += lamp.light * lit_share(along_wall(r, lamp.axis) * away / ahead - lamp.placed.xy, half_size, max(a, 0.25 * lamp.edge / away), away);
        }
    }
    return made;
}

// What a matt surface gets of the room, over pi: each lamp as if it were small.
vec3 scattered_in_room(vec3 n) {
    vec3 made = mix(WALLS, FLOOR, 0.5 - 0.5 * n.y);
    for (int i = 0; i < ROOM_LAMPS; ++i) {
        Lamp lamp = ROOM_LIT[i];
        vec2 p = lamp.placed.xy, size = 2.0 * lamp.placed.zw - lamp.edge;
        float away = lamp.side * ROOM[lamp.axis];
        vec3 place = lamp.axis == 0 ? vec3(away, p) : lamp.axis == 1 ? vec3(p.x, away, p.y) : vec3(p, away), l = normalize(place);
        float angle = size.x * size.y * abs(l[lamp.axis]) / dot(place, place);
        made += lamp.light * angle * max(dot(n, l) * 0.8 + 0.2, 0.0) / PI;
    }
    return made;
}

vec3 picture(vec3 r, float a) {
    float texel = 2.0 * PI / float(textureSize(around, 0).x);
    vec2 at = vec2(atan(r.x, -r.z) / (2.0 * PI) + 0.5, acos(clamp(r.y, -1.0, 1.0)) / PI);
    return brightness * textureLod(around, at, max(log2(2.0 * a / texel), 0.0)).rgb;
}

vec3 surroundings(vec3 r, float a) {
    return studio < 0 ? picture(r, a) : studio == ROOM_SET ? room(r, a) : boxes(r, a);
}

// What a matt surface gets of it all, over pi: each box's solid angle, as if it were small.
vec3 scattered(vec3 n) {
    if (studio < 0) {
        return picture(n, 0.9);
    }
    if (studio == ROOM_SET) {
        return scattered_in_room(n);
    }
    vec3 made = vec3(0.035, 0.04, 0.05) + vec3(0.12, 0.13, 0.15) * smoothstep(-1.0, 1.0, n.y);
    for (int i = 0; i < BOXES; ++i) {
        Box box = STUDIO[studio * BOXES + i];
        vec2 h = box.half_size, sines = h * inversesqrt(1.0 + h * h);
        made += box.radiance * 4.0 * asin(sines.x * sines.y) * max(dot(n, box.towards) * 0.8 + 0.2, 0.0) / PI;
    }
    return made;
}

// How much of the surroundings comes back: scale and offset of F0 (B. Karis, Physically Based Shading on Mobile, 2014).
vec2 share_of_surroundings(float roughness, float n_v) {
    vec4 r = roughness * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    return vec2(-1.04, 1.04) * (min(r.x * r.x, exp2(-9.28 * n_v)) * r.x + r.y) + r.zw;
}

// GGX with the height-correlated Smith term and Schlick's Fresnel term, times n.l. |n x h|^2 is exact where 1 - (n.h)^2 is not.
vec3 ggx(vec3 n, vec3 v, vec3 l, float roughness, vec3 f0) {
    vec3 h = normalize(v + l), across = cross(n, h);
    float a = max(roughness, 0.045) * max(roughness, 0.045), a2 = a * a;
    float n_l = max(dot(n, l), 0.0), n_v = max(dot(n, v), 1e-3), n_h = dot(n, h);
    float d_root = dot(across, across) + n_h * n_h * a2, d = n_h > 0.0 ? a2 / (PI * d_root * d_root) : 0.0;
    float smith = 0.5 / (n_l * sqrt(n_v * n_v * (1.0 - a2) + a2) + n_v * sqrt(n_l * n_l * (1.0 - a2) + a2));
    float away = 1.0 - max(dot(v, h), 0.0), away2 = away * away;
    return d * smith * n_l * (f0 + (1.0 - f0) * away2 * away2 * away);
}
