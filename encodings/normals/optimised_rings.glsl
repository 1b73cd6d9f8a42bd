// Optimised rings, beside optimised_rings.py, which makes the table: for each ring its points, and those before it.
#include "../elementary.glsl"

uniform sampler2D optimised_rings_table;

vec2 optimised_rings_ring(float ring) { return texelFetch(optimised_rings_table, ivec2(int(ring), 0), 0).xy; }

vec3 optimised_rings_point(float ring, float share) {
    // theta = pi ring / (RINGS - 1), phi = 2 pi share
    float turns = 2.0 * share;
    vec2 around = sincos_pi(turns > 1.0 ? turns - 2.0 : turns);
    vec2 polar = sincos_pi(ring * (1.0 / float(OPTIMISED_RINGS_COUNT - 1)));
    return vec3(around.yx * polar.x, polar.y);
}

vec2 optimised_rings_encode(vec3 n, vec3 view) {
    const float BYTE = float(OPTIMISED_RINGS_BYTE);
    // ring = theta (RINGS - 1) / pi, share = phi / (2 pi)
    float theta = atan2_pi(sqrt(n.x * n.x + n.y * n.y), n.z);
    float turn = 0.5 * atan2_pi(n.y, n.x);
    float above = min(floor(theta * float(OPTIMISED_RINGS_COUNT - 1)), float(OPTIMISED_RINGS_COUNT - 2));
    float best = 0.0, least = 8.0;
    for (int i = 0; i < 2; ++i) {
        vec2 ring = optimised_rings_ring(above + float(i));
        float k = floor(turn * ring.x + 0.5);
        k = k < 0.0 ? k + ring.x : k;
        k = k >= ring.x ? 0.0 : k;
        vec3 miss = n - optimised_rings_point(above + float(i), k / ring.x);
        if (dot(miss, miss) < least) {
            least = dot(miss, miss);
            best = ring.y + k;
        }
    }
    float high = floor(best * (1.0 / BYTE));
    return vec2(number_of(high, OPTIMISED_RINGS_BYTE), number_of(best - BYTE * high, OPTIMISED_RINGS_BYTE));
}

vec3 optimised_rings_decode(vec2 e, vec3 view) {
    float i = index_of(e.x, OPTIMISED_RINGS_BYTE) * float(OPTIMISED_RINGS_BYTE) + index_of(e.y, OPTIMISED_RINGS_BYTE);
    // the last ring that begins at i or before
    int low = 0, high = OPTIMISED_RINGS_COUNT;
    while (high - low > 1) {
        int middle = (low + high) >> 1;
        if (optimised_rings_ring(float(middle)).y <= i) low = middle;
        else high = middle;
    }
    vec2 ring = optimised_rings_ring(float(low));
    return optimised_rings_point(float(low), (i - ring.y) / ring.x);
}
