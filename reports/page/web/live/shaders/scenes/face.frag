// A head on a neck. The head is an ellipsoid around the origin with smooth bumps and hollows, each a spherical Gaussian of the
// direction: a surface without an edge, whose normal is exact.
struct Bump {
    vec3 towards;  // unit
    float sharp;   // how narrow it is
    float high;    // how far the surface is moved
};
const int BUMPS = 13;
const Bump FACE[BUMPS] = Bump[](
    Bump(vec3(0.0, -0.0998, 0.995), 42.0, 0.2),       // tip of the nose
    Bump(vec3(0.0, 0.1483, 0.9889), 80.0, 0.09),      // its bridge
    Bump(vec3(0.3354, 0.1730, 0.9261), 45.0, -0.12),  // eye sockets
    Bump(vec3(-0.3354, 0.1730, 0.9261), 45.0, -0.12),
    Bump(vec3(0.3302, 0.1398, 0.9335), 150.0, 0.07),  // eyes
    Bump(vec3(-0.3302, 0.1398, 0.9335), 150.0, 0.07),
    Bump(vec3(0.0, 0.3714, 0.9285), 16.0, 0.06),      // brow
    Bump(vec3(0.0, -0.4226, 0.9063), 90.0, 0.055),    // lips
    Bump(vec3(0.0, -0.5225, 0.8526), 120.0, 0.06),
    Bump(vec3(0.0, -0.7071, 0.7071), 26.0, 0.15),     // chin
    Bump(vec3(0.5145, -0.2058, 0.8324), 12.0, 0.08),  // cheeks
    Bump(vec3(-0.5145, -0.2058, 0.8324), 12.0, 0.08),
    Bump(vec3(0.0, 0.4472, -0.8944), 3.0, 0.2));      // the back
const vec3 AXES = vec3(0.7, 0.92, 0.74), MIDDLE = vec3(0.0, 1.2, 0.0);
const float SMOOTH = 0.22, REACH = 2.2;
const int STEPS = 22;

// How far a place is from the head's surface, nearly, and the gradient of that.
vec4 head(vec3 p) {
    float far = max(length(p), 1e-3);
    vec3 d = p / far, q = d / AXES;
    float base = inversesqrt(dot(q, q));
    // Far outside, bumps do not matter yet.
    if (far > base + 0.6) {
        return vec4(d, far - base - 0.25);
    }
    // The ellipsoid's radius changes over the direction by -base^3 d / axes^2, across it.
    vec3 change = -base * base * base * q / AXES;
    float radius = base;
    for (int i = 0; i < BUMPS; ++i) {
        float e = FACE[i].high * exp(FACE[i].sharp * (dot(d, FACE[i].towards) - 1.0));
        radius += e;
        change += e * FACE[i].sharp * FACE[i].towards;
    }
    return vec4(d - (change - d * dot(d, change)) / far, far - radius);
}

vec4 ellipsoid(vec3 p, vec3 axes) {
    vec3 q = p / axes, r = q / axes;
    float a = length(q), b = max(length(r), 1e-3);
    return vec4(r / b, a * (a - 1.0) / b);
}

// Both, without a seam (I. Quilez, Smooth minimum, 2013).
vec4 joined(vec4 a, vec4 b) {
    float share = clamp(0.5 + 0.5 * (b.w - a.w) / SMOOTH, 0.0, 1.0);
    return vec4(mix(b.xyz, a.xyz, share), mix(b.w, a.w, share) - SMOOTH * share * (1.0 - share));
}

vec4 bust(vec3 p) {
    vec4 neck = ellipsoid(p - vec3(0.0, -1.0, -0.12), vec3(0.4, 1.0, 0.42));
    vec4 shoulders = ellipsoid(p - vec3(0.0, -1.95, -0.15), vec3(1.35, 0.62, 0.6));
    return joined(joined(head(p), neck), shoulders);
}

Hit met(vec3 ray) {
    vec3 from = eye - MIDDLE;
    vec3 apart = from + vec3(0.0, 0.6, 0.0);
    float b = dot(apart, ray), root = b * b - dot(apart, apart) + REACH * REACH, t = max(-b - sqrt(max(root, 0.0)), 0.0), end = -b + sqrt(max(root, 0.0));
    if (root < 0.0 || end < 0.0) {
        return NOTHING;
    }
    float left = 1.0;
    for (int i = 0; i < STEPS && t < end && abs(left) > 1e-3; ++i) {
        left = bust(from + t * ray).w;
        t += 0.85 * left;
    }
    if (t >= end || left > 0.03) {
        return NOTHING;
    }
    // One of Newton's steps, along the ray.
    vec4 found = bust(from + t * ray);
    float along = dot(found.xyz, ray);
    return Hit(along < -0.05 ? t - found.w / along : t, found.xyz, 5);
}
