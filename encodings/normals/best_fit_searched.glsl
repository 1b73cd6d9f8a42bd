// Best-fit normals without a look-up, beside best_fit_searched.py.
#include "../vec.glsl"

vec3 best_fit_searched_code(vec3 n, float k) {
    // c = the odd numbers nearest to k n / max |n|
    float largest = max(max(abs(n.x), abs(n.y)), abs(n.z));
    return 2.0 * floor(n * (0.5 * k / largest)) + 1.0;
}

vec3 best_fit_searched_encode(vec3 n, vec3 view) {
    float best = float(BEST_FIT_LEVELS - 1), least = 2.0;
    for (int step = 0; step < BEST_FIT_LEVELS / 2; ++step) {
        float k = float(BEST_FIT_LEVELS - 1 - 2 * step);
        vec3 c = best_fit_searched_code(n, k);
        // the squared sine of the angle between: |n - c (c . n) / (c . c)|^2
        vec3 aside = n - c * (dot(c, n) / dot(c, c));
        float misfit = dot(aside, aside);
        if (misfit < least * BEST_FIT_BETTER) {
            least = misfit;
            best = k;
        }
    }
    return best_fit_searched_code(n, best) * (1.0 / float(BEST_FIT_LEVELS - 1));
}

vec3 best_fit_searched_decode(vec3 e, vec3 view) { return unit(e); }
