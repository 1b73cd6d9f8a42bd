// The discontinuity-sensitive filter (Kircher and Lawrance 2009): light from a smaller buffer, of the four nearest texels
// those of the same surface. Bilinear weights times a match in depth, instance and normal, divided by their sum; the
// nearest texel where none matches. `accumulation.glsl` is included before.
#include "gbuffer.glsl"

float match(Surface s, Surface tap) {
    bool same = abs(tap.position.z - s.position.z) < FILTER_DEPTH * -s.position.z;
#if HAS_INSTANCE
    same = same && tap.instance == s.instance;
#endif
    return same && dot(tap.direction, s.direction) > FILTER_COSINE ? 1.0 : 0.0;
}

Accumulated filtered_light(Surface s) {
    vec2 place = gl_FragCoord.xy / target_size.xy * size.xy - 0.5, corner = floor(place), share = place - corner;
    Accumulated sum = Accumulated(vec4(0.0), vec4(0.0)), even = sum, nearest = sum;
    float total = 0.0, matches = 0.0, closest = -1.0;
    for (int i = 0; i < 4; ++i) {
        ivec2 right_up = ivec2(i & 1, i >> 1), pixel = clamp(ivec2(corner) + right_up, ivec2(0), ivec2(size.xy) - 1);
        vec2 part = mix(1.0 - share, share, vec2(right_up));
        float bilinear = part.x * part.y, matching = match(s, read_gbuffer(pixel));
        Accumulated tap = fetch_light(pixel);
        if (bilinear > closest) {
            closest = bilinear;
            nearest = tap;
        }
        sum.first += bilinear * matching * tap.first;
        sum.second += bilinear * matching * tap.second;
        total += bilinear * matching;
        even.first += matching * tap.first;
        even.second += matching * tap.second;
        matches += matching;
    }
    // Right on a texel that stipple gave to another layer only the others match, and bilinear weighs them 0.
    if (total > 0.0) return Accumulated(sum.first / total, sum.second / total);
    return matches > 0.0 ? Accumulated(even.first / matches, even.second / matches) : nearest;
}
