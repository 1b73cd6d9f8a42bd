// Where a ray meets what the screen shows. Along a straight line on the screen one over the depth of a ray, and of a plane,
// goes evenly (McGuire and Mara 2014): `near` is that number. Places are in pixels, whose centres lie at halves.
#include "frame.glsl"

uniform sampler2D ssr_near;  // of the surfaces; 0 on the background

struct Way {
    vec2 from, to;
    float near_from, near_to;
};
struct Hit {
    vec2 place;
    bool there;
    int looks;  // how often the screen was looked at
};

vec2 place_of(vec3 p) { return (p.xy / (-p.z * eye_ray.xy) * 0.5 + 0.5) * size.xy; }

// A ray from p, view space, up to the near or the far plane or the edge of the picture, whichever comes first.
Way way_of(vec3 p, vec3 direction) {
    float depth = -p.z, along = -direction.z, last = eye_ray.w;
    if (along < 0.0) last = min(last, (eye_ray.z - depth) / along);
    if (along > 0.0) last = min(last, max(eye_ray.w - depth, 0.0) / along);
    vec3 end = p + max(last, 0.0) * direction;
    Way way = Way(place_of(p), place_of(end), 1.0 / depth, -1.0 / end.z);
    vec2 over = way.to - way.from, room = mix(way.from, size.xy - way.from, greaterThan(over, vec2(0.0)));
    vec2 parts = room / max(abs(over), TINY);
    float part = clamp(min(parts.x, parts.y), 0.0, 1.0);
    return Way(way.from, way.from + part * over, way.near_from, mix(way.near_from, way.near_to, part));
}

float near_at(ivec2 pixel) { return texelFetch(ssr_near, clamp(pixel, ivec2(0), ivec2(size.xy) - 1), 0).x; }

// How a surface goes on from pixel to pixel, by the neighbour that is less far off; not at all where both are others.
float slope(float before, float here, float after) {
    float down = here - before, up = after - here, least = abs(down) < abs(up) ? down : up;
    return abs(least) > EDGE * here ? 0.0 : least;
}

// The nearest pixel's surface at a place.
float nearest_shown(vec2 place) {
    ivec2 pixel = clamp(ivec2(place), ivec2(0), ivec2(size.xy) - 1), x = ivec2(1, 0), y = ivec2(0, 1);
    float here = near_at(pixel);
    vec2 over = place - vec2(pixel) - 0.5;
    return here + over.x * slope(near_at(pixel - x), here, near_at(pixel + x)) +
           over.y * slope(near_at(pixel - y), here, near_at(pixel + y));
}

// What the screen shows at a place: between the centres of four pixels, exact for a plane; the nearest pixel's where an edge
// lies between them.
float shown_near(vec2 place) {
    vec2 corner = clamp(floor(place - 0.5), vec2(0.0), max(size.xy - 2.0, 0.0));
    vec2 share = clamp(place - 0.5 - corner, 0.0, 1.0);
    vec4 four = textureGather(ssr_near, (corner + 1.0) / size.xy);
    float least = min(min(four.x, four.y), min(four.z, four.w)), most = max(max(four.x, four.y), max(four.z, four.w));
    if (most - least > EDGE * most) return nearest_shown(place);
    return mix(mix(four.w, four.z, share.x), mix(four.x, four.y, share.x), share.y);
}

float ray_near(Way way, float part) { return mix(way.near_from, way.near_to, part); }
float shown_along(Way way, float part) { return shown_near(mix(way.from, way.to, part)); }
bool is_behind(float ray, float shown) { return ray < shown * (1.0 - ROUNDING); }

// The place between two shares of the way where it goes behind what the screen shows.
float crossing(Way way, float before, float after) {
    for (int k = 0; k < HALVINGS; ++k) {
        float middle = (before + after) * 0.5;
        bool is_late = is_behind(ray_near(way, middle), shown_along(way, middle));
        before = is_late ? before : middle;
        after = is_late ? middle : after;
    }
    return after;
}

// The last place between two where the screen shows what is nearer than this.
float last_nearer(Way way, float before, float after, float near) {
    for (int k = 0; k < HALVINGS; ++k) {
        float middle = (before + after) * 0.5;
        bool is_late = shown_along(way, middle) < near;
        before = is_late ? before : middle;
        after = is_late ? middle : after;
    }
    return before;
}

// Whether what a ray goes behind at its start is the surface that it leaves, which goes on there as it came.
bool is_own(Way way, float pixel) {
    return is_behind(ray_near(way, pixel), 2.0 * way.near_from - shown_along(way, -pixel));
}

// Where a ray goes behind something between two shares of its way, `pixels` long, if that is at most THICKNESS thick.
Hit met_between(Way way, float pixels, float before, float after) {
    float part = crossing(way, before, after);
    bool starts = part * pixels < SELF;
    // In a corner the ray meets the next pixel.
    if (starts) part = 1.0 / pixels;
    vec2 place = mix(way.from, way.to, part);
    float gap = 1.0 / ray_near(way, part) - 1.0 / shown_near(place);
    bool there = gap > 0.0 && gap <= THICKNESS && !(starts && is_own(way, part));
    return Hit(place, there, HALVINGS + 1 + int(starts));
}

// The first place where a ray goes from before a surface to behind it.
Hit meet(vec3 p, vec3 direction) {
    Way way = way_of(p, direction);
    vec2 over = abs(way.to - way.from);
    float pixels = max(max(over.x, over.y), 1.0), shown_before = way.near_from;
    int steps = clamp(int(ceil(pixels)), 1, STEPS), looks = 0;
    bool was_behind = false;
    for (int i = 1; i <= STEPS; ++i) {
        if (i > steps) break;
        float before = float(i - 1) / float(steps), after = float(i) / float(steps), shown = shown_along(way, after);
        bool behind = is_behind(ray_near(way, after), shown), crosses = behind;
        ++looks;
        // Where a surface ends between two looks the ray may have met it after the first.
        float edge = shown_before * (1.0 - EDGE), last = after;
        if (!behind && !was_behind && shown < edge) {
            last = last_nearer(way, before, after, edge);
            crosses = is_behind(ray_near(way, last), shown_along(way, last));
            looks += HALVINGS + 1;
        }
        if (crosses && !was_behind) {
            Hit found = met_between(way, pixels, before, last);
            looks += found.looks;
            if (found.there) return Hit(found.place, true, looks);
        }
        was_behind = behind;
        shown_before = shown;
    }
    return Hit(vec2(0.0), false, looks);
}
