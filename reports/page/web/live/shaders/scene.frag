// What is seen at a pixel: spheres, a column, floor and walls, met by a ray. The camera turns around the middle.
uniform mat3 to_view;  // from the world's axes to the camera's
uniform vec3 eye;
uniform vec2 slope;  // of the ray at the picture's right and upper edge

const float ROOM = 4.0;
const vec3 SMOOTH = vec3(-1.05, 0.75, 0.35), DENTED = vec3(0.85, 0.95, -0.1), SMALL = vec3(0.1, 0.35, 1.25);
const vec3 RADII = vec3(0.75, 0.95, 0.35);
const vec2 COLUMN = vec2(-0.25, -0.95);
const float COLUMN_RADIUS = 0.28, COLUMN_HEIGHT = 1.9;

struct Surface {
    vec3 n;       // unit, view space
    vec3 view;    // position, view space
    vec3 colour;  // reflected light
    bool covered;
};

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

void meet(inout float nearest, inout vec3 n, inout vec3 colour, float t, vec3 towards, vec3 reflected) {
    if (t > 0.0 && t < nearest) {
        nearest = t;
        n = towards;
        colour = reflected;
    }
}

Surface surface_at(ivec2 pixel, ivec2 size) {
    vec2 screen = (vec2(pixel) + 0.5) / vec2(size) * 2.0 - 1.0;
    vec3 in_view = normalize(vec3(screen * slope, -1.0)), ray = in_view * to_view;
    // The room is met from the inside: floor and four walls, and no ceiling.
    vec3 n = vec3(0.0, 1.0, 0.0), colour = vec3(0.34);
    float nearest = ray.y < 0.0 ? -eye.y / ray.y : 1e9;
    vec2 walls = (sign(ray.xz) * ROOM - eye.xz) / ray.xz;
    meet(nearest, n, colour, walls.x, vec3(-sign(ray.x), 0.0, 0.0), vec3(0.30, 0.32, 0.36));
    meet(nearest, n, colour, walls.y, vec3(0.0, 0.0, -sign(ray.z)), vec3(0.36, 0.32, 0.30));
    for (int i = 0; i < 3; ++i) {
        vec3 middle = i == 0 ? SMOOTH : i == 1 ? DENTED : SMALL;
        vec3 reflected = i == 0 ? vec3(0.55, 0.16, 0.12) : i == 1 ? vec3(0.14, 0.32, 0.52) : vec3(0.5, 0.42, 0.12);
        float t = to_sphere(eye, ray, middle, RADII[i]);
        vec3 towards = (eye + t * ray - middle) / RADII[i];
        meet(nearest, n, colour, t, i == 1 ? dented(towards) : towards, reflected);
    }
    float t = to_column(eye, ray);
    vec2 around = (eye.xz + t * ray.xz - COLUMN) / COLUMN_RADIUS;
    meet(nearest, n, colour, t, vec3(around.x, 0.0, around.y), vec3(0.18, 0.42, 0.26));
    return Surface(normalize(to_view * n), in_view * nearest, colour, true);
}
