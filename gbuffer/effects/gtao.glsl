// A slice of ground-truth ambient occlusion (Jimenez et al. 2016): a plane through the line of sight, where angles t are
// counted from V, which points to the eye. tests/gbuffer/test_ambient_occlusion.py holds it to the integrals.
#include "elementary.glsl"

struct Slice {
    vec3 across;         // o: unit, in the plane, at right angles to V
    vec3 axis, slide;    // unit, at right angles to the plane; a step of 1 along it that stays in the tangent plane of n
    vec2 on_screen;      // unit: where the screen shows the plane, on the side that o points to
    float share;         // |m|, the length of the normal's projection m on the plane
    float cos_g, sin_g;  // of the angle from V to m
};

// Slices are evenly spaced around V. XeGTAO spaces them evenly on the screen, d = (cos phi, sin phi, 0) and o = d - (d.V) V,
// which is the same in the middle of the picture only: 45 degrees from there the mean of open slices is up to 0.14 off.
Slice slice_at(float phi, vec3 n, vec3 v) {
    vec3 right = unit(vec3(v.z, 0.0, -v.x)), o = cos(phi) * right + sin(phi) * cross(v, right);
    // The way that P + t o goes on the screen, from P / -P.z for P = -V.
    vec2 d = unit(o.xy - o.z * v.xy / v.z);
    // m = (n.o) o + (n.V) V; a surface that is seen has n.V > 0, a bumpy or smoothed normal may not
    vec2 m = vec2(dot(n, o), max(dot(n, v), TINY));
    float share = length(m);
    // u = axis - (axis.n) n, over u.axis = |m|^2
    vec3 axis = cross(o, v), slide = (axis - dot(axis, n) * n) / max(share * share, TINY);
    return Slice(o, axis, slide, d, share, m.y / share, m.x / share);
}

// A way from P in the plane. Rounded to a texel a tap lies a little out of it: it is moved there at its height over the
// tangent plane of n, so that a plane's taps stay on its open horizon and none depends on n by a threshold.
vec3 into_slice(Slice s, vec3 way) { return way - dot(way, s.axis) * s.slide; }

// The angle that has this cosine, from 0 to pi, by an arc tangent that keeps the digits of a float.
float angle_of(float cosine) { return PI * atan2_pi(sqrt(max(1.0 - cosine * cosine, 0.0)), cosine); }

// The cosines of the horizons, on the side that o points away from and the one that it points to, if nothing occludes:
// of g - pi/2 and of g + pi/2.
vec2 open_horizons(Slice s) { return vec2(s.sin_g, -s.sin_g); }

// The integral of cos(t - g) |sin t| from 0 to h: a(h) = (cos g + 2 h sin g - cos(2h - g)) / 4; h has this cosine and this
// sign.
float arc(Slice s, float cosine, float side) {
    float h = side * angle_of(cosine), sine = side * sqrt(max(1.0 - cosine * cosine, 0.0));
    float double_cosine = (2.0 * cosine * cosine - 1.0) * s.cos_g + 2.0 * sine * cosine * s.sin_g;
    return (s.cos_g + 2.0 * h * s.sin_g - double_cosine) / 4.0;
}

// |m| (a(h0) + a(h1)): its mean over all slices is the visibility, and 1 for open horizons whatever the normal and V.
float slice_visibility(Slice s, vec2 horizons) {
    return s.share * (arc(s, horizons.x, -1.0) + arc(s, horizons.y, 1.0));
}

// The sum of the directions between the horizons, each times cos(t - g) |sin t|: t0 along o, t1 along V.
vec3 slice_bent_normal(Slice s, vec2 horizons, vec3 v) {
    float h0 = -angle_of(horizons.x), h1 = angle_of(horizons.y), g = PI * atan2_pi(s.sin_g, s.cos_g);
    float t0 = (6.0 * sin(h0 - g) - sin(3.0 * h0 - g) + 6.0 * sin(h1 - g) - sin(3.0 * h1 - g) + 16.0 * sin(g) -
                3.0 * (sin(h0 + g) + sin(h1 + g))) / 12.0;
    float t1 = (-cos(3.0 * h0 - g) - cos(3.0 * h1 - g) + 8.0 * cos(g) - 3.0 * (cos(h0 + g) + cos(h1 + g))) / 12.0;
    return s.share * (t0 * s.across + t1 * v);
}
