// Spherical Fibonacci lattice, beside spherical_fibonacci.py.
#include "../elementary.glsl"

vec3 spherical_fibonacci_point(float i) {
    // phi = 2 pi frac(i / PHI), z = 1 - (2 i + 1) / N
    int turned = int(uint(i) * uint(FIBONACCI_GOLDEN));
    vec2 sc = sincos_pi(float(turned) * FIBONACCI_HALF_TURNS);
    float z = 1.0 - (2.0 * i + 1.0) * (1.0 / FIBONACCI_COUNT);
    return vec3(sc.yx * sqrt((1.0 - z) * (1.0 + z)), z);
}

vec2 spherical_fibonacci_encode(vec3 n, vec3 view) {
    const float numbers[] = FIBONACCI_NUMBERS, turns[] = FIBONACCI_TURNS;
    const float COUNT = FIBONACCI_COUNT;
    // k = max(2, floor(log(N pi sqrt(5) (1 - n.z^2)) / log(PHI^2))): here steps of F_k and F_k+1 are the shortest
    float around = max(n.x * n.x + n.y * n.y, TINY);
    int k = int(max(floor((log2_of(around) + FIBONACCI_OCTAVES) * (1.0 / FIBONACCI_PER_STEP)), 2.0));
    vec2 f = vec2(numbers[k], numbers[k + 1]), t = vec2(turns[k], turns[k + 1]);
    // c0 T_k + c1 T_k+1 = phi / (2 pi), c0 F_k + c1 F_k+1 = (N (1 - n.z) - 1) / 2, of determinant 1 or -1
    float turn = 0.5 * atan2_pi(n.y, n.x), place = 0.5 * (COUNT * (1.0 - n.z) - 1.0);
    float side = (k & 1) == 1 ? 1.0 : -1.0;
    vec2 c = vec2(floor(side * (turn * f.y - place * t.y)), floor(side * (place * t.x - turn * f.x)));
    float best = 0.0, least = 8.0;
    for (int corner = 0; corner < 4; ++corner) {
        float i = (c.x + float(corner >> 1)) * f.x + (c.y + float(corner & 1)) * f.y;
        // beyond a pole: mirrored
        i = i < 0.0 ? -1.0 - i : i > COUNT - 1.0 ? 2.0 * COUNT - 1.0 - i : i;
        vec3 miss = n - spherical_fibonacci_point(i);
        if (dot(miss, miss) < least) {
            least = dot(miss, miss);
            best = i;
        }
    }
    float high = floor(best * (1.0 / float(FIBONACCI_BYTE)));
    float low = best - float(FIBONACCI_BYTE) * high;
    return vec2(number_of(high, FIBONACCI_BYTE), number_of(low, FIBONACCI_BYTE));
}

vec3 spherical_fibonacci_decode(vec2 e, vec3 view) {
    return spherical_fibonacci_point(index_of(e.x, FIBONACCI_BYTE) * float(FIBONACCI_BYTE) + index_of(e.y, FIBONACCI_BYTE));
}
