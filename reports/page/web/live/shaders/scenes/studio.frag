// The scene `studio` of gbuffer/scenes/built_in, by formula: two rows of spheres, panels that turn slowly, a mirror, tiles, two walls
// that are seen from inside alone, and a lamp. A test holds its normals to that scene's.
const float RADIUS = 0.33, BETWEEN = 0.7125, FIRST = -2.85;
const vec2 ROWS[2] = vec2[](vec2(0.33, 1.6), vec2(1.2, 0.6));  // y and z
// Materials, as light.frag has them; those of a row's spheres follow each other.
const int PLASTIC = 6, METAL = 15, PAINT = 24, BRUSHED = 25, MIRROR = 26, TILES = 27, WALL = 28, LAMP_BALL = 29;
const float WALL_Z = -2.5, WALL_X = -5.0;
const float CIRCLE = 6.2831853;

void meet(inout Hit nearest, float t, vec3 n, int material) {
    if (t > 0.0 && t < nearest.t) {
        nearest = Hit(t, n, material);
    }
}

void meet_ball(inout Hit nearest, vec3 ray, vec3 middle, float radius, int material) {
    vec3 apart = eye - middle;
    float b = dot(apart, ray), root = b * b - dot(apart, apart) + radius * radius;
    if (root > 0.0) {
        float t = -b - sqrt(root);
        meet(nearest, t, (apart + t * ray) / radius, material);
    }
}

// A patch of an ellipsoid: its size, and how far its normal turns across and up, in degrees; turned about y.
void meet_panel(inout Hit nearest, vec3 ray, vec3 place, vec2 sides, vec2 turns, float turned, int material) {
    float c = cos(turned), s = sin(turned);
    mat3 to_world = mat3(c, 0.0, -s, 0.0, 1.0, 0.0, s, 0.0, c);
    vec3 from = (eye - place) * to_world, along = ray * to_world;
    vec2 whole = radians(turns), angles = vec2(0.0);
    float t = -from.z / along.z;
    for (int i = 0; i < 4; ++i) {
        vec3 p = from + t * along;
        angles = p.xy / sides * whole;
        float depth = dot(-sides / whole, 1.0 - cos(angles));
        t += (depth - p.z) / along.z;
    }
    vec2 at = abs((from + t * along).xy / sides);
    vec3 n = to_world * vec3(sin(angles.x) * cos(angles.y), sin(angles.y), cos(angles.x) * cos(angles.y));
    if (max(at.x, at.y) < 0.5) {
        meet(nearest, t, dot(n, ray) > 0.0 ? -n : n, material);
    }
}

// Joints are smoothed out where a pixel covers them.
vec3 tiled(vec2 p, float covers) {
    vec2 uv = vec2(p.x / 14.0 + 0.5, 0.5 - p.y / 12.0) * 6.0, along = fract(4.0 * uv) - 0.5;
    vec2 edge = clamp((abs(along) - 0.42) / 0.08, 0.0, 1.0), reach = vec2(covers) * 24.0 / vec2(14.0, 12.0) / 0.08;
    vec2 slopes = -0.8 * sign(along) * sin(0.5 * CIRCLE * edge) * exp(-reach * reach);
    slopes.x += 0.05 * sin(CIRCLE * (3.0 * uv.x + sin(CIRCLE * uv.y) / 3.0)) + 0.02 * sin(CIRCLE * (11.0 * uv.x + 7.0 * uv.y));
    slopes.y += 0.05 * sin(CIRCLE * (2.0 * uv.y + sin(CIRCLE * uv.x) / 3.0)) + 0.02 * sin(CIRCLE * (5.0 * uv.x - 13.0 * uv.y));
    return vec3(-slopes.x, 1.0, slopes.y);
}

void meet_room(inout Hit nearest, vec3 ray) {
    float t = -eye.y / ray.y;
    vec2 p = eye.xz + t * ray.xz;
    if (ray.y < 0.0 && abs(p.x) < 7.0 && abs(p.y) < 6.0) {
        meet(nearest, t, tiled(p, t * 2.0 * slope.y / float(size.y)), TILES);
    }
    t = (WALL_Z - eye.z) / ray.z;
    vec3 back = eye + t * ray;
    if (ray.z < 0.0 && abs(back.x) < 7.0 && abs(back.y - 4.5) < 4.5) {
        meet(nearest, t, vec3(0.0, 0.0, 1.0), WALL);
    }
    t = (WALL_X - eye.x) / ray.x;
    vec3 beside = eye + t * ray;
    if (ray.x < 0.0 && abs(beside.z - 2.0) < 4.5 && abs(beside.y - 4.5) < 4.5) {
        meet(nearest, t, vec3(1.0, 0.0, 0.0), WALL);
    }
}

Hit met(vec3 ray) {
    Hit nearest = Hit(1e9, vec3(0.0), 0);
    meet_room(nearest, ray);
    for (int i = 0; i < 18; ++i) {
        vec3 middle = vec3(FIRST + BETWEEN * float(i % 9), ROWS[i / 9]);
        meet_ball(nearest, ray, middle, RADIUS, (i < 9 ? PLASTIC : METAL) + i % 9);
    }
    meet_ball(nearest, ray, vec3(4.0, 3.9, -1.2), 0.16, LAMP_BALL);
    meet_panel(nearest, ray, vec3(-2.1, 2.75, -0.9), vec2(2.4, 1.5), vec2(20.0, 8.0), 0.0, PAINT);
    meet_panel(nearest, ray, vec3(0.6, 2.75, -0.9), vec2(2.4, 1.5), vec2(4.0, 2.0), 0.0, BRUSHED);
    meet_panel(nearest, ray, vec3(3.1, 2.75, -0.9), vec2(1.4, 2.0), vec2(3.0, 3.0), -0.44, MIRROR);
    if (nearest.material == 0) {
        return NOTHING;
    }
    return nearest;
}
