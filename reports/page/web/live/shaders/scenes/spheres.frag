// Spheres, a column, floor and walls. The camera turns around the middle.
const float ROOM = 4.0;
const vec3 SMOOTH = vec3(-1.05, 0.75, 0.35), DENTED = vec3(0.85, 0.95, -0.1), SMALL = vec3(0.1, 0.35, 1.25);
const vec3 RADII = vec3(0.75, 0.95, 0.35);
const vec2 COLUMN = vec2(-0.25, -0.95);
const float COLUMN_RADIUS = 0.28, COLUMN_HEIGHT = 1.9;

// The distance to a sphere, or a negative number.
float to_sphere(vec3 from, vec3 ray, vec3 middle, float radius) {
    vec3 apart = from - middle;
    float b = dot(apart, ray), root = b * b - dot(apart, apart) + radius * radius;
    return root < 0.0 ? -1.0 : -b - sqrt(root);
}

float to_column(vec3 from, vec3 ray) {
    vec2 apart = from.xz - COLUMN;
    float a = dot(ray.xz, ray.xz), b = dot(apart, ray.xz);
    float root = b * b - a * (dot(apart, apart) - COLUMN_RADIUS * COLUMN_RADIUS);
    float t = root < 0.0 ? -1.0 : (-b - sqrt(root)) / a, y = from.y + t * ray.y;
    return y < COLUMN_HEIGHT ? t : -1.0;
}

// Waves that are fixed to the sphere, so that they turn with it.
vec3 dented(vec3 n) {
    return normalize(n + 0.22 * sin(9.0 * n.yzx) * cos(7.0 * n.zxy));
}

void meet(inout Hit nearest, float t, vec3 n, int material) {
    if (t > 0.0 && t < nearest.t) {
        nearest = Hit(t, n, material);
    }
}

Hit met(vec3 ray) {
    // The room is met from the inside: floor and four walls, and no ceiling.
    Hit nearest = Hit(ray.y < 0.0 ? -eye.y / ray.y : 1e9, vec3(0.0, 1.0, 0.0), 2);
    vec2 walls = (sign(ray.xz) * ROOM - eye.xz) / ray.xz;
    meet(nearest, walls.x, vec3(-sign(ray.x), 0.0, 0.0), 2);
    meet(nearest, walls.y, vec3(0.0, 0.0, -sign(ray.z)), 3);
    for (int i = 0; i < 3; ++i) {
        vec3 middle = i == 0 ? SMOOTH : i == 1 ? DENTED : SMALL;
        float t = to_sphere(eye, ray, middle, RADII[i]);
        vec3 towards = (eye + t * ray - middle) / RADII[i];
        meet(nearest, t, i == 1 ? dented(towards) : towards, 4 + i);
    }
    float t = to_column(eye, ray);
    vec2 around = (eye.xz + t * ray.xz - COLUMN) / COLUMN_RADIUS;
    meet(nearest, t, vec3(around.x, 0.0, around.y), 7);
    return nearest;
}
